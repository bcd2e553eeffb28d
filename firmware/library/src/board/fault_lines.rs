//! The lines by which drivers and the emergency stop switch the outputs off.

/// What a board reads of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultLines {
    /// Whether each driver raises its own line now.
    pub drivers: [bool; 3],
    /// Whether the emergency stop is pressed now.
    pub stop: bool,
    /// Whether the drivers' common line has switched the outputs off since it was last read, however briefly.
    pub driver_break: bool,
    /// Whether the emergency stop has.
    pub stop_break: bool,
    /// Whether the outputs are off although they should be on.
    pub lost: bool,
}

/// What is reported of them to the leg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineFaults {
    /// Of each driver; of all where it is not known which.
    pub drivers: [bool; 3],
    /// Emergency stop.
    pub stop: bool,
}

impl FaultLines {
    /// What is reported to the leg: a break that is over is reported once, an outage without a break counts as the drivers'.
    #[must_use]
    #[inline(always)]
    pub fn faults(&self) -> LineFaults {
        let stop = self.stop || self.stop_break;
        let known = self.drivers[0] || self.drivers[1] || self.drivers[2];
        let unknown = !known && (self.driver_break || (self.lost && !stop));
        LineFaults {
            drivers: self.drivers.map(|raised| raised || unknown),
            stop,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{FaultLines, LineFaults};

    const QUIET: FaultLines = FaultLines {
        drivers: [false; 3],
        stop: false,
        driver_break: false,
        stop_break: false,
        lost: false,
    };

    fn faults(drivers: [bool; 3], stop: bool) -> LineFaults {
        LineFaults { drivers, stop }
    }

    #[test]
    fn quiet_lines_report_nothing() {
        assert_eq!(QUIET.faults(), LineFaults::default());
    }

    #[test]
    fn a_line_names_its_driver() {
        let lines = FaultLines {
            drivers: [false, true, false],
            driver_break: true,
            lost: true,
            ..QUIET
        };
        assert_eq!(lines.faults(), faults([false, true, false], false));
    }

    #[test]
    fn a_break_that_is_over_is_reported() {
        let driver = FaultLines {
            driver_break: true,
            ..QUIET
        };
        assert_eq!(driver.faults(), faults([true; 3], false));
        let stop = FaultLines {
            stop_break: true,
            lost: true,
            ..QUIET
        };
        assert_eq!(stop.faults(), faults([false; 3], true));
    }

    #[test]
    fn an_outage_without_a_break_is_a_fault_of_the_drivers() {
        let lines = FaultLines {
            lost: true,
            ..QUIET
        };
        assert_eq!(lines.faults(), faults([true; 3], false));
    }

    #[test]
    fn a_pressed_stop_is_reported_while_it_is_pressed() {
        let lines = FaultLines {
            stop: true,
            ..QUIET
        };
        assert_eq!(lines.faults(), faults([false; 3], true));
    }
}
