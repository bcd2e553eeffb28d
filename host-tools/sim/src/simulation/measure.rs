//! The value of each measurand.

use super::test_stand::TestStand;
use crate::scenario::Measurand;
use leg_firmware::telemetry::Telemetry;

pub(super) fn measure(measurand: Measurand, stand: &TestStand<'_>) -> f64 {
    let reported = |value: fn(&Telemetry<f32>) -> f32| {
        let value = stand.leg.telemetry().map(value);
        value.map_or(f64::NAN, f64::from)
    };
    match measurand {
        Measurand::TipErrorMm => stand.average_tip_m().map_or(f64::NAN, |tip_m| {
            (tip_m - stand.leg.commanded_m()).norm() * 1000.0
        }),
        Measurand::FollowErrorMm => stand.follow_error.largest_mm(),
        Measurand::FollowLagMs => stand.follow_error.lag_ms(),
        Measurand::TipMovedMm => stand.extremes.tip_moved_mm,
        Measurand::TensionMinN => stand.extremes.tensions_n[0],
        Measurand::TensionMaxN => stand.extremes.tensions_n[1],
        Measurand::OutsideMs => stand.extremes.outside_ms,
        Measurand::PayloadKg => reported(|telemetry| telemetry.payload_kg),
        Measurand::PretensionN => reported(|telemetry| telemetry.pretension_n),
        Measurand::StiffnessNmPerRad => reported(|telemetry| telemetry.stiffness_nm_per_rad),
        Measurand::HomingErrorMm => homing_error_mm(stand),
    }
}

fn homing_error_mm(stand: &TestStand<'_>) -> f64 {
    let telemetry = stand.leg.telemetry();
    let found = telemetry.map_or([f32::NAN; 3], |telemetry| telemetry.unstretched_at_zero_m);
    let errors = found
        .iter()
        .zip(stand.leg.leg().plant().unstretched_at_zero_m())
        .map(|(found, real)| (f64::from(*found) - real).abs() * 1000.0);
    errors.fold(0.0, f64::max)
}
