//! The play of the gears: where the screws are, of which the encoders on the motors show a part.

use super::bounds::{max, min};
use leg_model::Scalar;

/// The least change of a length that is asked for in which a motor is led across the whole play, m: on the paper's rig 9 µm at the tip.
/// On a leg without the play of its settings the brake has its gain and that of the crossing, 3.4 in all; with 7e-7 it has 4.4, and such a
/// leg swings on by itself. More would leave the leg beside its target where the direction changes.
const TURN_MIN_M: f32 = 1e-6;

/// The same by the play: so many times as far as what is asked for goes a motor while it crosses the play. More would have a motor
/// with a large play turn to and fro by what rounding changes.
const CROSSING_GAIN: f32 = 6.0;

/// Part of the error of a motor within the play that a step of 1 ms corrects: in 50 ms, slowly beside the swing and the servo, whose
/// margins it leaves. Without it the tip rests up to 5 µm off for each tendon that has not turned by a whole [`Play::turn_m`].
const CORRECTED_PART: f32 = 0.02;

/// The gears, followed by the counts of their motors. A gear touches its screw on one side while the tendon is reeled in, on the
/// other while it is paid out, and the screw stays between them.
#[derive(Clone, Copy, Debug)]
pub struct Play<T> {
    gears: [Gear<T>; 3],
    /// Where the motors were, as how far the tendons would be pulled in, m.
    pulled_m: [T; 3],
    /// How far each motor is behind its screw, m: the play or less.
    lag_m: [T; 3],
    /// The lengths that were asked for, m, where they changed their direction last: no farther from the present ones than `turn_m`. None
    /// where no motor is led.
    turned_m: Option<[T; 3]>,
}

/// What does not change of a gear.
#[derive(Clone, Copy, Debug)]
struct Gear<T> {
    play_m: T,
    /// The change of a length in which a motor crosses the play, m.
    turn_m: T,
    /// The play by that.
    gain: T,
    /// Part of a motor's error within the play that each step corrects, by the gain.
    correction: T,
}

impl<T: Scalar> Gear<T> {
    fn new(play_m: f32) -> Self {
        let turn_m = (play_m / CROSSING_GAIN).max(TURN_MIN_M);
        Self {
            play_m: play_m.into(),
            turn_m: turn_m.into(),
            gain: T::from(play_m / turn_m),
            correction: if play_m > 0.0 {
                T::from(CORRECTED_PART * turn_m / play_m)
            } else {
                T::zero()
            },
        }
    }
}

impl<T: Scalar> Play<T> {
    /// Gears with each its play, m, that touch as after reeling in: so homing leaves them.
    pub fn new(plays_m: [f32; 3]) -> Self {
        Self {
            gears: plays_m.map(Gear::new),
            pulled_m: [T::zero(); 3],
            lag_m: [T::zero(); 3],
            turned_m: None,
        }
    }

    /// Crosses from where the motors are when it is asked next.
    pub fn start(&mut self) {
        self.turned_m = None;
    }

    /// How far each motor shall be behind its screw, m, for lengths without tension that are asked for, m: by the play while a tendon is
    /// paid out, by nothing while it is reeled in. It follows where the motors are slowly alone: a goal that goes with its motor at once
    /// takes 18° of the servo's phase margin.
    #[inline(always)]
    pub fn cross_m(&mut self, lengths_m: &[T; 3]) -> [T; 3] {
        let turned_m = self.turned_m.get_or_insert_with(|| {
            let mut turned_m = *lengths_m;
            let gears = self.lag_m.iter().zip(&self.gears);
            for (turned, (&lag, gear)) in turned_m.iter_mut().zip(gears) {
                // Without play both are zero.
                if lag > T::zero() {
                    *turned -= lag / gear.gain;
                }
            }
            turned_m
        });
        let mut lag_m = *lengths_m;
        let gears = self.gears.iter().zip(&self.lag_m);
        for ((lag, turned), (gear, &was)) in lag_m.iter_mut().zip(turned_m).zip(gears) {
            let length_m = *lag;
            *turned = min(max(*turned, length_m - gear.turn_m), length_m);
            *lag = (length_m - *turned) * gear.gain;
            *turned += (*lag - was) * gear.correction;
        }
        lag_m
    }

    /// How far each motor is behind its screw, m.
    #[inline(always)]
    pub fn lag_m(&self) -> &[T; 3] {
        &self.lag_m
    }

    /// Follows the motors to where they would pull the tendons in, m.
    #[inline(always)]
    pub fn follow(&mut self, pulled_m: &[T; 3]) {
        for (i, &pulled) in pulled_m.iter().enumerate() {
            let lag = self.lag_m[i] + (self.pulled_m[i] - pulled);
            self.lag_m[i] = min(max(lag, T::zero()), self.gears[i].play_m);
        }
        self.pulled_m = *pulled_m;
    }
}

#[cfg(test)]
mod tests {
    use super::{CROSSING_GAIN, Play, TURN_MIN_M};

    #[test]
    fn a_screw_stays_while_its_motor_crosses_the_play() {
        let mut play = Play::<f64>::new([2.0; 3]);
        for (pulled, lag) in [
            (0.0, 0.0),
            (5.0, 0.0),
            (4.0, 1.0),
            (4.5, 0.5),
            (3.0, 2.0),
            (-8.0, 2.0),
            (-7.0, 1.0),
            (-6.0, 0.0),
            (-5.0, 0.0),
        ] {
            play.follow(&[pulled, 0.0, 0.0]);
            assert_eq!(play.lag_m(), &[lag, 0.0, 0.0], "{pulled}");
        }
    }

    /// What motors do that are where they are led.
    fn led_m(play: &mut Play<f64>, length_m: f64) -> f64 {
        let lag_m = play.cross_m(&[length_m; 3])[2];
        play.follow(&[-length_m - lag_m; 3]);
        lag_m
    }

    /// Reeling in, the motors touch their screws; turned about, they have crossed the play when the lengths have changed by
    /// [`TURN_MIN_M`].
    #[test]
    fn a_motor_is_led_across_the_play_with_the_direction_that_is_asked_for() {
        let turn_m = f64::from(TURN_MIN_M);
        let mut play = Play::<f64>::new([2e-6; 3]);
        for (turns, part) in [
            (0.0, 0.0),
            (-3.0, 0.0),
            (-2.5, 0.5),
            (-2.25, 0.75),
            (-2.5, 0.5),
            (-2.0, 1.0),
            (7.0, 1.0),
            (6.9, 0.9),
            (6.0, 0.0),
        ] {
            let lag_m = led_m(&mut play, turns * turn_m);
            // Each step corrects a fiftieth, by 3 % of the play in all.
            assert!(
                (lag_m - part * 2e-6).abs() < 0.03 * 2e-6,
                "{turns}: {lag_m:?}"
            );
        }
    }

    /// Turned about by a part of what takes a motor across the play, its screw is not where it shall be. At rest it comes there.
    #[test]
    fn at_rest_a_screw_comes_to_its_length() {
        let turn_m = f64::from(TURN_MIN_M);
        for play_m in [5e-7_f32, 2e-6, 1.4e-5] {
            let turn_m = turn_m.max(f64::from(play_m) / f64::from(CROSSING_GAIN));
            for part in [0.2, 0.5, 0.9] {
                let mut play = Play::<f64>::new([play_m; 3]);
                led_m(&mut play, 0.0);
                let length_m = part * turn_m;
                let off_m = |play: &Play<f64>| {
                    let screw_m = play.pulled_m[2] + play.lag_m()[2];
                    (screw_m + length_m).abs()
                };
                led_m(&mut play, length_m);
                assert!(
                    off_m(&play) > 0.05 * turn_m.min(f64::from(play_m)),
                    "{play_m} {part}: it cannot fail"
                );
                for _ in 0..3000 {
                    led_m(&mut play, length_m);
                }
                assert!(
                    off_m(&play) < 0.02 * turn_m,
                    "{play_m} {part}: {}",
                    off_m(&play)
                );
            }
        }
    }

    #[test]
    fn a_motor_is_led_from_where_it_is_and_over_a_large_play_more_slowly() {
        let mut play = Play::<f64>::new([2e-6; 3]);
        play.follow(&[-1e-6; 3]);
        assert!(
            (play.cross_m(&[0.1; 3])[0] - 1e-6).abs() < 1e-12,
            "from where it is"
        );
        assert_eq!(Play::<f64>::new([0.0; 3]).cross_m(&[0.1; 3]), [0.0; 3]);
        // A large play is crossed over a longer way: six times as far as what is asked for goes the motor.
        let mut large = Play::<f64>::new([1.4e-5; 3]);
        assert_eq!(large.cross_m(&[0.1; 3]), [0.0; 3]);
        let lag_m = large.cross_m(&[0.1 + 1e-6; 3]);
        assert!((lag_m[0] - 6e-6).abs() < 1e-9, "{lag_m:?}");
    }
}
