//! Damping of the leg's own swing: the tendons brake how the leg deviates from its trajectory.

use super::{
    SLOW_STEP_S,
    bounds::{clamp_symmetric, min},
    swing_speed::{FAST_GAIN, SwingFilter, SwingSpeed},
};
use crate::settings::Settings;
use leg_model::Scalar;
use nalgebra::SVector;

/// The damping of the tendons themselves makes them pull harder while they are reeled in, and look longer: the loop would be
/// unstable by itself at a gain of one. It is kept to this part, so that the tendons may be damped three times as much as is assumed.
const TENDON_LOOP: f32 = 0.3;

/// The least damping of a tendon that is assumed for that, N·s/m: that of the simulated leg.
const TENDON_N_S_PER_M: f32 = 200.0;

/// Angular frequency up to which the mode gets the whole damping ratio, rad/s: 8 Hz. Above it, it rings down fast by less.
const WHOLE_RAD_PER_S: f32 = 50.0;

/// The longest time constant of a mode, 1/ω, that the filters are made for, s: 1 Hz.
const LONGEST_S: f32 = 0.16;

/// Amplitude of a tendon's swing that is not braked, m: above the noise of the load cells, or the motors would never rest. That is 9 µm
/// at the tip of the paper's leg. With half of it motors at 2 kg and 30° break away again a second after a move, which swings the tip by
/// 0.03 mm (`tests/suite/bench/moves.rs`).
const LEAST_M: f32 = 1e-6;

/// The most that a tendon is longer or shorter for it, m: a swing of the paper's leg by 5 mm at the tip asks for no more.
const MOST_M: f32 = 3e-4;

/// Amplitude of a tendon's swing beyond which a leg swings, m: 0.3 mm at the tip of the paper's rig.
pub const SWINGING_M: f32 = 3e-5;

/// The same of a leg on its way, m: 1 mm at the tip. It deviates by what its payload is thought to be and by friction, too, by up to 0.6 mm
/// (the bars of `leg moves`), and what shakes it is no fault below it.
pub const MOVING_SWINGING_M: f32 = 1e-4;

/// The mean over a swing of the sum of the squares of the tendons' lengths by the square of that amplitude: one tendon has the whole of
/// it, the other two have half, and the mean of a sine's square is a half.
const MEAN_SQUARES: f32 = 0.75;

/// Time constant of that mean, s: a swing at 2 Hz changes it by a fifth.
const MEAN_S: f32 = 0.25;

/// A leg whose mean square falls to this part of what it was rings down. A swing at 2 Hz that stays as it is makes it vary by no more.
const RINGS_DOWN: f32 = 0.7;

/// A leg that swings at rest for so many steps, 1.8 s, and does not ring down meanwhile, does so by itself: at 3 Hz with a damping ratio
/// of 0.02, the least that tendons and joint have without the brake, it rings down to that part in half a second.
const SWINGING_STEPS: u16 = (1.8 / SLOW_STEP_S) as u16;

/// A swing that is this many times as large as its mean, as squares, grows: one that stays is twice as large where it is fastest.
const GROWS: f32 = 3.0;

/// Steps after which the mean has followed a swing that has begun so far that no more than growth makes it exceed that: twice its time constant,
/// so that of pushes that come one after the other the later ones alone count as growth.
const FOLLOWED_STEPS: u16 = (2.0 * MEAN_S / SLOW_STEP_S) as u16;

/// A step in which the swing grows counts for so many from then on: two load cells on each other's tendon have the brake drive the swing,
/// which grows tenfold in 0.7 s.
const GROWING_STEPS: u16 = 10;

/// After so many of them in a row each counts once: what grows for longer without a fall is pushed. A swing of its own is larger than
/// that for a part of each half alone.
const OWN_GROWTH_STEPS: u8 = 30;

/// Brakes the swing, and finds one that does not end.
#[derive(Clone, Copy, Debug)]
pub struct SwingDamping<T> {
    /// How far each tendon is longer than the trajectory asks, and how that swings. None at first.
    tendons: Option<[SwingSpeed<T>; 3]>,
    /// Twice the damping ratio.
    twice_ratio: T,
    /// The highest gain by the inertia and the angular frequency of the mode, s/(kg·m²).
    gain_by_inertia: T,
    /// Mean of the sum of the squares of the tendons' swings, m².
    mean_square: T,
    /// The highest since it rang down last, m².
    highest_square: T,
    /// Steps since then for which it has been beyond [`SWINGING_M`].
    swinging_steps: u16,
    /// Steps in a row in which it grew, up to now.
    growing_steps: u8,
}

impl<T: Scalar> SwingDamping<T> {
    /// Before the first cycle.
    pub fn new(settings: &Settings) -> Self {
        let motion = &settings.motion;
        // Lengths that swing with a leg have the levers of the tendons: their damping by its rotation, N·m·s/rad, is about 3/2 of
        // that of one at the mean lever.
        let anchors = &settings.rig.leg_anchors_m;
        let squares: f32 = anchors.iter().map(|[x, y]| x * x + y * y).sum();
        let tendon_n_s_per_m = motion.tendon_damping_n_s_per_m.max(TENDON_N_S_PER_M);
        let tendons_nm_s = 0.5 * squares * tendon_n_s_per_m;
        Self {
            tendons: None,
            twice_ratio: T::from(2.0 * motion.damping_ratio),
            gain_by_inertia: T::from(TENDON_LOOP / (FAST_GAIN * tendons_nm_s.max(1e-6))),
            mean_square: T::zero(),
            highest_square: T::zero(),
            swinging_steps: 0,
            growing_steps: 0,
        }
    }

    /// Starts anew.
    pub fn start(&mut self) {
        self.tendons = None;
        self.mean_square = T::zero();
        self.highest_square = T::zero();
        self.swinging_steps = 0;
        self.growing_steps = 0;
    }

    /// A leg on its way swings a little by its commands: that is counted anew.
    #[inline(always)]
    pub fn forget_small_swing(&mut self) {
        if self.mean_square < T::from(MEAN_SQUARES * MOVING_SWINGING_M * MOVING_SWINGING_M) {
            self.swinging_steps = 0;
        }
    }

    /// Whether the leg swings and does not ring down.
    #[inline(always)]
    pub const fn keeps_swinging(&self) -> bool {
        self.swinging_steps >= SWINGING_STEPS
    }

    /// Watches for how long the leg swings.
    #[inline(always)]
    fn watch(&mut self, swing_m: &[T; 3]) {
        let mut square = T::SUM_START;
        for &length_m in swing_m {
            square += length_m * length_m;
        }
        self.mean_square += (square - self.mean_square) * T::from(SLOW_STEP_S / MEAN_S);
        let decayed = self.mean_square < self.highest_square * T::from(RINGS_DOWN);
        if decayed || self.mean_square > self.highest_square {
            self.highest_square = self.mean_square;
        }
        let least = T::from(MEAN_SQUARES * SWINGING_M * SWINGING_M);
        let grows = square > self.mean_square * T::from(GROWS);
        self.growing_steps = if grows {
            self.growing_steps.saturating_add(1)
        } else {
            0
        };
        self.swinging_steps = if decayed || self.mean_square < least {
            0
        } else {
            let swings_itself = grows && self.growing_steps <= OWN_GROWTH_STEPS;
            let followed = self.swinging_steps > FOLLOWED_STEPS;
            let steps = if swings_itself && followed {
                GROWING_STEPS
            } else {
                1
            };
            self.swinging_steps.saturating_add(steps)
        };
    }

    /// Time constant 1/ω of the first mode by the inertia of the leg, kg·m², and its stiffness against a tilt, N·m/rad; s.
    #[inline(always)]
    pub fn time_constant_s(inertia: T, stiffness: T) -> T {
        min((inertia / stiffness).sqrt(), T::from(LONGEST_S))
    }

    /// By how much each tendon shall be longer, m, for lengths that deviate from those of the trajectory by `deviations_m`. The tensions per
    /// pretension tell a swing from a sensor that reads wrong: a swing changes no length along them. `time_constant_s` is 1/ω of the first mode, s;
    /// `inertia` that of the leg with its payload, kg·m².
    #[inline(always)]
    pub fn step(
        &mut self,
        deviations_m: &[T; 3],
        per_pretension: &SVector<T, 3>,
        inertia: T,
        time_constant_s: T,
    ) -> [T; 3] {
        let filter = SwingFilter::new(time_constant_s);
        let tendons = self
            .tendons
            .get_or_insert_with(|| deviations_m.map(SwingSpeed::new));
        let mut speeds_m = [T::zero(); 3];
        for (speed, (tendon, &length_m)) in speeds_m
            .iter_mut()
            .zip(tendons.iter_mut().zip(deviations_m))
        {
            *speed = tendon.step(length_m, &filter);
        }
        let swing_m = swing(speeds_m, per_pretension);
        self.watch(&swing_m);
        let slow = min(time_constant_s * T::from(WHOLE_RAD_PER_S), T::one());
        let gain = min(
            self.twice_ratio * slow,
            self.gain_by_inertia * inertia / time_constant_s,
        );
        swing_m.map(|speed_m| {
            let braked_m = speed_m - clamp_symmetric(speed_m, T::from(LEAST_M));
            clamp_symmetric(-gain * braked_m, T::from(MOST_M))
        })
    }
}

/// The swing that speeds show. A swing has no part along the tensions per pretension. Where a third of the sum of the squares or more is
/// such a part, something has happened to all load cells: there is no swing. Otherwise one of the speeds is replaced by what
/// the other two ask for, the one for which the sum of the squares becomes least: what one sensor alone shows is no swing.
#[inline(always)]
fn swing<T: Scalar>(speeds: [T; 3], per_pretension: &SVector<T, 3>) -> [T; 3] {
    let (mut along, mut square) = (T::SUM_START, T::SUM_START);
    for (i, &speed) in speeds.iter().enumerate() {
        along += per_pretension[i] * speed;
        square += speed * speed;
    }
    // The squares of the tensions per pretension add up to three, so that a third of `along` squared is that part.
    if square < along * along {
        return [T::zero(); 3];
    }
    let mut corrections = [T::zero(); 3];
    let (mut least, mut at) = (T::MAX, 0);
    for (i, correction) in corrections.iter_mut().enumerate() {
        *correction = along / per_pretension[i];
        // By so much the sum of the squares grows.
        let growth = *correction * (*correction - T::TWO * speeds[i]);
        if growth < least {
            (least, at) = (growth, i);
        }
    }
    let mut swing = speeds;
    for (i, speed) in swing.iter_mut().enumerate() {
        if i == at {
            *speed -= corrections[i];
        }
    }
    swing
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{FOLLOWED_STEPS, LEAST_M, MOST_M, MOVING_SWINGING_M, SWINGING_M, SwingDamping};
    use crate::settings::Settings;
    use nalgebra::SVector;

    /// The time constant 1/ω of a leg of 4 Hz whose tendons are alike, and how the lengths of one swing in it.
    const TIME_CONSTANT_S: f64 = 0.04;
    const INERTIA: f64 = 0.11;
    const SWING: [f64; 3] = [1.0, -0.5, -0.5];

    /// Offsets over two swings of tendons that are longer by `amplitude_m` times `parts`.
    fn offsets(parts: [f64; 3], amplitude_m: f64) -> Vec<[f64; 3]> {
        let mut damping = SwingDamping::<f64>::new(&Settings::table_1().unwrap());
        let step = |i: u32| {
            let phase = f64::from(i) * 1e-3 / TIME_CONSTANT_S;
            let deviations_m = parts.map(|part| part * amplitude_m * phase.sin());
            damping.step(
                &deviations_m,
                &SVector::repeat(1.0),
                INERTIA,
                TIME_CONSTANT_S,
            )
        };
        (0..500).map(step).collect()
    }

    fn largest(offsets: &[[f64; 3]]) -> f64 {
        offsets.iter().flatten().fold(0.0, |a, b| a.max(b.abs()))
    }

    /// The tendons give way behind the leg: over a swing they take energy from it, as much as a damper of the ratio would.
    #[test]
    fn a_swing_is_braked() {
        let amplitude_m = 1e-4;
        let twice_ratio = 2.0 * f64::from(Settings::table_1().unwrap().motion.damping_ratio);
        let offsets = offsets(SWING, amplitude_m);
        let steps = (core::f64::consts::TAU * TIME_CONSTANT_S / 1e-3).round() as usize;
        // Work of the offset of the first tendon by its length, m², against that of a damper: twice the ratio × time constant × speed.
        let mut work = 0.0;
        for (i, offset_m) in offsets.iter().enumerate().skip(500 - steps) {
            let speed = amplitude_m * (i as f64 * 1e-3 / TIME_CONSTANT_S).cos() / TIME_CONSTANT_S;
            work -= offset_m[0] * speed * 1e-3;
        }
        let ideal = twice_ratio * core::f64::consts::PI * amplitude_m * amplitude_m;
        assert!((0.9..1.1).contains(&(work / ideal)), "{}", work / ideal);
        assert!(largest(&offsets) < 1.3 * twice_ratio * amplitude_m);
    }

    #[test]
    fn a_large_swing_is_braked_by_no_more_than_is_said() {
        let most_m = largest(&offsets(SWING, 1e-2));
        assert!((most_m - f64::from(MOST_M)).abs() < 1e-9, "{most_m}");
        let page = include_str!("../../../SAFETY.md");
        let said = format!("by at most {} mm of each", 1000.0 * MOST_M);
        assert!(page.contains(&said), "{said}");
    }

    /// One length that changes alone is a sensor that reads wrong; so are three that change as pretension does.
    #[test]
    fn what_no_swing_explains_moves_nothing() {
        for parts in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]] {
            assert_eq!(largest(&offsets(parts, 1e-4)), 0.0, "{parts:?}");
        }
    }

    /// The motors rest while the load cells are noisy.
    #[test]
    fn the_least_swing_is_left_alone() {
        // In the first swing the filters still forget the begin.
        let second = |amplitude_m| largest(&offsets(SWING, amplitude_m)[250..]);
        assert_eq!(second(0.95 * f64::from(LEAST_M)), 0.0);
        assert!(second(1.1 * f64::from(LEAST_M)) > 0.0);
    }

    /// How long a swing whose amplitude, m, changes by so much in a second, 1/s, takes until it is found, s.
    fn found_after_s(amplitude_m: f64, growth_per_s: f64, moving: bool) -> Option<f64> {
        let mut damping = SwingDamping::<f64>::new(&Settings::table_1().unwrap());
        (0..5000).map(|i| f64::from(i) * 1e-3).find(|&time_s| {
            let amplitude_m = amplitude_m * (growth_per_s * time_s).exp();
            let length_m = amplitude_m * (time_s / TIME_CONSTANT_S).sin();
            damping.step(
                &SWING.map(|part| part * length_m),
                &SVector::repeat(1.0),
                INERTIA,
                TIME_CONSTANT_S,
            );
            if moving {
                damping.forget_small_swing();
            }
            damping.keeps_swinging()
        })
    }

    /// A damping ratio of 0.02 at 25 rad/s lets a swing fall by 0.5 in a second. One that grows by 1.5 or 5 in a second is
    /// found sooner than one that stays.
    #[test]
    fn a_swing_that_does_not_ring_down_is_found() {
        let swinging_m = f64::from(SWINGING_M);
        for (growth_per_s, within_s) in [(0.0, 1.8..2.5), (1.5, 0.4..1.3), (5.0, 0.4..1.2)] {
            let after_s = found_after_s(1.3 * swinging_m, growth_per_s, false).unwrap();
            assert!(within_s.contains(&after_s), "{growth_per_s}: {after_s}");
        }
        assert_eq!(found_after_s(0.9 * swinging_m, 0.0, false), None);
        let moving_m = f64::from(MOVING_SWINGING_M);
        assert_eq!(found_after_s(0.9 * moving_m, 0.0, true), None);
        let after_s = found_after_s(1.3 * moving_m, 0.0, true);
        assert!(after_s.is_some_and(|s| (1.8..2.5).contains(&s)));
        for growth_per_s in [-0.5, -2.0] {
            assert_eq!(found_after_s(20.0 * swinging_m, growth_per_s, false), None);
        }
    }

    /// A leg that swings a little, and whose lengths then change by a push for 0.1 s ever faster: 0.1 s of growth count for less than 0.4 s, not for 1 s.
    #[test]
    fn a_push_counts_for_no_more_than_four_times_as_long() {
        let mut damping = SwingDamping::<f64>::new(&Settings::table_1().unwrap());
        let mut counted = |begin: u32, steps: u32, length_m: &dyn Fn(f64) -> f64| {
            let before = damping.swinging_steps;
            for i in begin..begin + steps {
                let length_m = length_m(f64::from(i) * 1e-3);
                damping.step(
                    &SWING.map(|part| part * length_m),
                    &SVector::repeat(1.0),
                    INERTIA,
                    TIME_CONSTANT_S,
                );
            }
            damping.swinging_steps - before
        };
        let swing = |time_s: f64| 2.0 * f64::from(SWINGING_M) * (time_s / TIME_CONSTANT_S).sin();
        let swung = counted(0, 800, &swing);
        assert!((FOLLOWED_STEPS..=800).contains(&swung), "{swung}");
        let pushed = counted(800, 100, &|time_s| {
            swing(time_s) + 0.3 * (time_s - 0.8).powi(2)
        });
        assert!((130..400).contains(&pushed), "{pushed}");
    }
}
