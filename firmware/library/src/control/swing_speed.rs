//! How fast a tendon's length swings with the leg's first mode, as a length: the speed by the angular frequency of the mode.

use super::SLOW_STEP_S;
use leg_model::Scalar;

/// The two fast poles by the angular frequency of the mode. Faster ones pass more of what motors and tendons do above the mode, which takes
/// gain margin of the loops; slower ones lag more above it, which takes phase margin (`the_loops_keep_their_margins`).
const FAST_POLE: f32 = 1.8;

/// The slow pole by the same: a length that stays is forgotten with it. A slower pole passes less of what is above the mode, and a faster
/// one keeps more of the phase of a mode that is slower than expected.
const SLOW_POLE: f32 = 0.5;

/// What a fast swing passes, by its length and the angular frequencies of the mode and of the swing: the transfer is
/// s·(`FAST_GAIN`·s + z)/((s + `FAST_POLE`)²·(s + `SLOW_POLE`)), s by the angular frequency of the mode, where z is such that it is j at
/// s = j: there is no lag at the mode.
pub const FAST_GAIN: f32 = FAST_POLE * FAST_POLE - 1.0 + 2.0 * FAST_POLE * SLOW_POLE;

/// Shares of the first and the second of the two fast filters: what this transfer is as a sum of their partial fractions.
const FIRST_SHARE: f32 = FAST_GAIN / FAST_POLE;
const SECOND_SHARE: f32 = {
    let zero = SLOW_POLE * (FAST_POLE * FAST_POLE - 1.0) - 2.0 * FAST_POLE;
    (FAST_POLE * FAST_GAIN - zero) / (FAST_POLE * FAST_POLE)
};

/// What the filters of a swing take up in a step of what is new.
#[derive(Clone, Copy, Debug)]
pub struct SwingFilter<T> {
    fast: T,
    slow: T,
}

impl<T: Scalar> SwingFilter<T> {
    /// For a first mode with a time constant 1/ω, s.
    #[inline(always)]
    pub fn new(time_constant_s: T) -> Self {
        let share = |pole: f32| {
            let step = T::from(SLOW_STEP_S * pole);
            step / (step + time_constant_s)
        };
        Self {
            fast: share(FAST_POLE),
            slow: share(SLOW_POLE),
        }
    }
}

/// A length that swings.
#[derive(Clone, Copy, Debug)]
pub struct SwingSpeed<T> {
    /// What stays of it, m.
    staying_m: T,
    /// The rest, filtered once and twice, m.
    first_m: T,
    second_m: T,
}

impl<T: Scalar> SwingSpeed<T> {
    /// At rest at a length, m.
    pub fn new(length_m: T) -> Self {
        Self {
            staying_m: length_m,
            first_m: T::zero(),
            second_m: T::zero(),
        }
    }

    /// The speed of the swing by the angular frequency of the mode, m: of a swing of the mode it has the amplitude, and leads it by 90°.
    #[inline(always)]
    pub fn step(&mut self, length_m: T, filter: &SwingFilter<T>) -> T {
        let new_m = length_m - self.staying_m;
        self.staying_m += new_m * filter.slow;
        self.first_m += (new_m - self.first_m) * filter.fast;
        self.second_m += (self.first_m - self.second_m) * filter.fast;
        self.first_m * T::from(FIRST_SHARE) - self.second_m * T::from(SECOND_SHARE)
    }
}

#[cfg(test)]
mod tests {
    use super::{FAST_GAIN, SLOW_STEP_S, SwingFilter, SwingSpeed};

    /// Time constant of a mode of 4 Hz, s.
    const TIME_CONSTANT_S: f64 = 0.04;

    /// The amplitude that is shown of a swing of 1 m, and by how much it leads a speed, degrees: of one that is so many times as fast as
    /// the mode that is expected.
    fn shown(faster: f64) -> (f64, f64) {
        let filter = SwingFilter::new(TIME_CONSTANT_S);
        let mut speed = SwingSpeed::new(0.0);
        let step_rad = faster * f64::from(SLOW_STEP_S) / TIME_CONSTANT_S;
        let period = core::f64::consts::TAU / step_rad;
        let (begin, end) = ((40.0 * period) as u32, (60.0 * period) as u32);
        let (mut along, mut across) = (0.0, 0.0);
        for i in 0..end {
            let (sine, cosine) = (f64::from(i) * step_rad).sin_cos();
            let shown_m = speed.step(sine, &filter);
            if i >= begin {
                along += shown_m * cosine;
                across -= shown_m * sine;
            }
        }
        let mean = 2.0 / f64::from(end - begin);
        let (along, across): (f64, f64) = (along * mean, across * mean);
        (along.hypot(across), across.atan2(along).to_degrees())
    }

    /// The swing of the mode has no lag but that of the steps. One that is slower, as with a payload that is not known, leads, and one that
    /// is faster lags: by so little that both are braked.
    #[test]
    fn the_mode_has_no_lag() {
        let (amplitude, lead_deg) = shown(1.0);
        assert!((amplitude - 1.0).abs() < 0.05, "{amplitude}");
        assert!(lead_deg.abs() < 4.0, "{lead_deg}");
        for (faster, range_deg) in [(0.6, 40.0..55.0), (1.5, -45.0..-35.0)] {
            let (amplitude, lead_deg) = shown(faster);
            let braked = amplitude * lead_deg.to_radians().cos() / faster;
            assert!(range_deg.contains(&lead_deg), "{faster}: {lead_deg}");
            assert!(braked > 0.5, "{faster}: {braked}");
        }
        let (amplitude, _) = shown(10.0);
        assert!(amplitude < f64::from(FAST_GAIN), "{amplitude}");
    }

    /// A length that stays, however far, is no swing after some time constants; nor is one that stays from the beginning.
    #[test]
    fn a_length_that_stays_is_no_swing() {
        let filter = SwingFilter::new(TIME_CONSTANT_S);
        let mut speed = SwingSpeed::new(0.0);
        let steps = [(); 1000].map(|()| speed.step(1.0_f64, &filter));
        assert!(steps[20] > 0.1 && steps[999].abs() < 1e-4);
        assert_eq!(SwingSpeed::new(1.0).step(1.0, &filter), 0.0);
    }

    /// A length that grows steadily shows as less than what it grows by in two time constants.
    #[test]
    fn a_steady_speed_shows_little() {
        let filter = SwingFilter::new(TIME_CONSTANT_S);
        let mut speed = SwingSpeed::new(0.0);
        let grows_m = |i: u32| f64::from(i) * f64::from(SLOW_STEP_S);
        let shown = (0..1000).map(|i| speed.step(grows_m(i), &filter)).last();
        assert!(shown.is_some_and(|shown_m| shown_m.abs() < 2.0 * TIME_CONSTANT_S));
    }
}
