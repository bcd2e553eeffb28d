//! When a board's outputs may be on.

/// What to do with the outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GateAction {
    /// Switch them on.
    Open,
    /// They stay on.
    Keep,
    /// Switch them off, or leave them off.
    Close,
}

/// Keeps outputs off that something else than the leg has switched off, until the leg itself disables them.
///
/// A break by hardware lasts as long as its cause; the leg's fault lasts until it is cleared. Between the two nothing
/// may come on again: outputs are switched on only where the drive becomes enabled, and it does so only after a clear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gate {
    /// Off: the leg does not drive.
    #[default]
    Closed,
    /// On.
    Open,
    /// Off although the leg drives.
    Lost,
}

impl Gate {
    /// One tick: what the leg asks for, and whether the outputs are on in fact.
    #[inline(always)]
    pub fn step(&mut self, enabled: bool, on: bool) -> GateAction {
        let (gate, turn) = match (*self, enabled) {
            (_, false) => (Self::Closed, GateAction::Close),
            (Self::Closed, true) => (Self::Open, GateAction::Open),
            (Self::Open, true) if on => (Self::Open, GateAction::Keep),
            (Self::Open | Self::Lost, true) => (Self::Lost, GateAction::Close),
        };
        *self = gate;
        turn
    }

    /// The outputs are switched off from outside of a tick.
    #[inline(always)]
    pub fn cut(&mut self) {
        *self = Self::Lost;
    }

    /// Whether the outputs are off, or turn out to be, although the leg drives.
    #[must_use]
    #[inline(always)]
    pub fn lost(self, on: bool) -> bool {
        self == Self::Lost || (self == Self::Open && !on)
    }
}

#[cfg(test)]
mod tests {
    use super::{Gate, GateAction};

    #[test]
    fn it_opens_where_the_drive_becomes_enabled() {
        let mut gate = Gate::default();
        assert_eq!(gate.step(false, false), GateAction::Close);
        assert_eq!(gate.step(true, false), GateAction::Open);
        assert_eq!(gate.step(true, true), GateAction::Keep);
        assert_eq!(gate.step(false, true), GateAction::Close);
        assert_eq!(gate.step(true, false), GateAction::Open);
    }

    #[test]
    fn what_broke_stays_off_until_the_drive_lets_go() {
        let mut gate = Gate::default();
        gate.step(true, false);
        assert!(gate.lost(false));
        assert_eq!(gate.step(true, false), GateAction::Close);
        assert_eq!(
            gate.step(true, true),
            GateAction::Close,
            "whatever the outputs do"
        );
        assert!(gate.lost(true));
        assert_eq!(gate.step(false, false), GateAction::Close);
        assert!(!gate.lost(false));
        assert_eq!(gate.step(true, false), GateAction::Open);
    }

    #[test]
    fn a_cut_counts_as_a_break() {
        for enabled in [false, true] {
            let mut gate = Gate::default();
            gate.step(enabled, false);
            gate.cut();
            assert_eq!(gate.step(true, true), GateAction::Close);
            assert_eq!(gate.step(false, false), GateAction::Close);
            assert_eq!(gate.step(true, false), GateAction::Open);
        }
    }
}
