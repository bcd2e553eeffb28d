//! Moves of the simulated leg with payloads that it does not know, judged by where the true tip is.

mod bars;
mod chart;
mod drawn_move;
mod duration;
mod reference;

pub use chart::save_comparison;
pub use drawn_move::DrawnMove;
pub use duration::longest_s;

use crate::draw::CURVE;
use crate::stand::{self, Stand};
use bars::MoveBars;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;
use nalgebra::Vector3;
use rayon::prelude::*;
use reference::Reference;
use serde::Serialize;
use std::ops::Range;

/// How long the leg is watched after a move, s; over the last part of it the tip's mean is where it rests, s.
const WATCHED_S: f64 = 3.0;
const RESTING_S: f64 = 0.5;

/// How many ticks lie between two points of a move's way after its end.
const WATCHED_TICKS: usize = 8;

/// From when the tip counts as at rest, mm.
const SETTLED_MM: f64 = 0.02;
/// A leg that sets out still moves then; one that finds no target has stopped in the first cycle.
const BEGUN_S: f64 = 0.05;

/// Longest move, s.
const MOVE_S: f64 = 10.0;

/// Time of a change of payload, s, and in which the leg then comes to rest.
const LOADING_S: f64 = 0.4;
const REST_S: f64 = 1.0;

/// Longest homing, s; how slack the tendons are before it, mm; and time in which the leg is tensioned after it and its tendons are measured, s.
const HOMING_S: f64 = 30.0;
const SLACK_MM: f64 = 2.0;
const TENSIONED_S: f64 = 4.0;

/// Which moves are made.
#[derive(Clone, Debug)]
pub struct MoveCampaign {
    /// Everything random follows from it.
    pub seed: u64,
    /// The rigs by name.
    pub rigs: Vec<(String, RigFile)>,
    /// The payload of every move, kg; drawn where none is given.
    pub payload_kg: Option<f64>,
}

/// A move, and how it went.
#[derive(Clone, Debug, Serialize)]
pub struct Moved {
    /// What was drawn.
    pub drawn: DrawnMove,
    /// From the command to the end of the trajectory, s.
    pub took_s: f64,
    /// Farthest that the true tip was off the trajectory on the way, mm.
    pub off_mm: f64,
    /// The same, but for how it rests off the commanded point, mm.
    #[serde(skip)]
    pub off_about_rest_mm: f64,
    /// Farthest that it was from where it comes to rest after the end, mm.
    pub swing_mm: f64,
    /// How long after the end it came within 0.02 mm of that for good, s.
    pub settled_s: f64,
    /// How far from the commanded point it rests, mm.
    pub rest_mm: f64,
    /// The least and the greatest true tension on the way and after it, N.
    #[serde(skip)]
    pub tensions_n: [f64; 2],
    /// What was beyond its bar, and [`Self::error`].
    pub failures: Vec<String>,
    /// Why the move did not come to its end, or that the leg left its shadow.
    #[serde(skip)]
    pub error: Option<String>,
    /// Time since the command, s, and how far the true tip was off, mm: off the trajectory, and off its end after that.
    #[serde(skip)]
    pub way: Vec<(f64, f64)>,
}

impl Moved {
    /// Whether everything was within its bar.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.failures.is_empty()
    }

    fn note_tensions(&mut self, stand: &Stand) {
        let [least_n, greatest_n] = self.tensions_n;
        let tensions_n = stand.truth.tensions_n.into_iter();
        self.tensions_n = [
            tensions_n.clone().fold(least_n, f64::min),
            tensions_n.fold(greatest_n, f64::max),
        ];
    }
}

impl MoveCampaign {
    /// Makes the moves of these numbers, on all cores, and calls `done` after each. They come in the order of their numbers,
    /// without those of a rig that holds no two poses.
    pub fn run(&self, numbers: Range<u64>, done: impl Fn() + Sync) -> Vec<Moved> {
        let moved = |number| {
            let drawn = DrawnMove::new(self.seed, &self.rigs, self.payload_kg, number);
            let moved = drawn.map(|drawn| make(&drawn));
            done();
            moved
        };
        numbers.into_par_iter().filter_map(moved).collect()
    }
}

/// Makes a move.
fn make(drawn: &DrawnMove) -> Moved {
    let mut moved = Moved {
        drawn: drawn.clone(),
        took_s: 0.0,
        off_mm: 0.0,
        off_about_rest_mm: 0.0,
        swing_mm: 0.0,
        settled_s: 0.0,
        rest_mm: 0.0,
        tensions_n: [f64::INFINITY, 0.0],
        failures: Vec::new(),
        error: None,
        way: Vec::new(),
    };
    let went = prepared(drawn).and_then(|mut stand| {
        go(drawn, &mut stand, &mut moved)?;
        moved.failures = MoveBars::new(drawn).failures(&moved);
        Ok(())
    });
    moved.error = went.err();
    moved.failures.extend(moved.error.clone());
    moved
}

/// A leg at rest where the move begins.
fn prepared(drawn: &DrawnMove) -> Result<Stand, String> {
    let mut stand = tensioned(drawn)?;
    stand.command(&Command::Pretension(drawn.pretension_n as f32))?;
    stand.wait(REST_S)?;
    // The leg has learnt that it carries nothing before a payload is hung on it.
    for pose_deg in [drawn.end_deg, drawn.begin_deg] {
        stand.command(&stand::move_to(pose_deg))?;
        stand.wait(0.05)?;
        stand.tick_until(MOVE_S, "the start of the move", |stand| !stand.moving())?;
        stand.wait(REST_S)?;
    }
    stand.plant().set_payload(drawn.payload_kg, LOADING_S);
    stand.wait(LOADING_S + REST_S)?;
    stand.rest()?;
    Ok(stand)
}

/// A leg that follows commands. One whose tendons are not as their curves say has to home: it finds that as they are tensioned.
fn tensioned(drawn: &DrawnMove) -> Result<Stand, String> {
    let homes = drawn.plant.curve_error.abs() > CURVE;
    let (start, command) = if homes {
        (Start::Slack { slack_mm: SLACK_MM }, Command::Home)
    } else {
        (Start::hanging(drawn.pretension_n), Command::Arm)
    };
    let mut stand = Stand::new(&drawn.file, &drawn.plant, start, drawn.seed)?;
    stand.tick_until(1.0, "disarmed", |stand| stand.state() == State::Disarmed)?;
    stand.wait(0.1)?;
    stand.command(&command)?;
    stand.tick_until(HOMING_S, "active", |stand| stand.state() == State::Active)?;
    stand.wait(if homes { TENSIONED_S } else { 0.3 })?;
    Ok(stand)
}

fn go(drawn: &DrawnMove, stand: &mut Stand, moved: &mut Moved) -> Result<(), String> {
    let began_s = stand.time_s();
    stand.command(&stand::move_to(drawn.end_deg))?;
    let mut reference = Reference::new(drawn.tip_length_m());
    let (mut errors_m, mut began) = (Vec::new(), false);
    loop {
        stand.tick()?;
        stand.require_no_fault()?;
        moved.took_s = stand.time_s() - began_s;
        moved.note_tensions(stand);
        if let Some(error_m) = reference.tip_error_m(stand) {
            let off_mm = error_m.norm() * 1000.0;
            moved.off_mm = moved.off_mm.max(off_mm);
            moved.way.push((moved.took_s, off_mm));
            errors_m.push(error_m);
        }
        began |= moved.took_s > BEGUN_S && stand.moving();
        if moved.took_s > BEGUN_S && !stand.moving() {
            break;
        }
        if moved.took_s > MOVE_S {
            return Err("the move does not end".into());
        }
    }
    if !began {
        return Err("the move does not begin".into());
    }
    let mut tips_m = Vec::new();
    let ended_s = stand.time_s();
    while stand.time_s() < ended_s + WATCHED_S {
        stand.tick()?;
        stand.require_no_fault()?;
        moved.note_tensions(stand);
        tips_m.push(stand.truth.tip_m);
        if tips_m.len() % WATCHED_TICKS == 0 {
            let off_m = (stand.truth.tip_m - drawn.end_tip_m()).norm();
            moved.way.push((stand.time_s() - began_s, off_m * 1000.0));
        }
    }
    let rest_m = rest(drawn, &tips_m, moved);
    for error_m in errors_m {
        let off_mm = (error_m - rest_m).norm() * 1000.0;
        moved.off_about_rest_mm = moved.off_about_rest_mm.max(off_mm);
    }
    Ok(())
}

/// How the tip comes to rest, and how far off the commanded point, m.
fn rest(drawn: &DrawnMove, tips_m: &[Vector3<f64>], moved: &mut Moved) -> Vector3<f64> {
    let resting = (RESTING_S / WATCHED_S * tips_m.len() as f64) as usize;
    let last = &tips_m[tips_m.len() - resting..];
    let rest_m = last.iter().sum::<Vector3<f64>>() / resting as f64;
    for (i, tip_m) in tips_m.iter().enumerate() {
        let away_mm = (tip_m - rest_m).norm() * 1000.0;
        moved.swing_mm = moved.swing_mm.max(away_mm);
        if away_mm > SETTLED_MM {
            moved.settled_s = (i + 1) as f64 / tips_m.len() as f64 * WATCHED_S;
        }
    }
    let off_m = rest_m - drawn.end_tip_m();
    moved.rest_mm = off_m.norm() * 1000.0;
    off_m
}
