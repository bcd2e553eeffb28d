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

/// What an output has shown since the last mean.
#[derive(Clone, Copy, Debug)]
pub struct Magnitude<T> {
    output: CurrentOutput,
    /// Sum of what was shown, with the sign of what drove it, A.
    sum_a: T,
    /// Sum of the parts of the period in which it was shown.
    parts: T,
    /// Whether a tick showed nothing, or not all of the current.
    silent: bool,
    /// The voltage of the last tick, V.
    last_voltage_v: T,
    /// Whether the last mean shows the whole current.
    told: bool,
}

impl<T: Scalar> Magnitude<T> {
    /// Nothing was shown yet.
    pub fn new(output: CurrentOutput) -> Self {
        Self {
            output,
            sum_a: T::zero(),
            parts: T::zero(),
            silent: false,
            last_voltage_v: T::zero(),
            told: output == CurrentOutput::Bidirectional,
        }
    }

    /// Whether the last mean is that of the current: an output that was silent meanwhile tells nothing.
    #[inline(always)]
    pub fn told(&self) -> bool {
        self.told
    }

    /// Adds what a tick showed, A, with the part of the supply that was at the motor.
    pub fn add(&mut self, shown_a: T, applied: &Applied<T>, duty: T) {
        let Applied {
            voltage_v,
            driving_v,
        } = *applied;
        let opposed = voltage_v * driving_v < T::zero();
        let part = match self.output {
            CurrentOutput::Bidirectional => return,
            CurrentOutput::Magnitude => T::one(),
            // A driver gives no pulse in the tick in which it turns about; a current against the voltage does not show.
            CurrentOutput::MagnitudeWhenDriven
                if opposed || voltage_v * self.last_voltage_v < T::zero() =>
            {
                T::zero()
            }
            CurrentOutput::MagnitudeWhenDriven => duty,
        };
        self.last_voltage_v = voltage_v;
        let shown = part >= T::from(SHOWN_PART);
        self.silent |= opposed || !shown;
        if shown {
            let shown_a = bounds::max(shown_a, T::zero());
            self.sum_a += if driving_v < T::zero() {
                -shown_a
            } else {
                shown_a
            };
            self.parts += part;
        }
    }

    /// Ends the mean, A: of what was shown where the output shows something, no more than `most_a`; else `mean_a`, what it reads.
    pub fn end(&mut self, mean_a: T, most_a: T) -> T {
        if self.output == CurrentOutput::Bidirectional {
            return mean_a;
        }
        let (sum_a, parts) = (self.sum_a, self.parts);
        self.told = !self.silent;
        (self.sum_a, self.parts, self.silent) = (T::zero(), T::zero(), false);
        if parts > T::zero() {
            bounds::clamp_symmetric(sum_a / parts, most_a)
        } else {
            mean_a
        }
    }
}

#[cfg(test)]
mod tests;
