#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::SensingLeg;
use crate::command::{Command, CommandRefusal};
use crate::control::CYCLE_TICKS;
use crate::host_link::HostRefusal;
use crate::leg::CommandOutcome;
use crate::sensors::{CODE_MAX, Sensors};
use crate::settings::Settings;
use crate::supervisor::{Fault, FaultSet, State};

/// Ticks in which a leg boots, and every fault of an axis that is not timed has shown.
const SOME_TICKS: u32 = 40;

/// A leg whose sensors read what they read on a leg at rest without tension, but for what a test changes.
struct Bench {
    leg: SensingLeg<f32>,
    sensors: Sensors,
}

impl Bench {
    fn new() -> Self {
        let settings = Settings::table_1().unwrap();
        let mut bench = Self {
            leg: SensingLeg::new(&settings).unwrap(),
            sensors: Sensors::resting(&settings),
        };
        bench.run(SOME_TICKS);
        assert_eq!(bench.leg.telemetry().state, State::Disarmed);
        bench
    }

    fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.leg.tick(&self.sensors);
        }
    }

    fn obey(&mut self, command: Command) -> Result<(), CommandRefusal> {
        assert!(self.leg.command(7, command));
        for _ in 0..2 * CYCLE_TICKS {
            self.run(1);
            if let Some(outcome) = self.leg.outcome() {
                return outcome.result;
            }
        }
        panic!("a command is executed within two cycles");
    }

    fn restart(&mut self) -> Result<(), HostRefusal> {
        self.leg.restart(&Settings::table_1().unwrap())
    }
}

#[test]
fn a_fault_outlives_new_settings() {
    let mut bench = Bench::new();
    bench.sensors.driver_fault[1] = true;
    bench.run(1);
    bench.sensors.driver_fault[1] = false;
    assert_eq!(bench.leg.telemetry().state, State::Off);
    bench.restart().unwrap();
    bench.run(SOME_TICKS);
    let telemetry = bench.leg.telemetry();
    assert!(telemetry.faults.has(Fault::DriverFault));
    assert_eq!(telemetry.state, State::Off);
    assert_eq!(bench.obey(Command::Home), Err(CommandRefusal::Faulted));
    assert_eq!(bench.obey(Command::Clear), Ok(()));
    assert_eq!(bench.obey(Command::Home), Ok(()));
    assert_eq!(bench.restart(), Err(HostRefusal::Driven));
}

#[test]
fn what_waits_while_settings_change_is_refused_and_the_ticks_go_on() {
    let mut bench = Bench::new();
    let before = bench.leg.telemetry().tick;
    assert!(bench.leg.command(3, Command::Home));
    bench.restart().unwrap();
    bench.run(SOME_TICKS);
    let refused = CommandOutcome {
        number: 3,
        result: Err(CommandRefusal::Superseded),
    };
    assert_eq!(bench.leg.outcome(), Some(refused));
    let telemetry = bench.leg.telemetry();
    assert_eq!(telemetry.tick, before + SOME_TICKS);
    assert_eq!(telemetry.state, State::Disarmed);
}

/// The axes take turns; a clear between them must not find that all is well.
#[test]
fn no_clear_passes_between_two_looks_at_an_axis() {
    for axis in 0..3 {
        let mut bench = Bench::new();
        let well = bench.sensors.cell_codes[axis];
        bench.sensors.cell_codes[axis] = CODE_MAX;
        bench.run(SOME_TICKS);
        // Not for longer: these sensors have no noise, which a stuck cell shows.
        for _ in 0..4 {
            assert_eq!(bench.obey(Command::Clear), Err(CommandRefusal::Faulted));
        }
        bench.sensors.cell_codes[axis] = well;
        bench.run(SOME_TICKS);
        assert_eq!(bench.obey(Command::Clear), Ok(()));
    }
}

/// A driver that is off may report any current.
#[test]
fn the_current_of_a_driver_that_is_off_is_no_fault() {
    for axis in 0..3 {
        let mut bench = Bench::new();
        bench.sensors.current_codes[axis] = CODE_MAX;
        bench.run(SOME_TICKS);
        assert_eq!(bench.leg.telemetry().faults, FaultSet::NONE);
        assert_eq!(bench.obey(Command::Home), Ok(()));
        bench.run(SOME_TICKS);
        let telemetry = bench.leg.telemetry();
        assert!(telemetry.faults.has(Fault::OverCurrent));
        assert_eq!(telemetry.state, State::Off);
    }
}

#[test]
fn a_direction_that_is_none_is_refused() {
    let mut bench = Bench::new();
    let stiffness = |towards| Command::Stiffness {
        demand_nm_per_rad: 100.0,
        towards: Some(towards),
    };
    for none in [
        [0.0, 0.0],
        [1e-30, 0.0],
        [1e30, 0.0],
        [0.9, 0.0],
        [f32::NAN, 1.0],
    ] {
        let outcome = bench.obey(stiffness(none));
        assert_eq!(outcome, Err(CommandRefusal::Number), "{none:?}");
    }
    assert_eq!(bench.obey(stiffness([0.6, -0.8])), Ok(()));
}
