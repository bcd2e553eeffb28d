//! Keeping station: the load is compensated where the leg was left, slowly and not far.

use crate::control::SLOW_STEP_S;
use crate::settings::Settings;
use leg_model::Scalar;

/// Fastest correction at the tip of a leg that hangs straight down, m/s; at a tilt of 30° it is up to 2 mm/s, for the levers of the
/// tendons are shorter there.
const TIP_M_PER_S: f32 = 1.87e-3;

/// What would move the tip by less is not corrected, m: meanwhile the motors rest on their screws.
const TIP_DEAD_BAND_M: f32 = 3e-5;

/// Farthest correction, rad: 3°. Two kilograms on the paper's leg at its farthest tilt take most of it.
const FARTHEST_RAD: f32 = 0.0524;

/// The limits in lengths of tendons, as the root of the sum of their squares.
#[derive(Clone, Copy, Debug)]
pub struct StationLimits<T> {
    /// Whether the settings allow it at all.
    pub allowed: bool,
    /// In a step, m, and its square.
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
        let step_m = TIP_M_PER_S * per_tip * SLOW_STEP_S;
        Self {
            allowed: settings.keeps_station,
            step_m: step_m.into(),
            step_square: square(step_m),
            dead_square: square(TIP_DEAD_BAND_M * per_tip),
            farthest_square: square(FARTHEST_RAD * lever_m),
        }
    }

    /// The part of a way, with the sum of its squares, m², that is gone in a step.
    #[inline(always)]
    fn part(&self, square: T) -> T {
        if square <= self.step_square {
            T::one()
        } else {
            self.step_m / square.sqrt()
        }
    }

    /// Goes a step of what was left of the way of a leg that follows commands again.
    #[inline(always)]
    fn release(&self, rest_m: &mut [T; 3]) {
        let mut square = T::SUM_START;
        for rest in &*rest_m {
            square += *rest * *rest;
        }
        let kept = T::one() - self.part(square);
        for rest in rest_m {
            *rest *= kept;
        }
    }
}

/// Whether a leg that follows a target keeps station there.
#[derive(Clone, Copy, Debug)]
pub enum StationKeeping<T> {
    /// It follows commands.
    No,
    /// It does.
    Keeping(Station<T>),
    /// It follows commands again, and goes the rest of a correction: by so much each tendon is longer yet, m.
    Releasing([T; 3]),
}

impl<T: Scalar> StationKeeping<T> {
    /// The station that is kept.
    #[inline(always)]
    pub const fn kept(&self) -> Option<&Station<T>> {
        match self {
            Self::Keeping(station) => Some(station),
            Self::No | Self::Releasing(_) => None,
        }
    }

    /// Whether the leg is not yet where it shall be.
    pub fn corrects(&self) -> bool {
        match self {
            Self::No => false,
            Self::Keeping(station) => station.corrects,
            Self::Releasing(_) => true,
        }
    }

    /// Lets the leg follow commands again; the lengths without tension that its tendons shall have, m, if there is a target.
    pub fn release(&mut self, unstretched_m: Option<&[T; 3]>) {
        *self = match (&*self, unstretched_m) {
            (Self::Keeping(station), Some(unstretched_m)) => {
                Self::Releasing(station.rest_m(unstretched_m))
            }
            _ => Self::No,
        };
    }

    /// A step on the way to the lengths without tension that the tendons shall have, m: adds to `longer_m` what is left of it.
    #[inline(always)]
    pub fn step(
        &mut self,
        limits: &StationLimits<T>,
        unstretched_m: &[T; 3],
        longer_m: &mut [T; 3],
    ) {
        let rest_m = match self {
            Self::No => return,
            Self::Keeping(station) => station.step(limits, unstretched_m),
            Self::Releasing(rest_m) => {
                limits.release(rest_m);
                *rest_m
            }
        };
        for (longer, rest) in longer_m.iter_mut().zip(rest_m) {
            *longer += rest;
        }
        if matches!(self, Self::Releasing(rest_m) if *rest_m == [T::zero(); 3]) {
            *self = Self::No;
        }
    }
}

/// How far the tendons are corrected. What brakes a swing and what takes up the play of a gear is beside that.
#[derive(Clone, Copy, Debug)]
pub struct Station<T> {
    /// The lengths without tension with which the leg was left, m; none before the first step.
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

    /// Whether it would have to go farther than it may.
    #[inline(always)]
    pub fn too_far(&self) -> bool {
        self.too_far
    }

    /// A step to the lengths without tension that the tendons shall have, m. What is left of the way after it, by which each tendon
    /// stays longer, m.
    #[inline(never)]
    fn step(&mut self, limits: &StationLimits<T>, unstretched_m: &[T; 3]) -> [T; 3] {
        let left_m = *self.left_m.get_or_insert(*unstretched_m);
        let (mut steps_m, mut square) = ([T::zero(); 3], T::SUM_START);
        for (i, step) in steps_m.iter_mut().enumerate() {
            *step = unstretched_m[i] - (left_m[i] + self.correction_m[i]);
            square += *step * *step;
        }
        let part = self.part(limits, square);
        let (mut sum, mut square) = (T::SUM_START, T::SUM_START);
        for (i, correction) in self.correction_m.iter_mut().enumerate() {
            *correction += steps_m[i] * part;
            sum += *correction;
            square += *correction * *correction;
        }
        // What all tendons have in common tilts nothing.
        let tilting_square = square - sum * sum * T::from(1.0 / 3.0);
        self.too_far = !(tilting_square <= limits.farthest_square);
        self.rest_m(unstretched_m)
    }

    /// What is left of the way to the lengths without tension that the tendons shall have, m.
    fn rest_m(&self, unstretched_m: &[T; 3]) -> [T; 3] {
        let mut rest_m = self.left_m.unwrap_or(*unstretched_m);
        for (i, rest) in rest_m.iter_mut().enumerate() {
            *rest += self.correction_m[i] - unstretched_m[i];
        }
        rest_m
    }

    /// The part of what is missing, with the sum of its squares, m², that is corrected in this step. A correction that has begun goes on
    /// to its end.
    fn part(&mut self, limits: &StationLimits<T>, square: T) -> T {
        self.corrects |= square > limits.dead_square;
        if !self.corrects {
            return T::zero();
        }
        let part = limits.part(square);
        self.corrects = part < T::one();
        part
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{FARTHEST_RAD, Station, StationKeeping, StationLimits};
    use crate::settings::Settings;

    /// Ring radius and distance of the tip of the paper's leg, m.
    const RING_M: f64 = 0.024;
    const TIP_M: f64 = 0.219;

    /// Lengths that tilt the leg so that its tip goes so far.
    fn tilting(tip_m: f64) -> [f64; 3] {
        [1.0, -0.5, -0.5].map(|part| part * tip_m / TIP_M * RING_M)
    }

    fn limits() -> StationLimits<f64> {
        StationLimits::new(&Settings::table_1().unwrap())
    }

    /// A step; what is left of the way after it.
    fn step(station: &mut Station<f64>, unstretched_m: [f64; 3]) -> [f64; 3] {
        station.step(&limits(), &unstretched_m)
    }

    fn left() -> Station<f64> {
        let mut station = Station::new();
        assert_eq!(step(&mut station, [0.0; 3]), [0.0; 3]);
        station
    }

    /// Steps until a leg has corrected what moves its tip so far.
    fn steps(tip_m: f64) -> u32 {
        let mut station = left();
        let there = |_: &u32| {
            let rest_m = step(&mut station, tilting(tip_m));
            rest_m.iter().all(|rest| rest.abs() < 1e-12)
        };
        (0..100_000).find(there).unwrap()
    }

    /// What is left when the leg is taken over is gone no faster, and to its end.
    #[test]
    fn what_is_left_is_released_at_the_same_speed() {
        let mut rest_m = tilting(3.74e-3);
        let there = |_: &u32| {
            limits().release(&mut rest_m);
            rest_m == [0.0; 3]
        };
        let steps = (0..100_000).find(there).unwrap();
        assert!((1_990..2_010).contains(&steps), "{steps}");
    }

    #[test]
    fn the_tip_is_led_at_its_speed_and_no_faster() {
        let steps = steps(3.74e-3);
        assert!((1_990..2_010).contains(&steps), "{steps}");
    }

    /// Inside the dead band the motors rest; what is begun beyond it is done to its end.
    #[test]
    fn little_is_left_alone() {
        let (little, mut station) = (tilting(2.9e-5), left());
        for _ in 0..1_000 {
            assert_eq!(step(&mut station, little), little.map(|m| -m));
            assert!(!station.corrects);
        }
        assert!((10..25).contains(&steps(3.1e-5)));
    }

    #[test]
    fn farther_than_it_may_it_is_too_far_and_a_pretension_is_not() {
        assert!((FARTHEST_RAD.to_degrees() - 3.0).abs() < 0.01);
        let farthest_m = f64::from(FARTHEST_RAD) * TIP_M;
        for (lengths_m, too_far) in [
            (tilting(0.99 * farthest_m), false),
            (tilting(1.01 * farthest_m), true),
            ([2e-3; 3], false),
            (tilting(0.99 * farthest_m).map(|m| m + 2e-3), false),
            (tilting(1.01 * farthest_m).map(|m| m + 2e-3), true),
            ([f64::NAN; 3], true),
        ] {
            let mut station = left();
            for _ in 0..30_000 {
                step(&mut station, lengths_m);
            }
            assert_eq!(station.too_far(), too_far, "{lengths_m:?}");
        }
    }

    /// What is left of the way comes to whatever else makes the tendons longer.
    #[test]
    fn the_rest_of_a_correction_is_added() {
        let rest_m = tilting(3.74e-3);
        let (mut keeping, mut longer_m) = (StationKeeping::Releasing(rest_m), [1e-3; 3]);
        keeping.step(&limits(), &[0.2; 3], &mut longer_m);
        for (longer, rest) in longer_m.iter().zip(rest_m) {
            // A two-thousandth of it is gone in a step.
            let left = (longer - 1e-3) / rest;
            assert!((0.999..1.0).contains(&left), "{left}");
        }
    }
}
