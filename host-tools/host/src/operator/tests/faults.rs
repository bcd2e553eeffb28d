//! Faults before and in mid-move.

use super::{emulated, host, lean, state};
use crate::operator::OperatorError;
use leg_firmware::supervisor::{Fault, State};
use leg_sim::emulated_leg::Beginning;
use leg_sim::plant::Fault as PlantFault;
use std::time::Duration;

#[test]
fn a_latched_fault_is_named_with_its_cure_until_it_is_cleared() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    leg.touch(|plant| plant.press_emergency_stop(true));
    operator.pause(Duration::from_millis(10)).unwrap();
    let error = operator.reach(&lean(10.0)).unwrap_err();
    assert!(
        error.to_string().contains("fault 23, emergency stop"),
        "{error}"
    );
    assert!(
        error.remedy().ends_with("then `leg clear`"),
        "{}",
        error.remedy()
    );
    // Its cause is still there.
    assert!(matches!(
        operator.clear().unwrap_err(),
        OperatorError::NotCleared { faults } if faults.has(Fault::EmergencyStop)
    ));
    leg.touch(|plant| plant.press_emergency_stop(false));
    operator.pause(Duration::from_millis(10)).unwrap();
    operator.clear().unwrap();
    assert_eq!(state(&mut operator), State::Disarmed);
    operator.reach(&lean(10.0)).unwrap();
}

#[test]
fn a_fault_on_the_way_is_told() {
    let leg = emulated(Beginning::Hanging);
    let mut operator = host(&leg, 1);
    operator.reach(&lean(5.0)).unwrap();
    leg.touch(|plant| plant.set_fault(PlantFault::DriverFault(1), true));
    let error = operator.reach(&lean(20.0)).unwrap_err();
    assert!(error.to_string().contains("driver fault"), "{error}");
}
