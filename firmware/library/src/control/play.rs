//! The play of the gears: where the screws are, of which the encoders on the motors show a part.

use super::bounds::{max, min};
use leg_model::Scalar;

/// The gears, followed by the counts of their motors. A gear touches its screw on one side while the tendon is reeled in, on the
/// other while it is paid out, and the screw stays between them.
#[derive(Clone, Copy, Debug)]
pub struct Play<T> {
    play_m: T,
    /// Where the motors were, as how far the tendons would be pulled in, m.
    pulled_m: [T; 3],
    /// How far each motor is behind its screw, m: the play or less.
    behind_m: [T; 3],
}

impl<T: Scalar> Play<T> {
    /// Gears with a play, m, that touch as after reeling in: so homing leaves them.
    pub fn new(play_m: f32) -> Self {
        Self {
            play_m: play_m.into(),
            pulled_m: [T::zero(); 3],
            behind_m: [T::zero(); 3],
        }
    }

    /// How far each motor is behind its screw, m.
    #[inline(always)]
    pub fn behind_m(&self) -> &[T; 3] {
        &self.behind_m
    }

    /// Follows the motors to where they would pull the tendons in, m.
    #[inline(always)]
    pub fn follow(&mut self, pulled_m: &[T; 3]) {
        for (i, &pulled) in pulled_m.iter().enumerate() {
            let behind = self.behind_m[i] + (self.pulled_m[i] - pulled);
            self.behind_m[i] = min(max(behind, T::zero()), self.play_m);
        }
        self.pulled_m = *pulled_m;
    }
}

#[cfg(test)]
mod tests {
    use super::Play;

    #[test]
    fn a_screw_stays_while_its_motor_crosses_the_play() {
        let mut play = Play::<f64>::new(2.0);
        for (pulled, behind) in [
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
            assert_eq!(play.behind_m(), &[behind, 0.0, 0.0], "{pulled}");
        }
    }
}
