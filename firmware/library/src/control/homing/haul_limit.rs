//! What a motor draws that reels in a tendon: more than its friction and the highest tension of homing ask for is too much.

use crate::control::{JogBounds, bounds};
use leg_model::Scalar;

/// Part of the friction by the settings by which that of a motor may be more than it was: behind a slow gear the highest tension of homing
/// takes a few hundredths of an ampere, less than what friction changes by.
const FRICTION_SPREAD: f32 = 0.5;

/// The most that a motor draws but for moments. By the settings its friction may be half more than they say: on the paper's rig that is
/// the current of 18 N. What it draws while its tendon is slack is its friction itself.
#[derive(Clone, Copy, Debug)]
pub struct HaulLimit<T> {
    most_a: T,
    /// What of that the tension asks for, or friction changes by, A.
    pull_a: T,
    /// Whether the last current reeled in.
    inwards: bool,
}

impl<T: Scalar> HaulLimit<T> {
    /// By the settings.
    pub fn new(jog: &JogBounds<T>) -> Self {
        let friction_a = jog.current_max_a - jog.pull_max_a;
        Self {
            most_a: jog.current_max_a,
            pull_a: bounds::max(jog.pull_max_a, friction_a * T::from(FRICTION_SPREAD)),
            inwards: false,
        }
    }

    /// One tick: whether a current, A, is too much, and has the direction of the last one. A motor that starts and brakes at a tendon that the swinging leg
    /// leaves slack again turns about, and one that hauls does not. One that rings there is not found by this.
    #[inline(always)]
    pub fn update(&mut self, current_a: T) -> bool {
        let inwards = current_a > T::zero();
        let turned = core::mem::replace(&mut self.inwards, inwards) != inwards;
        !(current_a.abs() <= self.most_a) && !turned
    }

    /// By what the motor draws while its tendon is slack, A, but no higher than by the settings.
    pub fn lower(&mut self, slack_a: T) {
        self.most_a = bounds::min(self.most_a, slack_a.abs() + self.pull_a);
    }
}

#[cfg(test)]
mod tests {
    use super::HaulLimit;

    /// Friction that is more than by the settings allows no more than these.
    #[test]
    fn a_limit_is_that_of_the_friction_or_of_the_settings() {
        for (friction_a, expected_a) in [(0.05, 0.15), (-0.05, 0.15), (0.0, 0.1), (0.25, 0.3)] {
            let mut limit = HaulLimit {
                most_a: 0.3,
                pull_a: 0.1,
                inwards: false,
            };
            limit.lower(friction_a);
            for sign in [1.0_f64, -1.0] {
                assert!(!limit.update(sign * (expected_a + 1e-6)), "turned");
                assert!(!limit.update(sign * (expected_a - 1e-6)));
                assert!(limit.update(sign * (expected_a + 1e-6)));
            }
            assert!(limit.update(f64::NAN));
        }
    }
}
