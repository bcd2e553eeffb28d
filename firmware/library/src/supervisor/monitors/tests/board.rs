//! What all axes share.

use super::*;

#[test]
fn what_all_axes_share_is_watched_in_every_tick() {
    is_no_fault("low", |l, s| {
        s.measured.supply_v = f64::from(l.supply_min_v)
    });
    is_no_fault("high", |l, s| {
        s.measured.supply_v = f64::from(l.supply_max_v)
    });
    is_fault(Fault::SupplyLow, 1, |l, s| {
        s.measured.supply_v = f64::from(l.supply_min_v) - 0.01;
    });
    is_no_fault("off", |_, s| (s.driven, s.measured.supply_v) = (false, 0.0));
    for driven in [true, false] {
        is_fault(Fault::SupplyHigh, 1, |l, s| {
            s.driven = driven;
            s.measured.supply_v = f64::from(l.supply_max_v) + 0.01;
        });
        is_fault(Fault::OverTemperature, 1, |l, s| {
            s.driven = driven;
            s.measured.temperature_c = f64::from(l.temperature_c) + 0.01;
        });
        is_fault(Fault::DriverFault, 1, |_, s| {
            (s.driven, s.sensors.driver_fault[AXIS]) = (driven, true);
        });
        is_fault(Fault::LateTick, 1, |_, s| {
            (s.driven, s.sensors.late) = (driven, true);
        });
        is_fault(Fault::EmergencyStop, 1, |_, s| {
            (s.driven, s.sensors.emergency_stop) = (driven, true);
        });
        is_fault(Fault::SettingsCorrupt, 1, |_, s| {
            (s.driven, s.sensors.settings_corrupt) = (driven, true);
        });
    }
    is_no_fault("warm", |l, s| {
        s.measured.temperature_c = f64::from(l.temperature_c);
    });
    is_no_fault("left over", |l, s| s.residual_m = f64::from(l.residual_m));
    // Its filter counts ticks.
    let time = (ticks(limits().residual_time_s) / u32::from(CYCLE_TICKS)) as u16;
    for residual_m in [f64::from(limits().residual_m) * 1.01, f64::NAN] {
        is_fault(Fault::Residual, time, |_, s| s.residual_m = residual_m);
    }
}
