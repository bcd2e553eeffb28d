//! From a duty to what a motor's driver gets: a pulse width and a direction.

/// What a driver gets until the next tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BridgeOutput {
    /// Pulse width in steps of the timer.
    pub compare: u16,
    /// Whether the motor is to pull in.
    pub forward: bool,
}

/// One motor's bridge.
///
/// A direction pin changes at once, a pulse width at the timer's next update. So a change of direction waits until no
/// pulse is on its way: the tick that asks for it gives none, and the one after it turns the pin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bridge {
    last: BridgeOutput,
}

impl Bridge {
    /// A bridge without a pulse.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            last: BridgeOutput {
                compare: 0,
                forward: false,
            },
        }
    }

    /// What the driver gets for a duty of −1 to 1, where the timer counts to `top`.
    ///
    /// A duty beyond that range counts as its nearer end, one that is not a number as 0.
    #[inline(always)]
    pub fn convert(&mut self, duty: f32, top: u16) -> BridgeOutput {
        let compare = compare(duty.abs(), top);
        let forward = duty > 0.0;
        let turns = compare > 0 && forward != self.last.forward;
        self.last = match (turns, self.last.compare) {
            (false, _) => BridgeOutput {
                compare,
                ..self.last
            },
            (true, 0) => BridgeOutput { compare, forward },
            (true, _) => BridgeOutput {
                compare: 0,
                ..self.last
            },
        };
        self.last
    }

    /// No pulse.
    #[inline(always)]
    pub fn rest(&mut self) -> BridgeOutput {
        self.last.compare = 0;
        self.last
    }
}

#[inline(always)]
fn compare(magnitude: f32, top: u16) -> u16 {
    if magnitude <= 1.0 {
        (magnitude * f32::from(top) + 0.5) as u16
    } else if magnitude > 1.0 {
        top
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::{Bridge, BridgeOutput};

    const TOP: u16 = 2000;

    /// What the last of several duties gives.
    fn last(duties: &[f32]) -> BridgeOutput {
        let mut bridge = Bridge::new();
        let mut half = BridgeOutput::default();
        for &duty in duties {
            half = bridge.convert(duty, TOP);
        }
        half
    }

    fn half(compare: u16, forward: bool) -> BridgeOutput {
        BridgeOutput { compare, forward }
    }

    #[test]
    fn the_width_is_the_magnitude() {
        assert_eq!(last(&[0.25]), half(500, true));
        assert_eq!(last(&[-0.25]), half(500, false));
        assert_eq!(last(&[0.000_26]), half(1, true), "rounded to the nearest");
        assert_eq!(last(&[0.000_24]), half(0, false));
        assert_eq!(last(&[1.0]), half(TOP, true));
    }

    #[test]
    fn what_is_no_duty_is_bounded() {
        assert_eq!(last(&[1.5]), half(TOP, true));
        assert_eq!(last(&[f32::INFINITY]), half(TOP, true));
        assert_eq!(last(&[f32::NEG_INFINITY]), half(TOP, false));
        assert_eq!(last(&[f32::NAN]).compare, 0);
        assert_eq!(last(&[0.5, f32::NAN]).compare, 0);
    }

    #[test]
    fn the_direction_turns_only_without_a_pulse() {
        assert_eq!(last(&[0.5, -0.5]), half(0, true));
        assert_eq!(last(&[0.5, -0.5, -0.5]), half(1000, false));
        assert_eq!(last(&[0.5, 0.0, -0.5]), half(1000, false));
        assert_eq!(last(&[0.5, -0.5, 0.5]), half(1000, true));
    }

    #[test]
    fn no_tick_has_both_a_pulse_under_way_and_a_turn() {
        let mut bridge = Bridge::new();
        let mut before = BridgeOutput::default();
        for step in 0..10_000_u32 {
            let duty = (f64::from(step) * 0.37).sin() as f32;
            let now = bridge.convert(duty, TOP);
            assert!(now.forward == before.forward || before.compare == 0);
            assert!(now.compare == 0 || now.forward == (duty > 0.0));
            before = now;
        }
    }

    #[test]
    fn a_bridge_at_rest_may_turn_at_once() {
        let mut bridge = Bridge::new();
        bridge.convert(0.5, TOP);
        assert_eq!(bridge.rest(), half(0, true));
        assert_eq!(bridge.convert(-0.5, TOP), half(1000, false));
    }
}
