//! How the leg swings on its screws: the first mode at several pretensions.

use super::error::TuneError;
use super::estimate::UncertainValue;
use super::play::{Travels, is_wide, measure_travels, stopped_n};
use super::ring::Ring;
use super::stretch;
use super::tuned_leg::TunedLeg;
use crate::rig_file::RigFile;
use leg_base::angles;
use leg_base::tick_time::tick_s;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_model::{Evaluation, evaluate};
use std::f64::consts::TAU;
use std::time::Duration;

/// The pretensions, as parts of that of the rig.
const PARTS: [f64; 3] = [0.75, 1.0, 1.25];

/// Distance of the pretensions from the ends of their range, N: load cells and the swing take some of it.
const FROM_ENDS_N: f64 = 10.0;

/// How far the leg would lean if it were not stopped, degrees.
const TILT_DEG: f64 = 3.0;

/// Time from a stop on in which the motors still turn, s.
const BRAKE_S: f64 = 0.17;

/// How long the swing is recorded from the stop on, and how much of it is taken, s: it is gone then.
const RECORDED: Duration = Duration::from_millis(900);
const TAKEN_S: f64 = 0.45;

/// Part of its frequency that a swing may be off.
const OFF_PART: f64 = 0.03;

/// At what pretensions the leg swings, and how far it leans.
#[derive(Clone, Debug, PartialEq)]
pub struct SwingPlan {
    /// The pretensions, N, rising.
    pub levels_n: Vec<f64>,
    /// How far the leg leans at the most, degrees.
    pub tilt_deg: f64,
    /// The pretensions, N, between which play and stretch are measured; none where they are too close to each other.
    pub travels_n: Option<[f64; 2]>,
}

impl SwingPlan {
    /// For a rig: about its pretension.
    #[must_use]
    pub fn new(rig: &RigFile) -> Self {
        let [low, high] = evaluate(&rig.parameters, &rig.query(0.0, 0.0, 0.0))
            .map_or([rig.pretension_n; 2], |hanging| hanging.pretension_range_n);
        let [low, high] = [low + FROM_ENDS_N, high - FROM_ENDS_N];
        let mut levels_n: Vec<f64> = PARTS
            .iter()
            .map(|part| (part * rig.pretension_n).min(high).max(low).round())
            .collect();
        levels_n.dedup();
        let travels_n = match levels_n.as_slice() {
            [low, .., high] => Some([*low, *high]).filter(|&range_n| is_wide(range_n)),
            _ => None,
        };
        Self {
            levels_n,
            travels_n,
            tilt_deg: TILT_DEG.min(0.5 * rig.tilt_deg),
        }
    }
}

/// The swings at one pretension.
#[derive(Clone, Debug, PartialEq)]
pub struct Swing {
    /// The pretension, N.
    pub pretension_n: f64,
    /// The frequency without damping, Hz: the mean of both sides.
    pub frequency_hz: UncertainValue,
    /// The moment of the tendons against the tilt towards azimuth 0° over the time, (s, N·m).
    pub moments_nm: Vec<(f64, f64)>,
    /// The oscillation in it.
    pub ring: Ring,
    /// The frequency that the rig file implies, Hz.
    pub configured_hz: f64,
    /// The stiffness against a tilt by the rig file, N·m/rad.
    pub stiffness_nm_per_rad: f64,
    /// What of that the tendons give by their stretch, N·m/rad.
    pub tendons_nm_per_rad: f64,
}

/// All swings.
#[derive(Clone, Debug, PartialEq)]
pub struct Swings {
    /// Those of each pretension.
    pub all: Vec<Swing>,
    /// The inertia with which the stiffnesses of the rig file give the frequencies, kg·m²; with those tendons whose stretch was
    /// measured where it was.
    pub inertia_kg_m2: UncertainValue,
    /// Play and stretch; none where the pretensions are too close to each other.
    pub travels: Option<Travels>,
    /// The stretch by the rig file, m.
    pub configured_stretch_m: Option<f64>,
}

impl Swings {
    /// How much the tendons stretch for what they do by the rig file; none where it was not measured.
    #[must_use]
    pub fn stretched(&self) -> Option<UncertainValue> {
        stretched(self.travels, self.configured_stretch_m)
    }
}

fn stretched(travels: Option<Travels>, configured_m: Option<f64>) -> Option<UncertainValue> {
    let (travels, configured_m) = travels.zip(configured_m)?;
    Some(travels.stretch_m.scaled(configured_m.recip()))
}

/// Homes the leg, and lets it swing by the plan; calls `seen` after each pretension.
///
/// # Errors
/// A [`TuneError`]: a fault on the way, which tells where it may come from tendons that stretch otherwise; a leg that does not swing.
pub async fn measure_swing<L: TunedLeg>(
    leg: &mut L,
    plan: &SwingPlan,
    rig: &RigFile,
    seen: &mut dyn FnMut(&Swing),
) -> Result<Swings, TuneError<L::Error>> {
    match measured(leg, plan, rig, seen).await {
        Ok(swings) => Ok(swings),
        Err(error) => Err(stretch::explained(leg, rig, error).await),
    }
}

async fn measured<L: TunedLeg>(
    leg: &mut L,
    plan: &SwingPlan,
    rig: &RigFile,
    seen: &mut dyn FnMut(&Swing),
) -> Result<Swings, TuneError<L::Error>> {
    if !leg.telemetry().await?.homed {
        leg.home().await?;
    }
    let (travels, configured_stretch_m) = match plan.travels_n {
        Some(range_n) => {
            let [low_n, high_n] = stopped_n(range_n);
            let [low, high] = [hanging(rig, low_n)?, hanging(rig, high_n)?];
            let tensions_n = [low, high].map(|leg| sum(&leg.tensions_n) / 3.0);
            let stretch_m = (sum(&low.unstretched_m) - sum(&high.unstretched_m)) / 3.0;
            let travels = measure_travels(leg, range_n, tensions_n).await?;
            (Some(travels), Some(stretch_m))
        }
        None => (None, None),
    };
    let mut all = Vec::new();
    for &level_n in &plan.levels_n {
        let swing = swing_at(leg, plan, rig, level_n).await?;
        seen(&swing);
        all.push(swing);
    }
    leg.hang_straight(rig.pretension_n as f32).await?;
    leg.stop().await?;
    let stretched = stretched(travels, configured_stretch_m);
    Ok(Swings {
        inertia_kg_m2: inertia(&all, stretched.unwrap_or(UncertainValue::new(1.0, 0.0))),
        all,
        travels,
        configured_stretch_m,
    })
}

/// The leg straight down, by the rig file.
fn hanging<E>(rig: &RigFile, pretension_n: f64) -> Result<Evaluation<f64>, TuneError<E>> {
    let mut query = rig.query(0.0, 0.0, 0.0);
    query.pretension_n = pretension_n;
    evaluate(&rig.parameters, &query).map_err(|_| no_swing(pretension_n))
}

/// The swings at a pretension, towards both sides: a leg whose tendons are not the same on both does not swing there at the same
/// frequency, and the mean is that of the leg straight down.
async fn swing_at<L: TunedLeg>(
    leg: &mut L,
    plan: &SwingPlan,
    rig: &RigFile,
    level_n: f64,
) -> Result<Swing, TuneError<L::Error>> {
    let one = swing_towards(leg, plan, rig, level_n, 0.0).await?;
    let other = swing_towards(leg, plan, rig, level_n, 180.0).await?;
    let frequency_hz = one.frequency_hz.mean(other.frequency_hz);
    if frequency_hz.part() > OFF_PART {
        return Err(no_swing(level_n));
    }
    Ok(Swing {
        frequency_hz,
        pretension_n: 0.5 * (one.pretension_n + other.pretension_n),
        configured_hz: 0.5 * (one.configured_hz + other.configured_hz),
        stiffness_nm_per_rad: 0.5 * (one.stiffness_nm_per_rad + other.stiffness_nm_per_rad),
        tendons_nm_per_rad: 0.5 * (one.tendons_nm_per_rad + other.tendons_nm_per_rad),
        ..one
    })
}

async fn swing_towards<L: TunedLeg>(
    leg: &mut L,
    plan: &SwingPlan,
    rig: &RigFile,
    level_n: f64,
    azimuth_deg: f64,
) -> Result<Swing, TuneError<L::Error>> {
    leg.hang_straight(level_n as f32).await?;
    let [x, y] = angles::direction(azimuth_deg, plan.tilt_deg).map(|one| one as f32);
    // It is the fastest there.
    let mut half_way = |telemetry: &Telemetry<f32>| {
        let [now_x, now_y] = telemetry.target;
        now_x.hypot(now_y) >= 0.5 * x.hypot(y)
    };
    let command = Command::Move { x, y };
    let recorded = leg.interrupt(command, &mut half_way, RECORDED).await?;
    one_swing(&recorded, rig, level_n, azimuth_deg)
}

fn no_swing<E>(level_n: f64) -> TuneError<E> {
    TuneError::undetermined(
        format!(
            "the leg does not swing at a pretension of {level_n:.0} N so that its frequency can be told"
        ),
        "see that nothing touches the leg, and look at the noise of the load cells in `leg sensors`",
    )
}

fn one_swing<E>(
    recorded: &[Telemetry<f32>],
    rig: &RigFile,
    level_n: f64,
    azimuth_deg: f64,
) -> Result<Swing, TuneError<E>> {
    let held: Vec<_> = recorded
        .iter()
        .filter(|one| one.state == State::Held)
        .collect();
    let (Some(first), Some(last)) = (held.first(), held.last()) else {
        return Err(no_swing(level_n));
    };
    let [x, y] = last.pose.map(f64::from);
    let tilt_deg = x.hypot(y).asin().to_degrees();
    let mut query = rig.query(azimuth_deg, tilt_deg, 0.0);
    query.pretension_n = level_n;
    let asked = evaluate(&rig.parameters, &query).map_err(|_| no_swing(level_n))?;
    // What the leg is tensioned to is not quite what was asked for, and the stiffness goes with it.
    query.pretension_n *= mean_n(&held) / sum(&asked.tensions_n);
    let pose = evaluate(&rig.parameters, &query).map_err(|_| no_swing(level_n))?;
    let time_s =
        |one: &Telemetry<f32>| f64::from(one.tick.wrapping_sub(first.tick)) * tick_s() - BRAKE_S;
    let moments_nm: Vec<_> = held
        .iter()
        .map(|one| (time_s(one), moment_nm(&pose, &one.tensions_n)))
        .filter(|(time, _)| (0.0..TAKEN_S).contains(time))
        .collect();
    let ring = Ring::fit(&moments_nm).ok_or_else(|| no_swing(level_n))?;
    let stiffness_nm_per_rad = stiffness_nm_per_rad(&pose, rig);
    let inertia = rig.plant.transverse_inertia_kg_m2(&rig.parameters);
    Ok(Swing {
        pretension_n: query.pretension_n,
        frequency_hz: ring.frequency_hz,
        moments_nm,
        ring,
        configured_hz: (stiffness_nm_per_rad / inertia).sqrt() / TAU,
        stiffness_nm_per_rad,
        tendons_nm_per_rad: tendons_nm_per_rad(&pose),
    })
}

/// The mean of the sum of the tensions, N.
fn mean_n(held: &[&Telemetry<f32>]) -> f64 {
    let sums = held.iter().map(|one| sum(&one.tensions_n.map(f64::from)));
    sums.sum::<f64>() / held.len().max(1) as f64
}

fn sum(tensions_n: &[f64; 3]) -> f64 {
    tensions_n.iter().sum()
}

/// The moment of the tendons about the y axis, across the x axis in which the leg leans, N·m.
fn moment_nm(pose: &Evaluation<f64>, tensions_n: &[f32; 3]) -> f64 {
    let [_, about_y, _] = pose.moment_map_m;
    about_y
        .iter()
        .zip(tensions_n)
        .map(|(lever, &tension)| lever * f64::from(tension))
        .sum()
}

/// The stiffness against a rotation about the y axis with that of the weight, N·m/rad.
fn stiffness_nm_per_rad(pose: &Evaluation<f64>, rig: &RigFile) -> f64 {
    let [_, [_, about_y, _], _] = pose.stiffness_nm_per_rad;
    let parameters = &rig.parameters;
    let weight = parameters.leg_mass_kg * parameters.gravity_m_per_s2 * parameters.leg_centroid_m;
    about_y + weight
}

/// The part of it that goes with the stretch of the tendons: neither that of the tensions themselves nor that of the joint.
fn tendons_nm_per_rad(pose: &Evaluation<f64>) -> f64 {
    let about_y = |[_, [_, about_y, _], _]: [[f64; 3]; 3]| about_y;
    about_y(pose.stiffness_nm_per_rad)
        - about_y(pose.stiffness_k2_exact_nm_per_rad)
        - about_y(pose.stiffness_joint_nm_per_rad)
}

/// K/ω² on the mean, with tendons that stretch by so much of what the rig file says.
fn inertia(all: &[Swing], stretched: UncertainValue) -> UncertainValue {
    let each: Vec<_> = all
        .iter()
        .map(|swing| {
            let angular = swing.frequency_hz.scaled(TAU);
            angular.squared().inverse().scaled(
                swing.stiffness_nm_per_rad
                    - swing.tendons_nm_per_rad * (1.0 - stretched.value.recip()),
            )
        })
        .collect();
    UncertainValue::mean_of_repeated(&each).widened(stretched.part())
}
