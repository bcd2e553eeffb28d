//! Whether lengths and tensions agree over time.
//!
//! Three counters and three load cells watch a leg of two freedoms that carries a load of two components: one number is left
//! over, the mean by which measured lengths exceed those of the estimated pose. A motion, a load and a push leave it as it is.
//! A leg that can twist has a third freedom, but no load turns it about its own axis, and so the tensions show how far it
//! twists. A wrong load cell changes the mean by a third of its error over the stiffness of the tendon, and a lost count by a
//! third of its length.

use super::Excess;
use crate::control::{CYCLE_S, LengthError, LowPass, bounds::clamp_symmetric};
use crate::settings::Settings;
use leg_model::Scalar;

/// Time constant of the filter of what is beyond the allowed change, s: a load cell that loses its tension is found within a
/// third of it, before the filters of the load have moved the leg.
const FILTER_TIME_S: f32 = 0.02;

/// Time constant of the filter that shows how fast an elongation changes, s, and the part of what it shows that may be missing: a
/// tendon is damped, and pulls otherwise than by its curve while the leg swings. A fifth of the period of a swing.
const SWING_TIME_S: f32 = 0.02;
const SWING_PART: f32 = 0.5;

/// Time constant with which the elongations are forgotten from which changes count, s: longer than any swing of the leg.
const FORGET_TIME_S: f32 = 1.0;

/// Part of the change of the elongations that tendons may stretch otherwise than by their curves. A single wrong cell changes
/// the mean by a quarter of its elongation or more: eight times what this allows. At 0.12 a cell that wanders or drifts was found too late
/// (`tests/suite/bench/strikes.rs`).
const CURVE_PART: f32 = 0.09;

/// The same of a leg at rest once the elongations are forgotten. A leg that the maximum tension limits lowers its pretension for a cell that
/// drifts up to it, and its other tendons change by up to three times the error of that cell: with 0.09 it followed some for 9.9 s, by up to
/// 2.3 mm, and with this one of 4 500 for 8.7 s. Less for what changes at once takes a violent load for a lie (scenario `fault_over_tension`). After
/// homing, the common factor of the tendons is known to 0.03 (`leg/stretch.rs`).
const KEPT_PART: f32 = 0.054;

/// Both parts while a leg that was homed is tensioned: its tendons may be of another make, and are measured then. A single wrong cell of three
/// whose tensions stay changes the mean by more.
const UNKNOWN_CURVE_PART: f32 = 0.3;

/// Part of a change that both filters take over in a cycle.
const FORGET_GAIN: f32 = CYCLE_S / (FORGET_TIME_S + CYCLE_S);
const SWING_GAIN: f32 = CYCLE_S / (SWING_TIME_S + CYCLE_S);

/// What is allowed for the sum of the three swings before that.
const SWING_ALLOWED: f32 = SWING_PART / 3.0 * (1.0 - SWING_GAIN);

/// How fast the error may grow that is taken for one of the geometry or of a curve.
#[derive(Clone, Copy, Debug)]
pub struct ErrorGrowth {
    /// In a cycle, m.
    cycle_m: f32,
    /// What is allowed for the sum of the three changes, before this cycle, of the elongations from which changes count; and what is learned of
    /// it.
    stretch_allowed: f32,
    stretch_learned: f32,
}

impl ErrorGrowth {
    /// In motion a tenth of a millimetre over the workspace, which the leg crosses in a second.
    pub const MOVING: Self = Self::new(1e-4, CURVE_PART, CURVE_PART);
    /// At rest what a tendon creeps.
    pub const RESTING: Self = Self::new(1e-6, CURVE_PART, KEPT_PART);
    /// Of a leg that keeps station, which would follow a load cell that drifts as slowly; of one whose pretension the maximum tension holds
    /// back, which would lower it for such a cell; and of one that is held, which would give way once it shows too much tension: 0.03 N/s are left.
    pub const STANDING: Self = Self::new(1e-7, CURVE_PART, KEPT_PART);
    /// As at rest, of tendons that may be of another make.
    pub const TENSIONING: Self = Self::new(1e-6, UNKNOWN_CURVE_PART, UNKNOWN_CURVE_PART);

    const fn new(m_per_s: f32, curve_part: f32, kept_part: f32) -> Self {
        Self {
            cycle_m: m_per_s * CYCLE_S,
            stretch_allowed: curve_part / 3.0 * (1.0 - FORGET_GAIN),
            stretch_learned: kept_part / 3.0 * FORGET_GAIN,
        }
    }
}

/// Cycles after the last tendon came taut in which the error is not watched yet, 0.1 s: a tendon that is reeled in is damped, and
/// shows up to a newton more than its elongation.
pub const SETTLE_CYCLES: u16 = 200;

/// A swing that may falsify the error by more than this while the last tendon comes taut, m, is a hard one, as after a push that took a
/// tendon's tension: four times the change that is a fault. What the error is then is in doubt by as much, and the doubt fades in this
/// time, s.
const HARD_SWING_M: f32 = 4e-5;
const DOUBT_TIME_S: f32 = 0.5;

/// Part of the allowed change within which a held leg is that a load pulls, also with cells and curves that are 2 % off
/// (`a_held_leg_that_is_overloaded_is_ramped_down`); a cell that drifted was at half of it as it came to show too much.
const CLOSE_PART: f32 = 0.25;

/// Cycles after which a swing of a held leg explains no more that the change is beyond that, 0.3 s: half a period of the slowest first mode, 2 Hz,
/// takes 0.25 s, and the change of a swing is nothing once in each.
pub const FAR_CYCLES: u16 = 600;

/// Cycles after which nothing of it is left, 5 s.
const FADE_CYCLES: u16 = 10_000;

/// Watches for a change that neither motion nor load explains.
#[derive(Clone, Copy, Debug)]
pub struct Agreement<T> {
    reference: Option<Reference<T>>,
    /// How far the change is beyond what is allowed, m.
    beyond: LowPass<T>,
    /// The same now, with nothing allowed for a swing.
    beyond_now_m: T,
    /// Whether the change is now within [`CLOSE_PART`] of what is allowed, and for how many cycles of a held leg it has not been.
    close: bool,
    far_cycles: u16,
    change_max_m: T,
}

#[derive(Clone, Copy, Debug)]
struct Reference<T> {
    mean_m: T,
    /// Elongation of each tendon, slowly forgotten and quickly.
    elongations_m: [[T; 2]; 3],
    /// Cycles until nothing is in doubt; in the first [`SETTLE_CYCLES`] of them the error is not watched yet.
    young_cycles: u16,
    /// By how much the mean may be off that a hard swing began with, m.
    doubt_m: T,
}

impl<T: Scalar> Agreement<T> {
    /// With the limits of the settings.
    pub fn new(settings: &Settings) -> Self {
        Self {
            reference: None,
            beyond: LowPass::new(FILTER_TIME_S, CYCLE_S),
            beyond_now_m: T::zero(),
            close: false,
            far_cycles: 0,
            change_max_m: settings.limits.residual_change_m.into(),
        }
    }

    /// Forgets everything: the tendons need not pull any more.
    pub fn end(&mut self) {
        self.reference = None;
        self.beyond.set(T::zero());
    }

    /// Nothing can be compared now, but what was known holds; nothing is trusted meanwhile.
    #[inline(always)]
    pub fn pause(&mut self) {
        self.beyond_now_m = self.change_max_m;
    }

    /// Whether every tendon has pulled since the last end.
    #[inline(always)]
    pub fn watches(&self) -> bool {
        self.reference
            .as_ref()
            .is_some_and(|reference| reference.young_cycles <= FADE_CYCLES)
    }

    /// Whether the sensors are watched, and disagree at this moment: a tension that changes at once then is no knock, for that changes
    /// the lengths alike.
    #[inline(always)]
    pub fn contradicts(&self) -> bool {
        self.watches() && self.beyond_now_m > T::zero()
    }

    /// Whether the sensors agree: not where the change is no number.
    #[inline(always)]
    pub fn agree(&self) -> bool {
        self.beyond.value() <= T::zero()
    }

    /// Whether the sensors are watched, and agree at this moment: a fault is not yet one.
    #[inline(always)]
    pub fn trusts(&self) -> bool {
        self.watches() && self.beyond_now_m <= T::zero()
    }

    /// Whether the sensors of a held leg had not agreed closely for longer than a swing explains before a fault was latched, and do not yet.
    pub fn is_far(&self) -> bool {
        self.watches() && !self.close && self.far_cycles >= FAR_CYCLES
    }

    /// What a tension above the maximum is of a leg that is held, whose sensors are watched and agree; once a cycle. It may be a load, and they have
    /// to agree closely then; while the leg swings they do now and then.
    #[cold]
    #[inline(never)]
    pub fn held_excess(&mut self) -> Excess {
        match (self.stays_far(), self.close) {
            (true, _) => Excess::Doubted,
            (false, true) => Excess::Trusted,
            (false, false) => Excess::Open,
        }
    }

    /// One cycle: whether they have not agreed closely for longer than a swing explains.
    fn stays_far(&mut self) -> bool {
        self.far_cycles = if self.close {
            0
        } else {
            self.far_cycles.saturating_add(1)
        };
        self.far_cycles >= FAR_CYCLES
    }

    /// Counts anew: another state begins.
    pub fn forget_far(&mut self) {
        self.far_cycles = 0;
    }

    /// One cycle while every tendon should pull.
    #[inline(always)]
    pub fn watch(&mut self, error: &LengthError<T>, growth: &ErrorGrowth) {
        let Some(reference) = &mut self.reference else {
            self.reference = Some(Reference::new(error));
            return;
        };
        let (mut stretched_m, mut swings_m) = (T::SUM_START, T::SUM_START);
        for ([slow_m, fast_m], &now_m) in
            reference.elongations_m.iter_mut().zip(&error.elongations_m)
        {
            let (from_slow_m, from_fast_m) = (now_m - *slow_m, now_m - *fast_m);
            *slow_m += from_slow_m * T::from(FORGET_GAIN);
            *fast_m += from_fast_m * T::from(SWING_GAIN);
            stretched_m += from_slow_m.abs();
            swings_m += from_fast_m.abs();
        }
        let swings_m = swings_m * T::from(SWING_ALLOWED);
        let mut allowed_m = self.change_max_m + stretched_m * T::from(growth.stretch_allowed);
        // Of what a changed elongation was allowed to change a part stays.
        let mut learned_m = T::from(growth.cycle_m) + stretched_m * T::from(growth.stretch_learned);
        if reference.young_cycles > 0 {
            reference.young_cycles -= 1;
            if reference.young_cycles < FADE_CYCLES {
                learned_m += reference.fade();
                allowed_m += reference.doubt_m;
            } else {
                reference.mean_m = error.mean_m;
                if swings_m > T::from(HARD_SWING_M) {
                    reference.doubt(swings_m);
                }
            }
        }
        let change_m = error.mean_m - reference.mean_m;
        reference.mean_m += clamp_symmetric(change_m, learned_m);
        self.beyond_now_m = change_m.abs() - allowed_m;
        self.close = change_m.abs() <= allowed_m * T::from(CLOSE_PART);
        self.beyond.step(self.beyond_now_m - swings_m);
    }
}

impl<T: Scalar> Reference<T> {
    fn new(error: &LengthError<T>) -> Self {
        Self {
            mean_m: error.mean_m,
            elongations_m: error.elongations_m.map(|now_m| [now_m; 2]),
            young_cycles: SETTLE_CYCLES + FADE_CYCLES,
            doubt_m: T::zero(),
        }
    }

    /// The mean may be off by a hard swing, m.
    #[cold]
    fn doubt(&mut self, swings_m: T) {
        if swings_m > self.doubt_m {
            self.doubt_m = swings_m;
        }
    }

    /// One cycle in which a doubt fades, if there is one: by how much, m.
    #[cold]
    fn fade(&mut self) -> T {
        if self.young_cycles == 0 || self.doubt_m == T::zero() {
            (self.young_cycles, self.doubt_m) = (0, T::zero());
        }
        let fading_m = self.doubt_m * T::from(CYCLE_S / DOUBT_TIME_S);
        self.doubt_m -= fading_m;
        fading_m
    }
}

#[cfg(test)]
mod tests;
