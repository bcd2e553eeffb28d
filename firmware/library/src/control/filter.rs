//! Low-pass filters, of first to third order.

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

/// Two of them in series, with one time constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleLowPass<T> {
    first: LowPass<T>,
    second: LowPass<T>,
}

impl<T: Scalar> DoubleLowPass<T> {
    /// At zero; stepped every `step_s`.
    pub fn new(time_s: f32, step_s: f32) -> Self {
        let filter = LowPass::new(time_s, step_s);
        Self {
            first: filter,
            second: filter,
        }
    }

    /// The filtered value.
    #[inline(always)]
    pub fn value(&self) -> T {
        self.second.value()
    }

    /// Starts anew from a value.
    #[inline(always)]
    pub fn set(&mut self, value: T) {
        self.first.set(value);
        self.second.set(value);
    }

    /// Moves it as a whole.
    #[inline(always)]
    pub fn shift(&mut self, by: T) {
        self.first.set(self.first.value() + by);
        self.second.set(self.second.value() + by);
    }

    /// Takes the next input, or a share of what is new in it, and gives the filtered value.
    #[inline(always)]
    pub fn step(&mut self, input: T, share: T) -> T {
        let first = self.first.value();
        self.second
            .step(self.first.step(first + (input - first) * share))
    }
}

/// Three of them in series, whose second derivative does not jump where the input does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TripleLowPass<T> {
    stages: [LowPass<T>; 3],
}

impl<T: Scalar> TripleLowPass<T> {
    /// At zero; stepped every `step_s`.
    pub fn new(time_s: f32, step_s: f32) -> Self {
        Self {
            stages: [LowPass::new(time_s, step_s); 3],
        }
    }

    /// Starts anew from a value.
    #[inline(always)]
    pub fn set(&mut self, value: T) {
        for stage in &mut self.stages {
            stage.set(value);
        }
    }

    /// Takes the next input and gives the filtered value.
    #[inline(always)]
    pub fn step(&mut self, input: T) -> T {
        let mut value = input;
        for stage in &mut self.stages {
            value = stage.step(value);
        }
        value
    }

    /// The second derivative of the filtered value by time, times the square of the time constant.
    #[inline(always)]
    pub fn second_difference(&self) -> T {
        let [first, second, third] = self.stages.each_ref().map(LowPass::value);
        first - T::TWO * second + third
    }
}

#[cfg(test)]
mod tests {
    use super::TripleLowPass;

    /// Of a motion that accelerates steadily the second difference is the acceleration.
    #[test]
    fn a_steady_acceleration_is_found() {
        let (time_s, step_s, acceleration) = (0.01_f32, 1e-3_f32, 3.0);
        let mut filter = TripleLowPass::<f64>::new(time_s, step_s);
        let square = f64::from(time_s).powi(2);
        for i in 0..500 {
            let time_s = f64::from(i) * f64::from(step_s);
            filter.step(0.4 - 0.2 * time_s + 0.5 * acceleration * time_s * time_s);
        }
        let part = filter.second_difference() / square / acceleration;
        assert!((part - 1.0).abs() < 1e-4, "{part}");
    }

    /// A value that jumps has the second difference begin with a part of it.
    #[test]
    fn the_second_difference_does_not_jump() {
        let mut filter = TripleLowPass::<f64>::new(0.01, 1e-3);
        filter.set(2.0);
        assert_eq!((filter.step(2.0), filter.second_difference()), (2.0, 0.0));
        filter.step(3.0);
        assert!(
            (0.0..0.1).contains(&filter.second_difference()),
            "{}",
            filter.second_difference()
        );
    }
}
