//! Low-pass filters.

use leg_model::Scalar;

/// A filter of first order: it follows its input with a time constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass<T> {
    value: T,
    gain: T,
}

impl<T: Scalar> LowPass<T> {
    /// At zero; stepped every `step_s`.
    pub fn new(time_s: f32, step_s: f32) -> Self {
        Self {
            value: T::zero(),
            gain: T::from(step_s / (time_s + step_s)),
        }
    }

    /// The filtered value.
    #[inline(always)]
    pub fn value(&self) -> T {
        self.value
    }

    /// Takes the next input and gives the filtered value.
    #[inline(always)]
    pub fn step(&mut self, input: T) -> T {
        self.value += self.gain * (input - self.value);
        self.value
    }

    /// Starts anew from a value.
    pub fn set(&mut self, value: T) {
        self.value = value;
    }
}
