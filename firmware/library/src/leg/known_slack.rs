//! Where the tendons of a leg are known to be slack: where the last ramp down led them.

use super::shared::Shared;
use crate::control::Measured;
use crate::supervisor::State;
use leg_model::Scalar;

impl<T: Scalar> Shared<T> {
    /// Tension above which a tendon pulls, N: half of the minimum. That is below what any target asks for, and above what is left in tendons
    /// that were paid out.
    #[inline(always)]
    pub fn taut_n(&self) -> T {
        self.mechanism.f_min_n * T::HALF
    }

    /// Forgets where the tendons are slack of a leg that comes to a state: that of one that pulls, as the leg is armed or cleared; all of them as it
    /// homes or is jogged, or with a fault, by which a leg may be off while its tendons pull.
    pub fn forget_slack(&mut self, state: State, unfaulted: bool, measured: &Measured<T>) {
        let all = !unfaulted || matches!(state, State::Homing | State::Jogging);
        let taut_n = self.taut_n();
        for (slack, &tension_n) in self
            .known_slack_m
            .iter_mut()
            .zip(&measured.steady_tensions_n)
        {
            if all || state == State::Active && tension_n > taut_n {
                *slack = -T::MAX;
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use crate::control::Measured;
    use crate::leg::held::Momentum;
    use crate::leg::mode::{Mode, Trust};
    use crate::leg::shared::{Checked, Shared};
    use crate::settings::Settings;
    use crate::supervisor::State;

    /// A cell that shows nothing makes no tendon slack: what is known is forgotten by what pulls, and learned by a ramp down alone.
    #[test]
    fn slack_is_forgotten_where_a_tendon_pulls_or_is_led_elsewhere_or_a_fault_is_latched() {
        let settings = Settings::table_1().unwrap();
        let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        let taut_n = f64::from(settings.f_min_n) / 2.0;
        let armed = Measured::resting([0.01; 3], [0.99 * taut_n, 1.01 * taut_n, 0.0]);
        let unknown_m = [-f64::MAX; 3];
        let known_m = [0.02, 0.03, 0.04];
        for (state, unfaulted, forgotten) in State::ALL.into_iter().flat_map(|state| {
            let led = matches!(state, State::Homing | State::Jogging);
            [(state, true, led), (state, false, true)]
        }) {
            for before_m in [known_m, unknown_m] {
                shared.known_slack_m = before_m;
                shared.forget_slack(state, unfaulted, &armed);
                let expected_m = match state {
                    _ if forgotten => unknown_m,
                    State::Active => [before_m[0], -f64::MAX, before_m[2]],
                    _ => before_m,
                };
                assert_eq!(shared.known_slack_m, expected_m, "{state:?} {unfaulted}");
            }
        }
    }

    /// A fault may end on its own while the leg is held, which brakes as it comes.
    #[test]
    fn a_leg_that_brakes_with_a_fault_forgets_its_slack() {
        let settings = Settings::table_1().unwrap();
        let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        shared.known_slack_m = [0.02; 3];
        let measured = Measured::resting([0.01; 3], [70.0; 3]);
        let momentum = Momentum {
            steps_m: [1e-6; 3],
            ticks_to_end: None,
        };
        let trust = Trust {
            pose: true,
            counters: true,
            free: true,
            currents: true,
            cells: true,
            unfaulted: false,
        };
        let mode = Mode::begin(State::Held, &mut shared, &measured, momentum, trust);
        assert!(matches!(mode, Mode::Held(held) if held.brakes()));
        assert_eq!(shared.known_slack_m, [-f64::MAX; 3]);
    }
}
