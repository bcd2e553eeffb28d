//! The blink pattern of a board's LED.

use crate::supervisor::State;

/// Steps of a pattern; one takes a tenth of a second.
const STEPS: u32 = 20;

/// Time of a step, ms.
pub const BLINK_STEP_MS: u64 = 100;

/// Whether the LED is on at a step, counted from anywhere.
///
/// | state                     | pattern, 2 s            |
/// |---------------------------|-------------------------|
/// | starting                  | on                      |
/// | disarmed                  | one flash               |
/// | disarmed, fault latched   | three flashes           |
/// | homing                    | on and off by turns, 0.2 s |
/// | active                    | on, one gap             |
/// | keeping station           | on, two gaps            |
/// | held                      | on and off by turns, 1 s |
/// | ramping down             | two flashes             |
/// | off after a fault         | on and off by turns, 0.1 s |
/// | jogging                   | on, three gaps          |
#[must_use]
pub const fn led_on(state: State, faulted: bool, step: u32) -> bool {
    // The first step is the lowest bit.
    let pattern: u32 = match (state, faulted) {
        (State::Boot, _) => 0b1111_1111_1111_1111_1111,
        (State::Disarmed, false) => 0b0000_0000_0000_0000_0001,
        (State::Disarmed, true) => 0b0000_0000_0000_0001_0101,
        (State::Homing, _) => 0b0011_0011_0011_0011_0011,
        (State::Active, _) => 0b1111_1111_1111_1111_1110,
        (State::KeepingStation, _) => 0b1111_1111_1111_1111_1010,
        (State::Held, _) => 0b0000_0000_0011_1111_1111,
        (State::RampingDown, _) => 0b0000_0000_0000_0000_0101,
        (State::Off, _) => 0b0101_0101_0101_0101_0101,
        (State::Jogging, _) => 0b1111_1111_1111_1110_1010,
    };
    pattern >> (step % STEPS) & 1 == 1
}

#[cfg(test)]
mod tests {
    use super::{STEPS, led_on};
    use crate::supervisor::State;

    fn pattern(state: State, faulted: bool) -> Vec<bool> {
        (0..STEPS)
            .map(|step| led_on(state, faulted, step))
            .collect()
    }

    #[test]
    fn every_state_has_its_own_pattern() {
        let mut patterns: Vec<Vec<bool>> = State::ALL
            .into_iter()
            .map(|state| pattern(state, false))
            .collect();
        patterns.push(pattern(State::Disarmed, true));
        for (i, a) in patterns.iter().enumerate() {
            assert!(a.contains(&true), "the LED shows that tasks run");
            for b in &patterns[..i] {
                assert_ne!(a, b);
            }
        }
    }

    /// The lengths of what is on and off by turns, as long as a pattern goes, steps; it begins with what is on, which may have none.
    fn lengths(state: State, faulted: bool) -> Vec<usize> {
        let pattern = pattern(state, faulted);
        let first_off = if pattern[0] { vec![] } else { vec![0] };
        let parts = pattern.chunk_by(|a, b| a == b).map(<[bool]>::len);
        first_off.into_iter().chain(parts).collect()
    }

    /// A flash and a gap are one step each. A latched fault shows in a leg that is disarmed alone.
    #[test]
    fn a_pattern_is_the_one_of_the_table() {
        let by_turns = |steps: usize| vec![steps; STEPS as usize / steps];
        for (state, faulted, expected) in [
            (State::Boot, false, vec![20]),
            (State::Disarmed, false, vec![1, 19]),
            (State::Disarmed, true, vec![1, 1, 1, 1, 1, 15]),
            (State::Homing, false, by_turns(2)),
            (State::Active, false, vec![0, 1, 19]),
            (State::KeepingStation, false, vec![0, 1, 1, 1, 17]),
            (State::Held, false, by_turns(10)),
            (State::RampingDown, false, vec![1, 1, 1, 17]),
            (State::Off, false, by_turns(1)),
            (State::Jogging, false, vec![0, 1, 1, 1, 1, 1, 15]),
        ] {
            assert_eq!(lengths(state, faulted), expected, "{state:?} {faulted}");
            if state != State::Disarmed {
                assert_eq!(pattern(state, true), pattern(state, false));
            }
        }
    }

    #[test]
    fn it_repeats() {
        for step in 0..STEPS {
            let turn = step + 7 * STEPS;
            assert_eq!(
                led_on(State::Held, false, step),
                led_on(State::Held, false, turn)
            );
        }
    }
}
