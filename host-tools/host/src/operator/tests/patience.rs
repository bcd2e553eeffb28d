//! Legs that wait for their host longer or less long than others.

use super::{emulated_rig, host, lean, state};
use crate::operator::{Operator, OperatorError};
use crate::transport::emulated::Emulated;
use leg_firmware::supervisor::State;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::Beginning;

fn waiting(command_time_s: f32) -> (Emulated, Operator) {
    let mut rig = RigFile::load(None).unwrap();
    rig.gains.limits.command_time_s = command_time_s;
    let leg = emulated_rig(&rig, Beginning::Hanging);
    let operator = host(&leg, 1);
    (leg, operator)
}

#[test]
fn a_leg_that_waits_less_long_hears_of_its_host_more_often() {
    for (command_time_s, silence_ms) in [(0.02, 5.0), (0.06, 15.0), (0.2, 50.0), (100.0, 50.0)] {
        let (_leg, mut operator) = waiting(command_time_s);
        operator.reach(&lean(10.0)).unwrap();
        assert_eq!(state(&mut operator), State::Held, "{command_time_s} s");
        let silence_max = operator.silence_max.unwrap();
        let difference_ms = silence_max.as_secs_f64() * 1000.0 - silence_ms;
        assert!(difference_ms.abs() < 1e-3, "{command_time_s} s");
    }
}

#[test]
fn a_leg_that_waits_for_nobody_is_not_driven() {
    let (_leg, mut operator) = waiting(0.01);
    let error = operator.reach(&lean(10.0)).unwrap_err();
    assert!(matches!(error, OperatorError::Impatient { .. }), "{error}");
    assert!(
        error
            .to_string()
            .starts_with("the leg misses its host after 0.01 s of silence"),
        "{error}"
    );
    assert!(
        error.remedy().contains("0.02 or more"),
        "{}",
        error.remedy()
    );
    assert_eq!(state(&mut operator), State::Disarmed);
}
