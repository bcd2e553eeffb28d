//! Brings a leg to what it does when it is struck.

use super::OTHER_TICKS;
use super::activity::Activity;
use super::case::Case;
use super::course::Course;
use super::naming::Unstruck;
use super::push::strongest_n;
use super::way::Way;
use crate::stand::{self, Stand};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Fault, State};
use leg_sim::plant::Start;

/// Time of a change of payload and of a push, s, and in which the leg comes to rest after a move or one of them.
const LOADING_S: f64 = 0.4;
const REST_S: f64 = 1.0;

/// Longest times of a move and of homing, s.
const MOVE_S: f64 = 10.0;
const HOMING_S: f64 = 30.0;

/// Time in which an arming leg is struck, s.
const ARMING_S: f64 = 0.8;

/// The latest part of a way at which a leg is struck: what comes after its end is another state.
const LATEST: f64 = 0.98;

/// How long the way goes on after its end, s: what swings there belongs to it.
const AFTER_S: f64 = 1.0;

/// How slack the tendons of a leg are before homing, mm.
const SLACK_MM: f64 = 2.0;

/// A leg that is about to be struck.
pub(super) struct PreparedLeg {
    pub stand: Stand,
    /// Where its tip may be.
    pub way: Way,
    pub unstruck: Unstruck,
}

/// A load that a leg cannot hold without an estimate is compensated: the case then says so.
///
/// # Errors
/// Why the leg does not get there: a fault that nothing caused, a time that is over, or that it left its shadow.
pub(super) fn prepare(case: &mut Case) -> Result<PreparedLeg, String> {
    let prepared = bring_there(case)?;
    prepared.stand.require_shadow(OTHER_TICKS)?;
    Ok(prepared)
}

fn bring_there(case: &mut Case) -> Result<PreparedLeg, String> {
    let mut stand = started(case)?;
    let command = match case.activity {
        Activity::Following | Activity::Rearmed | Activity::Disarmed => None,
        Activity::Held => Some(Command::Stop),
        Activity::Moving => Some(stand::move_to(case.target_deg)),
        Activity::Homing => Some(Command::Home),
        Activity::RampingDown => Some(Command::Disarm),
        Activity::Arming => Some(Command::Arm),
    };
    let Some(command) = command else {
        if case.activity == Activity::Disarmed {
            disarm(&mut stand)?;
        } else if case.keeps_station {
            let following = stand.clone();
            keep_station(&mut stand)?;
            // Where it has no target it is held instead: it is struck as it follows commands.
            case.keeps_station = stand.state() == State::KeepingStation;
            if !case.keeps_station {
                stand = following;
            }
        }
        return Ok(resting(stand));
    };
    match case.activity {
        Activity::Held => {
            stand.command(&command)?;
            stand.tick_until(1.0, "held", |stand| stand.state() == State::Held)?;
            stand.rest()?;
            Ok(resting(stand))
        }
        Activity::Arming => {
            let way = Way::begin(stand.truth.tip_m);
            stand.command(&command)?;
            stand.wait(ARMING_S * case.part)?;
            let unstruck = Course::begin(&stand).rest(0.0);
            Ok(PreparedLeg {
                stand,
                way,
                unstruck,
            })
        }
        _ => {
            stand.command(&command)?;
            prepare_on_the_way(case, stand)
        }
    }
}

fn resting(stand: Stand) -> PreparedLeg {
    let way = Way::begin(stand.truth.tip_m);
    let unstruck = Course::begin(&stand).rest(0.0);
    PreparedLeg {
        stand,
        way,
        unstruck,
    }
}

/// A leg in the state from which the command goes out.
fn started(case: &mut Case) -> Result<Stand, String> {
    let start = match case.activity {
        Activity::Homing => Start::Slack { slack_mm: SLACK_MM },
        Activity::Arming => Start::Held {
            azimuth_deg: case.azimuth_deg,
            tilt_deg: case.tilt_deg,
            pretension_n: case.pretension_n,
            payload_kg: case.payload_kg,
        },
        _ => Start::hanging(case.pretension_n),
    };
    let mut stand = Stand::unjudged(&case.file, &case.plant, start, case.seed)?;
    stand.tick_until(1.0, "disarmed", |stand| stand.state() == State::Disarmed)?;
    stand.wait(0.1)?;
    if matches!(case.activity, Activity::Homing | Activity::Arming) {
        return Ok(stand);
    }
    let led = lead(case, &mut stand);
    let estimated = case.compensation == Compensation::Estimated;
    if led.is_err() && !estimated && stand.faults().has(Fault::Following) {
        case.compensation = Compensation::Estimated;
        return started(case);
    }
    led.map(|()| stand)
}

/// Arms the leg, loads it and moves it to its pose.
fn lead(case: &Case, stand: &mut Stand) -> Result<(), String> {
    stand.command(&Command::Arm)?;
    stand.tick_until(2.0, "active", |stand| stand.state() == State::Active)?;
    stand.wait(0.3)?;
    stand.command(&Command::Pretension(case.pretension_n as f32))?;
    stand.plant().set_payload(case.payload_kg, LOADING_S);
    stand.wait(LOADING_S + REST_S)?;
    stand.command(&stand::move_to([case.azimuth_deg, case.tilt_deg]))?;
    stand.wait(0.05)?;
    stand.tick_until(MOVE_S, "the end of the move", |stand| !stand.moving())?;
    stand.wait(REST_S)?;
    stand.command(&Command::Compensation(case.compensation))?;
    stand.wait(REST_S)?;
    if case.step_kg != 0.0 {
        stand
            .plant()
            .set_payload(case.payload_kg + case.step_kg, LOADING_S);
        stand.wait(LOADING_S)?;
    }
    if let Some([azimuth_deg, force_n]) = case.push {
        let across = stand.plant().transverse(azimuth_deg);
        // No harder than the pose can bear: what a push does beyond that is no matter of a fault.
        let force_n = force_n.min(strongest_n(&case.file, &stand.truth, &across));
        stand.plant().push(across * force_n, LOADING_S, 0.1);
        stand.wait(LOADING_S)?;
    }
    stand.rest()
}

/// Leaves the leg to itself, if it may keep station: nothing is heard of its host from then on.
fn keep_station(stand: &mut Stand) -> Result<(), String> {
    stand.command(&Command::KeepStation)?;
    stand.tick_until(1.0, "keeping station", |stand| {
        matches!(stand.state(), State::KeepingStation | State::Held)
    })?;
    stand.silence();
    stand.rest()
}

fn disarm(stand: &mut Stand) -> Result<(), String> {
    stand.command(&Command::Disarm)?;
    stand.tick_until(MOVE_S, "disarmed", |stand| stand.state() == State::Disarmed)?;
    stand.rest()
}

/// A leg that is struck on its way, which it has gone to its end before.
fn prepare_on_the_way(case: &mut Case, stand: Stand) -> Result<PreparedLeg, String> {
    let mut way = Way::begin(stand.truth.tip_m);
    let mut whole = stand.clone();
    let mut course = Course::begin(&whole);
    let (began_s, mut ended_s) = (stand.time_s(), None);
    while ended_s.is_none_or(|ended_s| whole.time_s() < ended_s + AFTER_S) {
        whole.tick()?;
        way.add(whole.truth.tip_m);
        course.add(&whole);
        if case.compensation != Compensation::Estimated && whole.faults().has(Fault::Following) {
            case.compensation = Compensation::Estimated;
            return bring_there(case);
        }
        if whole.faults().any() {
            let names = leg_base::description::faults(whole.faults());
            return Err(format!("{names} without a strike"));
        }
        let now_s = whole.time_s();
        if ended_s.is_none() && now_s > began_s + 0.05 && is_at_end(case, &whole) {
            ended_s = Some(now_s);
        }
        if now_s > began_s + HOMING_S {
            return Err(format!("no end within {HOMING_S} s"));
        }
    }
    let mut stand = stand;
    let all_s = ended_s.unwrap_or(began_s) - began_s;
    stand.wait(LATEST * case.part * all_s)?;
    let unstruck = course.rest(stand.time_s());
    Ok(PreparedLeg {
        stand,
        way,
        unstruck,
    })
}

fn is_at_end(case: &Case, stand: &Stand) -> bool {
    match case.activity {
        Activity::Homing => stand.state() == State::Active && !stand.moving(),
        Activity::RampingDown => stand.state() == State::Disarmed,
        _ => !stand.moving(),
    }
}
