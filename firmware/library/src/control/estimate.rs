//! Where the leg is and what it carries, by the lengths and tensions of its tendons.

use super::{
    CYCLE_S, Mechanism,
    bounds::{clamp_symmetric, max, min},
    filter::LowPass,
    inertia::Turn,
    payload_estimate::PayloadEstimate,
};
use crate::settings::Settings;
use leg_model::{
    Direction, Elasticity, Error, Scalar, SupportKind, estimate_moment, forward_kinematics,
    forward_kinematics_universal, inverse_kinematics,
};
use nalgebra::{SVector, Vector3};

/// Farthest that the torsion goes in a cycle, rad: 4 rad/s, as that of a target.
const TORSION_CYCLE_RAD: f32 = 2e-3;

/// The least torsion stiffness of tendons by their tensions that the search for the torsion divides by, m/rad: a tenth of that of the
/// paper's rig.
const LEAST_M_PER_RAD: f32 = 1.6e-3;

/// Part of what is new in a push that is followed while the leg moves, when the friction of its joint looks like one. At the whole of it
/// the tip leaves its trajectory by it; at 0.02 a leg unlike its settings comes to rest too far off. `tests/suite/bench/moves.rs` holds
/// both.
const MOVING_SHARE: f32 = 0.1;

/// Time constant of a first mode, 1/ω, up to which a push is taken up as fast as the settings say, s: 5 Hz. A slower mode lags more where
/// the loop of the load ends, and a push on it is taken up more slowly by as much.
const FAST_MODE_S: f32 = 0.03;

/// The pose that the tendons show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate<T> {
    /// Where the leg points.
    pub direction: Direction<T>,
    /// What forward kinematics leaves over, m: a tendon that jumped or a count that was lost shows there.
    pub residual_m: T,
    /// Length of each tendon, m.
    pub lengths_m: [T; 3],
    /// The same with its sign, for the watch over time; none while the tendons are not taut.
    pub length_error: Option<LengthError<T>>,
}

/// What the estimate of the pose leaves over, with its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthError<T> {
    /// Mean of measured lengths less those of the pose, m.
    pub mean_m: T,
    /// Elongation of each tendon by its load cell, m.
    pub elongations_m: [T; 3],
}

/// How the load is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadEstimation {
    /// It stays as it is: the tendons are not taut yet.
    Slack,
    /// It stays as it is.
    Frozen,
    /// It follows the tensions, filtered.
    Filtered,
    /// The same while the leg moves: more slowly, for the joint's friction is no load.
    Moving,
    /// It is what the tensions show now, unfiltered.
    Immediate,
}

/// A load, as what the target is made for: the payload turns with the leg, the push does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadEstimate<T> {
    /// The payload at the tip, kg.
    pub payload_kg: T,
    /// A horizontal moment (x, y) beside it, N·m.
    pub push_nm: [T; 2],
}

impl<T: Scalar> LoadEstimate<T> {
    /// The load as a horizontal moment (x, y) at a direction, with the moment of a payload of 1 kg at the horizontal, N·m.
    #[inline(always)]
    pub fn moment(&self, direction: &Direction<T>, payload_lever: T) -> [T; 2] {
        let down = direction.vector();
        let weight_nm = self.payload_kg * payload_lever;
        let [x, y] = self.push_nm;
        [x - weight_nm * down.y, y + weight_nm * down.x]
    }
}

/// Two low-pass filters in series.
#[derive(Clone, Copy, Debug)]
struct Smoothed<T> {
    first: LowPass<T>,
    second: LowPass<T>,
}

impl<T: Scalar> Smoothed<T> {
    fn new(time_s: f32) -> Self {
        let filter = LowPass::new(time_s, CYCLE_S);
        Self {
            first: filter,
            second: filter,
        }
    }

    #[inline(always)]
    fn value(&self) -> T {
        self.second.value()
    }

    fn set(&mut self, value: T) {
        self.first.set(value);
        self.second.set(value);
    }

    /// Moves it as a whole.
    #[inline(always)]
    fn shift(&mut self, by: T) {
        self.first.set(self.first.value() + by);
        self.second.set(self.second.value() + by);
    }

    /// Takes up a share of what is new.
    #[inline(always)]
    fn step(&mut self, input: T, share: T) {
        let first = self.first.value();
        self.second
            .step(self.first.step(first + (input - first) * share));
    }
}

/// Estimates pose and load, warm-started from the last estimate.
#[derive(Clone, Copy, Debug)]
pub struct Estimator<T> {
    direction: Direction<T>,
    payload: PayloadEstimate<T>,
    /// The horizontal moment (x, y) that is neither that of the payload nor that of the leg's own weight, N·m.
    push_nm: [Smoothed<T>; 2],
    /// Part of what is new in it that is taken up at rest, by the first mode.
    push_share: T,
    /// Elastic torsion of a leg that can twist, rad.
    torsion: T,
    /// What holds it, twice: torsion stiffness of the joint, N·m/rad, and that of the tendons by their tensions, m/rad.
    torsion_nm_per_rad: T,
    torsion_m_per_rad: T,
    /// The least tension, as a sum, that is taken to hold it, N.
    taut_n: T,
}

impl<T: Scalar> Estimator<T> {
    /// Straight down, without a payload.
    pub fn new(settings: &Settings) -> Self {
        let estimation = &settings.estimation;
        let smoothed = Smoothed::new(estimation.load_time_s);
        Self {
            direction: Direction::straight_down(),
            payload: PayloadEstimate::new(settings),
            push_nm: [smoothed; 2],
            push_share: T::one(),
            torsion: T::zero(),
            torsion_nm_per_rad: T::from(2.0 * settings.joint.torsion_nm_per_rad),
            torsion_m_per_rad: T::from(2.0 * torsion_m_per_rad(settings)),
            taut_n: settings.f_min_n.into(),
        }
    }

    /// The last direction.
    #[inline(always)]
    pub fn direction(&self) -> &Direction<T> {
        &self.direction
    }

    /// Starts anew, straight down, without a load.
    pub fn straight_down(&mut self) {
        self.direction = Direction::straight_down();
        self.payload.forget();
        for push in &mut self.push_nm {
            push.set(T::zero());
        }
        self.push_share = T::one();
    }

    /// Takes up a push as a leg allows whose first mode has a time constant 1/ω, s.
    #[inline(always)]
    pub fn follow_mode(&mut self, time_constant_s: T) {
        self.push_share = min(T::from(FAST_MODE_S) / time_constant_s, T::one());
    }

    /// The load beyond the leg's own weight.
    #[inline(always)]
    pub fn load(&self) -> LoadEstimate<T> {
        LoadEstimate {
            payload_kg: self.payload.kg,
            push_nm: self.push_nm.each_ref().map(Smoothed::value),
        }
    }

    /// The load beyond the leg's own weight at the last direction, as a horizontal moment (x, y), N·m.
    pub fn excess_nm(&self, mechanism: &Mechanism<T>) -> [T; 2] {
        self.load().moment(&self.direction, mechanism.payload_lever)
    }

    /// The payload, kg; nothing weighs less than nothing.
    #[inline(always)]
    pub fn payload_kg(&self) -> T {
        max(self.payload.kg, T::zero())
    }

    /// The payload whose inertia is moved, kg: by what may be hidden more than what is known.
    #[inline(always)]
    pub fn moved_kg(&self) -> T {
        self.payload.moved_kg()
    }

    /// The payload that the brake of the swing is made for, kg: by a standard deviation more than what is known of it. Near the vertical
    /// nothing shows a payload, and one of 1 kg makes the mode of a bare leg half as fast. `tests/suite/sim/ring_down.rs` holds it.
    #[inline(always)]
    pub fn likely_payload_kg(&self) -> T {
        self.payload_kg() + self.payload.deviation_kg()
    }

    /// Estimates the pose and, as `load_estimation` says, the load. `target_torsion`, rad, is the elastic one of a leg whose
    /// tendons are slack; taut ones show it by themselves. What the leg's `turn` takes is no load.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; what forward kinematics refuses.
    #[inline(always)]
    pub fn update(
        &mut self,
        mechanism: &Mechanism<T>,
        unstretched_m: &[T; 3],
        tensions_n: &[T; 3],
        target_torsion: T,
        load_estimation: LoadEstimation,
        turn: &Turn<T>,
    ) -> Result<Estimate<T>, Error> {
        let (mut lengths, mut pull) = (SVector::<T, 3>::zeros(), SVector::<T, 3>::zeros());
        let mut elongations_m = [T::zero(); 3];
        for (i, tendon) in mechanism.tendons.iter().enumerate() {
            // A slack tendon is as long as it is; noise does not make it push.
            pull[i] = max(tensions_n[i], T::zero());
            elongations_m[i] = tendon.elongation(pull[i])?;
            lengths[i] = unstretched_m[i] + elongations_m[i];
        }
        let slack = load_estimation == LoadEstimation::Slack;
        if slack {
            self.torsion = target_torsion;
        }
        let torsion = self.torsion;
        let mut twisted = None;
        let found = if mechanism.support.kind() == SupportKind::Universal {
            forward_kinematics_universal(mechanism.rig.geometry(), &lengths, &self.direction)?
        } else {
            let geometry = mechanism.geometry(&self.direction, torsion, &mut twisted);
            forward_kinematics(geometry, &lengths, &self.direction)?
        };
        self.direction = found.direction;
        let mut length_error = None;
        if !slack {
            let geometry = mechanism.geometry(&found.direction, torsion, &mut twisted);
            let kinematics = inverse_kinematics(geometry, &found.direction)?;
            length_error = Some(LengthError {
                // At what forward kinematics found all three errors have one sign.
                mean_m: (lengths - kinematics.lengths).sum() * T::from(1.0 / 3.0),
                elongations_m,
            });
            let twists = mechanism.support.twists();
            if twists || load_estimation != LoadEstimation::Frozen {
                let tendons = estimate_moment(&kinematics.moment_map, &pull);
                let load = tendons - mechanism.support.joint_moment(&found.direction, torsion);
                if twists {
                    self.update_torsion(&load, &pull);
                }
                if load_estimation != LoadEstimation::Frozen {
                    self.update_load(mechanism, &load, turn, load_estimation);
                }
            }
        }
        Ok(Estimate {
            direction: found.direction,
            residual_m: found.residual_m,
            lengths_m: lengths.into(),
            length_error,
        })
    }

    /// One step of the search for the torsion at which the load, N·m, has no moment about the leg: weights and pushes act on
    /// its axis. Half a step, for the stiffness is that of a leg that hangs.
    #[inline(always)]
    fn update_torsion(&mut self, load: &Vector3<T>, pull: &SVector<T, 3>) {
        let stiffness =
            self.torsion_nm_per_rad + self.torsion_m_per_rad * max(pull.sum(), self.taut_n);
        let step = load.dot(&self.direction.vector()) / stiffness;
        self.torsion += clamp_symmetric(step, T::from(TORSION_CYCLE_RAD));
    }

    /// By the load, N·m, of a leg that turns.
    #[inline(always)]
    fn update_load(
        &mut self,
        mechanism: &Mechanism<T>,
        load: &Vector3<T>,
        turn: &Turn<T>,
        load_estimation: LoadEstimation,
    ) {
        let (direction, support) = (&self.direction, &mechanism.support);
        let plane = support.plane(direction);
        let [x, y] = plane.project(load);
        let [x_turn, y_turn] = plane.project(&turn.acceleration);
        let [x_damping, y_damping] = plane.project(&turn.damping);
        let (own, down) = (mechanism.leg.moment(direction), direction.vector());
        let excess = [
            x - own.x + x_turn * mechanism.leg_inertia + x_damping,
            y - own.y + y_turn * mechanism.leg_inertia + y_damping,
        ];
        // A weight at the tip turns the leg about (−p_y, p_x), the more the further it leans, and resists its acceleration.
        let per_kg = [
            -down.y * mechanism.payload_lever - x_turn * mechanism.payload_inertia,
            down.x * mechanism.payload_lever - y_turn * mechanism.payload_inertia,
        ];
        let immediate = load_estimation == LoadEstimation::Immediate;
        let moving = load_estimation == LoadEstimation::Moving;
        let found_kg = if immediate {
            self.payload.set(excess, per_kg);
            T::zero()
        } else {
            self.payload.step(excess, per_kg, moving)
        };
        let payload_kg = self.payload.kg;
        // At rest the load as a whole stays what it was, whichever part of it is the payload.
        let (share, shifted_kg) = if moving {
            (T::from(MOVING_SHARE), T::zero())
        } else {
            (self.push_share, found_kg)
        };
        for (i, push) in self.push_nm.iter_mut().enumerate() {
            let rest = excess[i] - payload_kg * per_kg[i];
            push.shift(-shifted_kg * per_kg[i]);
            if immediate {
                push.set(rest);
            }
            push.step(rest, share);
        }
    }
}

/// Moment about a leg that hangs straight down, by tension and torsion, m/rad: b·s/l of the anchors of a tendon, as a mean.
fn torsion_m_per_rad(settings: &Settings) -> f32 {
    let rig = &settings.rig;
    let height = rig.upper_length_m + rig.joint_length_m;
    let mut sum = 0.0;
    for ([base_x, base_y], [leg_x, leg_y]) in rig.base_anchors_m.iter().zip(&rig.leg_anchors_m) {
        let (x, y) = (base_x - leg_x, base_y - leg_y);
        let square = x * x + y * y + height * height;
        sum += (base_x * leg_x + base_y * leg_y) / Scalar::sqrt(square);
    }
    // Anchors that cross hold no torsion: the search takes small steps then.
    (sum * (1.0 / 3.0)).max(LEAST_M_PER_RAD)
}

#[cfg(test)]
mod tests;
