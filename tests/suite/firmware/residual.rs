//! What forward kinematics leaves of the three lengths.

use super::still_leg::StillLeg;
use leg_firmware::command::Command;
use leg_firmware::control::CYCLE_TICKS;
use leg_firmware::supervisor::{Fault, State};

#[test]
fn a_zero_that_is_not_the_legs_shows_as_a_residual() {
    // A tendon that is longer than its zero says leaves about half of that over.
    for (off_m, expected_m) in [(0.0, 0.0..1e-6), (1e-4, 3e-5..8e-5), (4e-4, 1.2e-4..3.2e-4)] {
        let mut still = StillLeg::armed_with(|settings| {
            if let Some(zero_m) = &mut settings.axes[0].unstretched_at_zero_m {
                *zero_m += off_m;
            }
        });
        // Shorter than the motors, which do not turn, are waited for.
        still.run(16);
        let residual_m = still.leg.telemetry().residual_m;
        assert!(
            expected_m.contains(&residual_m),
            "{off_m} m: {residual_m} m"
        );
        assert!(residual_m != 0.0);
    }
}

/// What the sensors showed before a leg was held stands when it follows commands again: otherwise a load cell that fades in the
/// tenth of a second after would be believed, and a swing in it would be taken for how the leg is at rest.
#[test]
fn a_held_leg_that_follows_again_remembers_what_its_sensors_showed() {
    let disagrees = |reads_wrong: bool| {
        let mut still = StillLeg::armed();
        still.run(1000);
        assert_eq!(still.obey(Command::Stop), Ok(()));
        still.run(100);
        assert_eq!(still.leg.state(), State::Held);
        let faults = still.leg.telemetry().faults;
        assert!(!faults.any(), "{faults:?}");
        assert_eq!(still.obey(Command::Clear), Ok(()));
        assert_eq!(still.leg.state(), State::Active);
        let before_n = still.leg.telemetry().tensions_n[0];
        for _ in 0..50 {
            if reads_wrong {
                still.sensors.cell_codes[0] -= 30;
            }
            still.run_silent(CYCLE_TICKS.into());
        }
        still.run_silent(600);
        let change_n = still.leg.telemetry().tensions_n[0] - before_n;
        assert_eq!(change_n < -5.0, reads_wrong, "{change_n} N");
        still.leg.telemetry().faults.has(Fault::Residual)
    };
    assert!(disagrees(true));
    assert!(!disagrees(false));
}
