//! The play of the gears: how much farther the motors turn until a tension is what it was, when they come from the other side.
//!
//! A leg that has settled does not tell from which side its motors came. So the pretension is raised and lowered, and stopped on
//! the way: a motor that is stopped does not turn back. The same travels tell how much the tendons stretch.

use super::error::TuneError;
use super::estimate::{Equation, UncertainValue, least_squares};
use super::tuned_leg::TunedLeg;
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

/// What the travels of the motors tell about a pretension, means of the three axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travels {
    /// Play of the gears as travel of the tendon, m.
    pub play_m: UncertainValue,
    /// Two mean tensions, N.
    pub tensions_n: [f64; 2],
    /// How much farther the motors have pulled in at the greater one, m: the tendons are stretched by it.
    pub stretch_m: UncertainValue,
}

/// Whether two pretensions, N, are far enough from each other.
pub(super) fn is_wide([low_n, high_n]: [f64; 2]) -> bool {
    0.5 * (high_n - low_n) >= HALF_MIN_N
}

/// The pretensions, N, between which the leg is stopped when it goes from one to another: there the stretch is measured.
pub(super) fn stopped_n([low_n, high_n]: [f64; 2]) -> [f64; 2] {
    let [first, .., last] = STOPS;
    let at = |part: f64| 0.5 * (low_n + high_n + part * (high_n - low_n));
    [at(first), at(last)]
}

/// Raises and lowers the pretension between two. `tensions_n` are the mean tensions by the rig file at what [`stopped_n`] gives.
pub(super) async fn measure_travels<L: TunedLeg>(
    leg: &mut L,
    [low, high]: [f64; 2],
    tensions_n: [f64; 2],
) -> Result<Travels, TuneError<L::Error>> {
    let (middle_n, half_n) = (0.5 * (low + high), 0.5 * (high - low));
    let mut rests = Vec::new();
    let mut overshoot_n = OVERSHOOT * half_n;
    for part in STOPS {
        for (from_n, to_n) in [(low, high), (high, low)] {
            let way = Way {
                from_n,
                to_n,
                stop_n: middle_n + part * half_n - overshoot_n.copysign(to_n - from_n),
            };
            let rest = rest_at(leg, &way).await?;
            overshoot_n = (rest.tension_n - way.stop_n).abs().min(half_n);
            rests.push(rest);
        }
    }
    let found = least_squares(&equations(&rests, tensions_n), 0.0);
    let [_, stretch_m, _, play_m] = found.ok_or_else(|| {
        TuneError::undetermined(
            "the travels of the motors between two pretensions do not tell the play of their gears",
            "see that nothing touches the leg, and look at the noise of the load cells in `leg sensors`",
        )
    })?;
    Ok(Travels {
        play_m,
        tensions_n,
        stretch_m,
    })
}

/// The travel is a parabola over the tension, and the play between two of them. Its second number is the travel from the one
/// tension to the other, as the third does not change that.
fn equations(rests: &[Rest], [low_n, high_n]: [f64; 2]) -> Vec<Equation<4>> {
    let equation = |rest: &Rest| {
        let part = (rest.tension_n - low_n) / (high_n - low_n);
        let play = if rest.pulled_in { 0.0 } else { -1.0 };
        ([1.0, part, part * (1.0 - part), play], rest.pulled_m)
    };
    rests.iter().map(equation).collect()
}

/// Where the leg rests when it is stopped on the way.
async fn rest_at<L: TunedLeg>(leg: &mut L, way: &Way) -> Result<Rest, TuneError<L::Error>> {
    leg.hang_straight(way.from_n as f32).await?;
    let sign = (way.to_n - way.from_n).signum();
    let mut passed = |one: &Telemetry<f32>| sign * (mean(one.tensions_n) - way.stop_n) >= 0.0;
    let time = Duration::from_secs_f64(SETTLING_S + LOOKED_S);
    let command = Command::Pretension(way.to_n as f32);
    let seen = leg.interrupt(command, &mut passed, time).await?;
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
