//! Frequency responses of the firmware's feedback loops around the simulated leg, and their margins.

mod break_point;
mod drawn_state;
mod feedback;
mod frequency_response;
mod patterns;
mod row;
mod sweep;

pub use drawn_state::DrawnState;
pub use feedback::Feedback;
pub use frequency_response::{ClosedLoop, Excitation, Sides};
pub use leg_rig::loop_response::{GAIN_DB, Margins, PHASE_DEG, ResponsePoint};
pub use row::{Margin, MarginRow, WorstMargin, rows};
pub use sweep::Sweep;

use crate::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::settings::Limits;
use leg_firmware::supervisor::State;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;

/// Time in which the leg finds what it carries, s.
const FIND_S: f64 = 1.5;

/// The loop of the trim has no gain margin: its phase is within this of 0°.
const TRIM_PHASE_DEG: f64 = 170.0;

/// Which states are measured.
#[derive(Clone, Debug)]
pub struct BodeCampaign {
    /// Everything random follows from it.
    pub seed: u64,
    /// The rigs by name.
    pub rigs: Vec<(String, RigFile)>,
    /// The loops.
    pub loops: Vec<Feedback>,
}

/// A loop at one place, one state of the leg and one amplitude.
#[derive(Clone, Debug, Serialize)]
pub struct Swept {
    /// The loop.
    pub feedback: Feedback,
    /// Where: a motor, or the tilt.
    pub place: &'static str,
    /// Of what was added: at the motor V, at the load cell that gets most N.
    pub amplitude: f64,
    /// Whether it is the smaller of two amplitudes.
    pub smaller: bool,
    /// Pose, payload and pretension.
    pub state: DrawnState,
    /// Its margins.
    pub margins: Margins,
    /// Its transfer.
    pub points: Vec<ResponsePoint>,
    /// What ended the measurement.
    pub failure: Option<String>,
}

impl Swept {
    /// Whether both margins are above their bars, but for one that the loop has not: see [`Self::has_no`].
    #[must_use]
    pub fn passes(&self) -> bool {
        let enough = |margin: Margin| match margin.value_and_hz(self) {
            Some([value, _]) => value >= margin.bar(),
            None => self.has_no(margin),
        };
        self.failure.is_none() && Margin::ALL.into_iter().all(enough)
    }

    /// Whether this loop has no such margin: the phase of the trim does not come to ±180°, and the gain of damping and tension may stay
    /// below 1. Of every other loop a margin that is not found lies outside of what was measured.
    #[must_use]
    pub fn has_no(&self, margin: Margin) -> bool {
        let mut points = self.points.iter();
        match (self.feedback, margin) {
            (Feedback::Trim, Margin::Gain) => {
                points.all(|point| point.phase_deg.abs() < TRIM_PHASE_DEG)
            }
            (Feedback::Damping | Feedback::Tension, Margin::Phase) => {
                points.all(|point| point.gain_db < 0.0)
            }
            _ => false,
        }
    }
}

impl BodeCampaign {
    /// Measures the states of some numbers, on all cores, and calls `done` after each. They come in the order of their numbers.
    pub fn run(&self, numbers: Range<u64>, done: impl Fn() + Sync) -> Vec<Swept> {
        let swept = |number| {
            let swept = self.swept(number);
            done();
            swept
        };
        let all: Vec<Vec<_>> = numbers.into_par_iter().map(swept).collect();
        all.into_iter().flatten().collect()
    }

    fn swept(&self, number: u64) -> Vec<Swept> {
        let Some(state) = DrawnState::new(self.seed, &self.rigs, number) else {
            return Vec::new();
        };
        let places = self
            .loops
            .iter()
            .flat_map(|&feedback| (0..feedback.places().len()).map(move |place| (feedback, place)));
        let places: Vec<_> = places.collect();
        let stand = prepared(&state);
        let swept = |(feedback, place)| match &stand {
            Ok(stand) => sweeps(&state, stand, feedback, place),
            Err(failure) => vec![Swept::failed(&state, feedback, place, failure)],
        };
        places.into_par_iter().flat_map_iter(swept).collect()
    }
}

/// A loop at a place, at each amplitude.
fn sweeps(state: &DrawnState, stand: &Stand, feedback: Feedback, place: usize) -> Vec<Swept> {
    let (broken, amplitudes) = match feedback.broken(&state.file, stand, place) {
        Ok(broken) => broken,
        Err(failure) => return vec![Swept::failed(state, feedback, place, &failure)],
    };
    let swept = |(i, (amplitude, sweep)): (usize, &(f64, Sweep))| {
        let empty = Swept::failed(state, feedback, place, "");
        let (points, failure) = match sweep.run(&broken) {
            Ok(points) => (points, None),
            Err(failure) => (Vec::new(), Some(failure)),
        };
        Swept {
            amplitude: *amplitude,
            smaller: i > 0,
            margins: Margins::new(&points),
            points,
            failure,
            ..empty
        }
    };
    amplitudes.iter().enumerate().map(swept).collect()
}

impl Swept {
    fn failed(state: &DrawnState, feedback: Feedback, place: usize, failure: &str) -> Self {
        Self {
            feedback,
            place: feedback.places()[place],
            amplitude: 0.0,
            smaller: false,
            state: state.clone(),
            margins: Margins::default(),
            points: Vec::new(),
            failure: Some(failure.into()),
        }
    }
}

/// A leg at rest in a state.
fn prepared(state: &DrawnState) -> Result<Stand, String> {
    let mut file = state.file;
    tolerate(&mut file.gains.limits);
    let [azimuth_deg, tilt_deg] = state.pose_deg;
    let start = Start::Held {
        azimuth_deg,
        tilt_deg,
        pretension_n: state.pretension_n,
        payload_kg: state.payload_kg,
    };
    let mut stand = Stand::new(&file, &state.plant, start, state.seed)?;
    stand.tick_until(1.0, "disarmed", |stand| stand.state() == State::Disarmed)?;
    stand.wait(0.1)?;
    stand.command(&Command::Arm)?;
    stand.tick_until(2.0, "active", |stand| stand.state() == State::Active)?;
    stand.command(&Command::Pretension(state.pretension_n as f32))?;
    stand.wait(FIND_S)?;
    stand.rest()?;
    Ok(stand)
}

/// What is added lets sensors disagree and motors lag: that shall not end the measurement. No limit is part of a loop.
fn tolerate(limits: &mut Limits) {
    limits.residual_m = 0.1;
    limits.residual_change_m = 0.1;
    limits.jump_n = 1e4;
    limits.following_m = 0.1;
    limits.disagreement_a = 1e3;
    limits.still_time_s = 10.0;
    limits.reversed_time_s = 10.0;
}
