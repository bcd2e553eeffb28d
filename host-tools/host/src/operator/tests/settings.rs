//! Settings of the board.

use super::{emulated, host, lean};
use crate::operator::{OperatorError, differences};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::settings::SettingsError;
use leg_sim::emulated_leg::Beginning;

#[test]
fn settings_are_read_back_and_refused_by_name() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    let mut settings = operator.settings().unwrap().without_zero();
    settings.limits.slack_n = 3.0;
    operator.set_settings(&settings).unwrap();
    let found = operator.settings().unwrap();
    assert!(differences(&settings, &found).is_empty());
    settings.motion.speed_rad_per_s = 0.5;
    let names: Vec<_> = differences(&settings, &found)
        .into_iter()
        .map(|difference| difference.name)
        .collect();
    assert_eq!(names, ["motion.speed_rad_per_s"]);
    operator.save_settings().unwrap();
    settings.limits.slack_n = -1.0;
    let error = operator.set_settings(&settings).unwrap_err();
    assert!(
        matches!(
            error,
            OperatorError::Refused {
                refusal: HostRefusal::Settings(SettingsError::OutOfRange(_)),
                ..
            }
        ),
        "{error}"
    );
    assert_eq!(operator.settings().unwrap().limits.slack_n, 3.0);
    // They change the leg's zero, so it has to be homed.
    assert!(!operator.telemetry().unwrap().telemetry.homed);
}

#[test]
fn settings_of_a_driven_leg_stay() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    operator.reach(&lean(5.0)).unwrap();
    let settings = operator.settings().unwrap();
    let error = operator.set_settings(&settings).unwrap_err();
    assert!(
        matches!(
            error,
            OperatorError::Refused {
                refusal: HostRefusal::Driven,
                ..
            }
        ),
        "{error}"
    );
}
