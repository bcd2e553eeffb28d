//! The play of the gears: how much farther the motors turn until a tension is what it was, when they come from the other side.
//!
//! A leg that has settled does not tell from which side its motors came. So the pretension is raised and lowered, and stopped on
//! the way: a motor that is stopped does not turn back.

use super::error::TuneError;
use super::estimate::{Equation, Estimate, least_squares};
use crate::operator::{Goal, Operator, Tensioning};
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// Where it is stopped on the way, as parts of half of its range from the middle.
const STOPS: [f64; 4] = [-0.3, -0.1, 0.1, 0.3];

/// How far the tension goes on after a stop, as a part of half of its range, until that is known.
const OVERSHOOT: f64 = 0.5;

/// Half of a range that is too small for that, N.
const HALF_MIN_N: f64 = 4.0;

/// How long the leg swings and the motors brake after a stop, s.
const SETTLING_S: f64 = 0.7;

/// How long it is looked at after that, s: the noise of the load cells is then some hundredths of the play.
const LOOKED_S: f64 = 0.3;

/// Mean tension, N, and mean travel of the motors, m, of a resting leg, and whether they had pulled in.
#[derive(Clone, Copy, Debug)]
struct Rest {
    tension_n: f64,
    pulled_m: f64,
    pulled_in: bool,
}

/// A change of the pretension, N, and where it is stopped.
struct Way {
    from_n: f64,
    to_n: f64,
    stop_n: f64,
}

/// The mean play of the three gears as travel of the tendon, m, between two pretensions; none where it is less than what it may be
/// off.
pub(super) fn measure_play(
    operator: &mut Operator,
    range_n: [f64; 2],
) -> Result<Option<Estimate>, TuneError> {
    let [low, high] = range_n;
    let (middle_n, half_n) = (0.5 * (low + high), 0.5 * (high - low));
    if half_n < HALF_MIN_N {
        return Ok(None);
    }
    let mut rests = Vec::new();
    let mut overshoot_n = OVERSHOOT * half_n;
    for part in STOPS {
        for (from_n, to_n) in [(low, high), (high, low)] {
            let way = Way {
                from_n,
                to_n,
                stop_n: middle_n + part * half_n - overshoot_n.copysign(to_n - from_n),
            };
            let rest = rest_at(operator, &way)?;
            overshoot_n = (rest.tension_n - way.stop_n).abs().min(half_n);
            rests.push(rest);
        }
    }
    let found = least_squares(&equations(&rests, middle_n), 0.0);
    let play = found.map(|[_, _, _, play]| play);
    Ok(play.filter(|play| play.value > 0.0 && play.is_certain()))
}

/// The travel is a parabola over the tension, and the play between two of them.
fn equations(rests: &[Rest], middle_n: f64) -> Vec<Equation<4>> {
    let equation = |rest: &Rest| {
        let off = rest.tension_n / middle_n - 1.0;
        let play = if rest.pulled_in { 0.0 } else { -1.0 };
        ([1.0, off, off * off, play], rest.pulled_m)
    };
    rests.iter().map(equation).collect()
}

/// Where the leg rests when it is stopped on the way.
fn rest_at(operator: &mut Operator, way: &Way) -> Result<Rest, TuneError> {
    operator.reach(&Goal {
        tensioning: Some(Tensioning::Pretension(way.from_n as f32)),
        direction: Some([0.0; 2]),
    })?;
    let sign = (way.to_n - way.from_n).signum();
    let passed = |one: &Telemetry<f32>| sign * (mean(one.tensions_n) - way.stop_n) >= 0.0;
    let time = Duration::from_secs_f64(SETTLING_S + LOOKED_S);
    let command = Command::Pretension(way.to_n as f32);
    let seen = operator.interrupt(command, passed, time)?;
    let looked = (LOOKED_S / (SETTLING_S + LOOKED_S)
        * seen.iter().filter(|one| one.state == State::Held).count() as f64)
        as usize;
    let last = seen
        .get(seen.len().saturating_sub(looked)..)
        .unwrap_or(&seen);
    let mean_of = |of: fn(&Telemetry<f32>) -> [f32; 3]| {
        let sum: f64 = last.iter().map(|one| mean(of(one))).sum();
        sum / last.len().max(1) as f64
    };
    Ok(Rest {
        tension_n: mean_of(|one| one.tensions_n),
        pulled_m: mean_of(|one| one.pulled_m),
        pulled_in: sign > 0.0,
    })
}

fn mean(of_three: [f32; 3]) -> f64 {
    of_three.map(f64::from).iter().sum::<f64>() / 3.0
}
