//! The two break inputs: from the pin through enable, polarity and filter to the request.
//!
//! By the figure "Break and Break2 circuitry overview" of the reference manual: the pin, inverted if `BKINP` says so, is
//! let through by `BKINE`; the comparators, which nothing here drives, would be added; then come filter, polarity `BKP`
//! and `BKE`. An input that is not let through is low, and with `BKP` low that is a break.

use crate::device::{FieldPlace, RegisterFile};
use crate::timer::filter::{self, Filtered};
use crate::timer::timebase::Timebase;

/// A break input.
#[derive(Clone, Debug)]
pub struct BreakInput {
    through: FieldPlace,
    inverted: FieldPlace,
    filter: FieldPlace,
    clock_division: FieldPlace,
    active_high: FieldPlace,
    enabled: FieldPlace,
    /// `BIF`, `B2IF`.
    pub flag: FieldPlace,
    /// `BG`, `B2G`.
    pub generate: FieldPlace,
    pin: bool,
    line: Filtered,
}

impl BreakInput {
    /// The inputs `BKIN` and `BKIN2`, low.
    #[must_use]
    pub fn pair(file: &RegisterFile) -> [Self; 2] {
        [("AF1", "BK", 0), ("AF2", "BK2", 1)].map(|(routing, name, index)| Self {
            through: file.field(routing, &format!("{name}INE")),
            inverted: file.field(routing, &format!("{name}INP")),
            filter: file.field("BDTR", &format!("BKF{index}")),
            clock_division: file.field("CR1", "CKD"),
            active_high: file.field("BDTR", &format!("BKP{index}")),
            enabled: file.field("BDTR", &format!("BKE{index}")),
            flag: file.field("SR", &format!("BIF{index}")),
            generate: file.field("EGR", &format!("BG{index}")),
            pin: false,
            line: Filtered::default(),
        })
    }

    /// The level of the pin that is routed to the input; low if none is.
    pub fn set_pin(&mut self, level: bool) {
        self.pin = level;
    }

    /// Back to no filter; the pin keeps its level.
    pub fn reset(&mut self, file: &RegisterFile) {
        self.line.force(self.source(file));
    }

    /// Takes over what pin and registers say in this cycle.
    pub fn update(&mut self, file: &RegisterFile, time: &Timebase, cycle: u64) {
        let division = file.value(self.clock_division);
        let ticks = filter::ticks(file.value(self.filter), division);
        self.line.set(self.source(file), cycle, time.cycles(ticks));
    }

    /// Whether it asks for a break now.
    #[must_use]
    pub fn is_active(&self, file: &RegisterFile) -> bool {
        file.is_set(self.enabled) && self.line.level() == file.is_set(self.active_high)
    }

    /// The cycle in which a level comes through the filter.
    #[must_use]
    pub fn next_event(&self) -> Option<u64> {
        self.line.next_event()
    }

    fn source(&self, file: &RegisterFile) -> bool {
        file.is_set(self.through) && self.pin != file.is_set(self.inverted)
    }
}
