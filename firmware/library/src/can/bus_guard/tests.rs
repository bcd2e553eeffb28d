use super::BusState::{BusOff, ErrorActive, ErrorPassive};
use super::{BusAction, BusGuard};

const BIT_RATE: u32 = 1_000_000;
/// 128 × 11 bits at [`BIT_RATE`].
const RECOVERY_US: u32 = 1408;
const STEP_US: u32 = 100;

/// Keeps the bus off until the guard asks for a restart; returns how long that took, µs.
fn restart_delay_us(guard: &mut BusGuard) -> u32 {
    for step in 1..100_000 {
        if guard.watch(BusOff, STEP_US) == BusAction::Restart {
            return step * STEP_US;
        }
    }
    panic!("no restart")
}

fn keep(guard: &mut BusGuard, state: super::BusState, time_us: u32) {
    for _ in 0..time_us / STEP_US {
        assert_eq!(guard.watch(state, STEP_US), BusAction::None);
    }
}

/// As the next step after `time_us`.
fn rounded_to_step_us(time_us: u32) -> u32 {
    time_us.div_ceil(STEP_US) * STEP_US
}

#[test]
fn what_waits_is_given_up_once_when_the_bus_goes_off() {
    let mut guard = BusGuard::new(BIT_RATE);
    assert_eq!(guard.watch(ErrorPassive, STEP_US), BusAction::None);
    assert_eq!(guard.watch(BusOff, STEP_US), BusAction::GiveUp);
    assert_eq!(guard.watch(BusOff, STEP_US), BusAction::None);
    assert_eq!((guard.state(), guard.bus_offs()), (BusOff, 1));
}

#[test]
fn each_restart_waits_longer_than_the_one_before_up_to_a_second() {
    let mut guard = BusGuard::new(BIT_RATE);
    guard.watch(BusOff, STEP_US);
    for delay_ms in [10, 20, 40, 80, 160, 320, 640, 1000, 1000] {
        let expected = rounded_to_step_us(RECOVERY_US + delay_ms * 1000);
        assert_eq!(restart_delay_us(&mut guard), expected, "{delay_ms} ms");
    }
    assert_eq!(guard.bus_offs(), 1);
}

/// However seldom the controller is looked at: not a microsecond early, and not late.
#[test]
fn a_restart_comes_when_its_wait_is_over() {
    const WAIT_US: u32 = RECOVERY_US + 10_000;
    for before_us in [1, WAIT_US / 2, WAIT_US - 1] {
        let mut guard = BusGuard::new(BIT_RATE);
        guard.watch(BusOff, STEP_US);
        assert_eq!(guard.watch(BusOff, before_us), BusAction::None);
        let left_us = WAIT_US - before_us;
        if left_us > 1 {
            assert_eq!(guard.watch(BusOff, left_us - 1), BusAction::None);
        }
        assert_eq!(guard.watch(BusOff, 1), BusAction::Restart);
    }
}

#[test]
fn the_delay_grows_over_restarts_that_succeed_for_a_moment() {
    let mut guard = BusGuard::new(BIT_RATE);
    for (count, delay_ms) in [(1, 10), (2, 20), (3, 40)] {
        assert_eq!(guard.watch(BusOff, STEP_US), BusAction::GiveUp);
        assert_eq!(guard.bus_offs(), count);
        assert_eq!(
            restart_delay_us(&mut guard),
            rounded_to_step_us(RECOVERY_US + delay_ms * 1000)
        );
        keep(&mut guard, ErrorActive, 500_000);
    }
}

#[test]
fn a_second_without_errors_makes_the_delay_short_again() {
    for (calm_us, delay_ms) in [(900_000, 20), (1_100_000, 10)] {
        let mut guard = BusGuard::new(BIT_RATE);
        guard.watch(BusOff, STEP_US);
        restart_delay_us(&mut guard);
        keep(&mut guard, ErrorActive, calm_us);
        guard.watch(BusOff, STEP_US);
        let expected = rounded_to_step_us(RECOVERY_US + delay_ms * 1000);
        assert_eq!(restart_delay_us(&mut guard), expected, "{calm_us} µs");
    }
    // Also in one look.
    let mut guard = BusGuard::new(BIT_RATE);
    guard.watch(BusOff, STEP_US);
    restart_delay_us(&mut guard);
    guard.watch(ErrorActive, STEP_US);
    guard.watch(ErrorActive, 1_100_000);
    guard.watch(BusOff, STEP_US);
    assert_eq!(
        restart_delay_us(&mut guard),
        rounded_to_step_us(RECOVERY_US + 10_000)
    );
}

#[test]
fn an_error_passive_time_is_not_calm() {
    let mut guard = BusGuard::new(BIT_RATE);
    guard.watch(BusOff, STEP_US);
    restart_delay_us(&mut guard);
    keep(&mut guard, ErrorActive, 900_000);
    keep(&mut guard, ErrorPassive, 2_000_000);
    keep(&mut guard, ErrorActive, 900_000);
    guard.watch(BusOff, STEP_US);
    assert_eq!(
        restart_delay_us(&mut guard),
        rounded_to_step_us(RECOVERY_US + 20_000)
    );
}

#[test]
fn a_slower_bus_needs_a_longer_wait() {
    let mut guard = BusGuard::new(125_000);
    guard.watch(BusOff, STEP_US);
    assert_eq!(
        restart_delay_us(&mut guard),
        rounded_to_step_us(8 * RECOVERY_US + 10_000)
    );
}

#[test]
fn no_bit_rate_and_no_time_overflow_nothing() {
    let mut guard = BusGuard::new(0);
    guard.watch(BusOff, u32::MAX);
    assert_eq!(guard.watch(BusOff, u32::MAX), BusAction::Restart);
    assert_eq!(guard.watch(BusOff, 1), BusAction::None);
    for _ in 0..70_000 {
        guard.watch(ErrorActive, 1);
        guard.watch(BusOff, 1);
    }
    assert_eq!(guard.bus_offs(), u16::MAX);
}
