//! Keeping station: the load is compensated where the leg was left, slowly and not far.

use crate::control::CYCLE_S;
use crate::settings::Settings;
use leg_model::Scalar;

/// Fastest correction at the tip of a leg that hangs straight down, m/s; at a tilt of 30° it is up to 2 mm/s, for the levers of the
/// tendons are shorter there.
const TIP_M_PER_S: f32 = 1.9e-3;

/// What would move the tip by less is not corrected, m: meanwhile the motors rest on their screws.
const TIP_DEAD_BAND_M: f32 = 3e-5;

/// Farthest correction, rad: 3°. Two kilograms on the paper's leg at its farthest tilt take most of it.
const FARTHEST_RAD: f32 = 0.0524;

/// The limits in lengths of tendons, as the root of the sum of their squares.
#[derive(Clone, Copy, Debug)]
pub struct StationLimits<T> {
    /// Whether the settings allow it at all.
    pub allowed: bool,
    /// In a cycle, m, and its square.
    step_m: T,
    step_square: T,
    /// The dead band and the farthest correction, squared, m².
    dead_square: T,
    farthest_square: T,
}

impl<T: Scalar> StationLimits<T> {
    /// For the levers that the tendons have about a leg that hangs straight down.
    pub fn new(settings: &Settings) -> Self {
        let rig = &settings.rig;
        let squares: f32 = rig.leg_anchors_m.iter().map(|[x, y]| x * x + y * y).sum();
        let lever_m = Scalar::sqrt(0.5 * squares);
        let per_tip = lever_m / (rig.joint_length_m + rig.leg_length_m);
        let square = |length_m: f32| T::from(length_m * length_m);
        let step_m = TIP_M_PER_S * per_tip * CYCLE_S;
        Self {
            allowed: settings.keeps_station,
            step_m: step_m.into(),
            step_square: square(step_m),
            dead_square: square(TIP_DEAD_BAND_M * per_tip),
            farthest_square: square(FARTHEST_RAD * lever_m),
        }
    }
}

/// How far the tendons are corrected. What brakes a swing and what takes up the play of a gear is beside that.
#[derive(Clone, Copy, Debug)]
pub struct Station<T> {
    /// The lengths without tension with which the leg was left, m; none before the first cycle.
    left_m: Option<[T; 3]>,
    /// How far each is corrected since, m.
    correction_m: [T; 3],
    corrects: bool,
    too_far: bool,
}

impl<T: Scalar> Station<T> {
    /// From where the leg is now.
    pub fn new() -> Self {
        Self {
            left_m: None,
            correction_m: [T::zero(); 3],
            corrects: false,
            too_far: false,
        }
    }

    /// Whether the leg is not yet where it shall be.
    pub fn corrects(&self) -> bool {
        self.corrects
    }

    /// Whether it would have to go farther than it may.
    #[inline(always)]
    pub fn too_far(&self) -> bool {
        self.too_far
    }

    /// Limits the lengths without tension that the tendons shall have in a cycle, m.
    #[inline(never)]
    pub fn limit(&mut self, limits: &StationLimits<T>, unstretched_m: &mut [T; 3]) {
        let left_m = *self.left_m.get_or_insert(*unstretched_m);
        let (mut steps_m, mut square) = ([T::zero(); 3], T::SUM_START);
        for (i, step) in steps_m.iter_mut().enumerate() {
            *step = unstretched_m[i] - (left_m[i] + self.correction_m[i]);
            square += *step * *step;
        }
        let share = self.share(limits, square);
        let (mut sum, mut square) = (T::SUM_START, T::SUM_START);
        for (i, correction) in self.correction_m.iter_mut().enumerate() {
            *correction += steps_m[i] * share;
            sum += *correction;
            square += *correction * *correction;
            unstretched_m[i] = left_m[i] + *correction;
        }
        // What all tendons have in common tilts nothing.
        let tilting_square = square - sum * sum * T::from(1.0 / 3.0);
        self.too_far = !(tilting_square <= limits.farthest_square);
    }

    /// The part of what is missing, with the sum of its squares, m², that is corrected in this cycle. A correction that has begun goes on
    /// to its end.
    fn share(&mut self, limits: &StationLimits<T>, square: T) -> T {
        let within = square <= limits.step_square;
        self.corrects |= square > limits.dead_square;
        if !self.corrects {
            return T::zero();
        }
        self.corrects = !within;
        if within {
            T::one()
        } else {
            limits.step_m / square.sqrt()
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{FARTHEST_RAD, Station, StationLimits};
    use crate::settings::Settings;

    /// Ring radius and distance of the tip of the paper's leg, m.
    const RING_M: f64 = 0.024;
    const TIP_M: f64 = 0.219;

    /// Lengths that tilt the leg so that its tip goes so far.
    fn tilting(tip_m: f64) -> [f64; 3] {
        [1.0, -0.5, -0.5].map(|part| part * tip_m / TIP_M * RING_M)
    }

    fn limits() -> StationLimits<f64> {
        StationLimits::new(&Settings::for_table_1().unwrap())
    }

    /// Cycles until a leg has corrected what moves its tip so far.
    fn cycles(tip_m: f64) -> u32 {
        let (limits, mut station) = (limits(), Station::new());
        station.limit(&limits, &mut [0.0; 3]);
        (0..100_000)
            .find(|_| {
                let mut pulled_m = tilting(tip_m);
                station.limit(&limits, &mut pulled_m);
                let left = |(now, wanted): (f64, f64)| (now - wanted).abs() > 1e-12;
                !pulled_m.into_iter().zip(tilting(tip_m)).any(left)
            })
            .unwrap()
    }

    #[test]
    fn the_tip_is_led_at_its_speed_and_no_faster() {
        let cycles = f64::from(cycles(3.8e-3));
        assert!((3_990.0..4_010.0).contains(&cycles), "{cycles}");
    }

    /// Inside the dead band the motors rest; what is begun beyond it is done to its end.
    #[test]
    fn little_is_left_alone() {
        let (limits, mut station) = (limits(), Station::new());
        station.limit(&limits, &mut [0.0; 3]);
        for _ in 0..1_000 {
            let mut pulled_m = tilting(2.9e-5);
            station.limit(&limits, &mut pulled_m);
            assert!(pulled_m == [0.0; 3] && !station.corrects());
        }
        assert!((20..50).contains(&cycles(3.1e-5)));
    }

    #[test]
    fn farther_than_it_may_it_is_too_far_and_a_pretension_is_not() {
        for (lengths_m, too_far) in [
            (tilting(0.99 * f64::from(FARTHEST_RAD) * TIP_M), false),
            (tilting(1.01 * f64::from(FARTHEST_RAD) * TIP_M), true),
            ([2e-3; 3], false),
            ([f64::NAN; 3], true),
        ] {
            let (limits, mut station) = (limits(), Station::new());
            station.limit(&limits, &mut [0.0; 3]);
            for _ in 0..50_000 {
                station.limit(&limits, &mut lengths_m.clone());
            }
            assert_eq!(station.too_far(), too_far, "{lengths_m:?}");
        }
    }
}
