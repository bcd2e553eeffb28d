//! What forward kinematics leaves of the three lengths.

use super::still_leg::StillLeg;

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
