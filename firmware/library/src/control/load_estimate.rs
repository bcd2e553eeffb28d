//! What the leg carries, by the moments of its tendons.

use super::{
    Mechanism, SLOW_STEP_S,
    bounds::{max, min},
    filter::DoubleLowPass,
    inertia::Turn,
    payload_estimate::PayloadEstimate,
    payload_moments::{Deviation, MomentFilter, PayloadMoments},
};
use crate::settings::Settings;
use leg_model::{Direction, Scalar};
use nalgebra::Vector3;

/// Part of what is new in a push that is followed while the leg moves, when the friction of its joint looks like one. At the whole of it
/// the tip leaves its trajectory by it; at 0.02 a leg unlike its settings comes to rest too far off. `tests/suite/bench/moves.rs` holds
/// both.
const MOVING_SHARE: f32 = 0.1;

/// Time constant of a first mode, 1/ω, up to which a push is taken up as fast as the settings say, s: 5 Hz. A slower mode lags more where
/// the loop of the load ends, and a push on it is taken up more slowly by as much.
const FAST_MODE_S: f32 = 0.03;

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

/// What the tendons show of a load.
#[derive(Clone, Copy, Debug)]
struct Shown<T> {
    /// About the joint, N·m.
    load: Vector3<T>,
    /// Whether the leg moves.
    moving: bool,
}

/// Estimates the load, in every other cycle.
#[derive(Clone, Copy, Debug)]
pub struct LoadEstimator<T> {
    payload: PayloadEstimate<T>,
    moments: MomentFilter<T>,
    /// The horizontal moment (x, y) that is neither that of the payload nor that of the leg's own weight, N·m.
    push_nm: [DoubleLowPass<T>; 2],
    /// Part of what is new in it that is taken up at rest, by the first mode.
    push_share: T,
    /// What the last estimate of the pose left for the next step; none where the load stays as it is.
    shown: Option<Shown<T>>,
}

impl<T: Scalar> LoadEstimator<T> {
    /// Without a load.
    pub fn new(settings: &Settings) -> Self {
        let push = DoubleLowPass::new(settings.estimation.load_time_s, SLOW_STEP_S);
        Self {
            payload: PayloadEstimate::new(settings),
            moments: MomentFilter::new(),
            push_nm: [push; 2],
            push_share: T::one(),
            shown: None,
        }
    }

    /// Starts anew, without a load.
    pub fn forget(&mut self) {
        self.payload.forget();
        for push in &mut self.push_nm {
            push.set(T::zero());
        }
        self.push_share = T::one();
        self.moments.rest();
        self.shown = None;
    }

    /// Takes up a push as a leg allows whose first mode has a time constant 1/ω, s.
    #[inline(always)]
    pub fn follow_mode(&mut self, time_constant_s: T) {
        self.push_share = min(T::from(FAST_MODE_S) / time_constant_s, T::one());
    }

    /// The load beyond the leg's own weight.
    #[inline(always)]
    pub fn estimate(&self) -> LoadEstimate<T> {
        LoadEstimate {
            payload_kg: self.payload.kg,
            push_nm: self.push_nm.each_ref().map(DoubleLowPass::value),
        }
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

    /// The load stays as it is.
    #[inline(always)]
    pub fn keep(&mut self) {
        self.shown = None;
    }

    /// Takes the load that the tendons of a leg show, N·m, where it points: now, or in the next step, as `load_estimation` says.
    #[inline(always)]
    pub fn take(
        &mut self,
        mechanism: &Mechanism<T>,
        direction: &Direction<T>,
        load: &Vector3<T>,
        load_estimation: LoadEstimation,
    ) {
        let shown = |moving| {
            Some(Shown {
                load: *load,
                moving,
            })
        };
        match load_estimation {
            LoadEstimation::Slack | LoadEstimation::Frozen => {}
            LoadEstimation::Filtered => self.shown = shown(false),
            LoadEstimation::Moving => self.shown = shown(true),
            LoadEstimation::Immediate => self.set(mechanism, direction, load),
        }
    }

    #[inline(always)]
    fn set(&mut self, mechanism: &Mechanism<T>, direction: &Direction<T>, load: &Vector3<T>) {
        self.moments.rest();
        let (excess, per_kg) = moments(mechanism, direction, load, &Turn::none());
        self.payload.set(excess, per_kg);
        for (i, push) in self.push_nm.iter_mut().enumerate() {
            push.set(excess[i] - self.payload.kg * per_kg[i]);
        }
    }

    /// A step by what was shown last, of a leg that points and shall point so, and shall turn so.
    #[inline(always)]
    pub fn step(
        &mut self,
        mechanism: &Mechanism<T>,
        direction: &Direction<T>,
        target: &Direction<T>,
        turn: &Turn<T>,
    ) {
        let Some(Shown { load, moving }) = self.shown.take() else {
            self.moments.rest();
            return;
        };
        let (excess, per_kg) = moments(mechanism, direction, &load, turn);
        let payload_moments = if moving {
            let turned = target.vector().cross(&direction.vector());
            let deviation = Deviation {
                turned: mechanism.support.plane(direction).project(&turned),
                leg_inertia: mechanism.leg_inertia,
                payload_inertia: mechanism.payload_inertia,
            };
            self.moments.step(excess, per_kg, &deviation)
        } else {
            self.moments.rest();
            PayloadMoments::unfiltered(excess, per_kg)
        };
        let found_kg = self.payload.step(&payload_moments, moving);
        let payload_kg = self.payload.kg;
        let share = if moving {
            T::from(MOVING_SHARE)
        } else {
            // At rest the load as a whole stays what it was at the target, whichever part of it is the payload: a target whose
            // tensions jump moves the leg.
            let target = target.vector();
            let shifted_nm = found_kg * mechanism.payload_lever;
            self.push_nm[0].shift(shifted_nm * target.y);
            self.push_nm[1].shift(-(shifted_nm * target.x));
            self.push_share
        };
        for (i, push) in self.push_nm.iter_mut().enumerate() {
            push.step(excess[i] - payload_kg * per_kg[i], share);
        }
    }
}

/// What neither weight nor inertia of a leg explains of a load, N·m, and the moment that 1 kg makes, N·m/kg, where it points and turns so.
// Once in memory, and not beside the code of every tick.
#[inline(never)]
fn moments<T: Scalar>(
    mechanism: &Mechanism<T>,
    direction: &Direction<T>,
    load: &Vector3<T>,
    turn: &Turn<T>,
) -> ([T; 2], [T; 2]) {
    let plane = mechanism.support.plane(direction);
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
    (excess, per_kg)
}
