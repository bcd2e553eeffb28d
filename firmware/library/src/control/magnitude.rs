//! The current of a motor whose driver shows no more than its magnitude.

use super::bounds;
use crate::settings::CurrentOutput;
use leg_model::Scalar;

/// Part of the period from which on a pulse shows the current at an output that is silent while the bridge brakes: 2.5 µs at 40 kHz. The
/// output of a DRV8850 comes 2 µs after the bridge has switched.
pub const SHOWN_PART: f32 = 0.1;

/// What a motor had in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Applied<T> {
    /// The voltage at it, V.
    pub voltage_v: T,
    /// The voltage beyond what its speed induces, V: it drives the current.
    pub driving_v: T,
}

/// Steps in which the parts of a period are added up.
const PART_STEPS: u16 = 4096;

/// What an output has shown since the last mean. Small, for a board holds some legs at a time on its stack.
#[derive(Clone, Copy, Debug)]
pub struct Magnitude<T> {
    /// Sum of what was shown, with the sign of what drove it, A.
    sum_a: T,
    /// Sum of the parts of the period in which it was shown, in steps of [`PART_STEPS`].
    parts: u16,
    /// Which way the voltage of the last tick was: 1, 0 or −1.
    last_way: i8,
    /// Whether a tick showed nothing, or not all of the current; and whether one did before the last mean.
    silent: Silence,
}

/// When an output has shown nothing, or not all of the current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Silence {
    /// Neither before the last mean nor since.
    Never,
    /// Before the last mean.
    Before,
    /// Since the last mean.
    Since,
    /// Before and since.
    Always,
}

impl<T: Scalar> Magnitude<T> {
    /// Nothing was shown yet.
    pub fn new(output: CurrentOutput) -> Self {
        Self {
            sum_a: T::zero(),
            parts: 0,
            last_way: 0,
            silent: match output {
                CurrentOutput::Bidirectional => Silence::Never,
                CurrentOutput::Magnitude | CurrentOutput::MagnitudeWhenDriven => Silence::Before,
            },
        }
    }

    /// Whether the last mean is that of the current: an output that was silent meanwhile tells nothing.
    #[inline(always)]
    pub fn told(&self) -> bool {
        matches!(self.silent, Silence::Never | Silence::Since)
    }

    /// Adds what a tick showed, A, with the part of the supply that was at the motor.
    pub fn add(&mut self, output: CurrentOutput, shown_a: T, applied: &Applied<T>, duty: T) {
        let Applied {
            voltage_v,
            driving_v,
        } = *applied;
        let opposed = voltage_v * driving_v < T::zero();
        let way = if voltage_v > T::zero() {
            1
        } else if voltage_v < T::zero() {
            -1
        } else {
            0
        };
        // A driver gives no pulse in the tick in which it turns about; a current against the voltage does not show.
        let unshown = opposed || way * self.last_way < 0;
        let part = match output {
            CurrentOutput::Bidirectional => return,
            CurrentOutput::Magnitude => T::one(),
            CurrentOutput::MagnitudeWhenDriven if unshown => T::zero(),
            CurrentOutput::MagnitudeWhenDriven => duty,
        };
        self.last_way = way;
        let shown = part >= T::from(SHOWN_PART);
        if opposed || !shown {
            self.silent = match self.silent {
                Silence::Never | Silence::Since => Silence::Since,
                Silence::Before | Silence::Always => Silence::Always,
            };
        }
        if shown {
            let shown_a = bounds::max(shown_a, T::zero());
            self.sum_a += if driving_v < T::zero() {
                -shown_a
            } else {
                shown_a
            };
            let steps = (part * T::from(f32::from(PART_STEPS))).whole();
            let steps = u16::try_from(steps).unwrap_or(PART_STEPS);
            self.parts = self.parts.saturating_add(steps);
        }
    }

    /// Ends the mean, A: of what was shown where the output shows something, no more than `most_a`; else `mean_a`, what it reads.
    pub fn end(&mut self, output: CurrentOutput, mean_a: T, most_a: T) -> T {
        if output == CurrentOutput::Bidirectional {
            return mean_a;
        }
        let parts = f32::from(self.parts) * (1.0 / f32::from(PART_STEPS));
        let sum_a = self.sum_a;
        (self.sum_a, self.parts) = (T::zero(), 0);
        self.silent = match self.silent {
            Silence::Never | Silence::Before => Silence::Never,
            Silence::Since | Silence::Always => Silence::Before,
        };
        if parts > 0.0 {
            bounds::clamp_symmetric(sum_a / T::from(parts), most_a)
        } else {
            mean_a
        }
    }
}

#[cfg(test)]
mod tests;
