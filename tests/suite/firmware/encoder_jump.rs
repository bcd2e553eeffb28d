//! An encoder that jumps: whatever it reads, no motor is driven with more than its supply.

use super::still_leg::StillLeg;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::control::CYCLE_TICKS;
use leg_firmware::supervisor::{Fault, State};

#[test]
fn a_jump_of_any_size_asks_for_no_more_than_the_supply() {
    for axis in 0..3 {
        for jump in (0..=u16::MAX).step_by(257) {
            let StillLeg {
                mut leg,
                mut sensors,
                ..
            } = StillLeg::armed();
            for _ in 0..8 {
                sensors.encoder_counts[axis] = sensors.encoder_counts[axis].wrapping_add(jump);
                let duty = leg.tick(&sensors).duty;
                let sound = duty.iter().all(|duty| duty.abs() <= 1.0);
                assert!(sound, "axis {axis}, {jump} counts: {duty:?}");
            }
        }
    }
}

/// What was counted is lost: the leg is switched off, and does not follow its zero again.
#[test]
fn a_jump_ends_the_zero() {
    let mut still = StillLeg::armed();
    let count = &mut still.sensors.encoder_counts[1];
    *count = count.wrapping_add(1000);
    // Found in the first cycle; gone in the second.
    still.run(2 * u16::from(CYCLE_TICKS));
    let telemetry = still.leg.telemetry();
    assert_eq!(telemetry.state, State::Off);
    assert!(telemetry.faults.has(Fault::EncoderJump) && !telemetry.homed);
    assert_eq!(still.obey(Command::Clear), Ok(()));
    assert_eq!(still.leg.telemetry().state, State::Disarmed);
    let refused = still.obey(Command::Arm);
    assert_eq!(refused, Err(CommandRefusal::NotHomed));
}
