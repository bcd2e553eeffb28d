//! A leg that follows commands on sensors that stand still: those of a leg at rest, its load cells' noise aside.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::control::CYCLE_TICKS;
use leg_firmware::leg::{CommandOutcome, Leg};
use leg_firmware::sensors::{CODE_MAX, Sensors};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Tick};
use std::path::Path;

/// The leg, and what its sensors read.
pub struct StillLeg {
    pub leg: Leg<f32>,
    pub sensors: Sensors,
    /// Codes of the current that a whole duty drives through a motor that stands.
    codes_per_duty: f32,
}

impl StillLeg {
    /// At 10° and 70 N, just armed.
    pub fn armed() -> Self {
        Self::armed_with(|_| ())
    }

    /// The same with other settings than those that fit it.
    pub fn armed_with(change: impl Fn(&mut Settings)) -> Self {
        let text = "title = \"still\"\nseed = 1\nsteps = [{ wait_s = 0.01 }]\n\n[start.held]\nazimuth_deg = 0\ntilt_deg = 10\npretension_n = 70\npayload_kg = 0\n";
        let rig = RigFile::load(Some(Path::new("table1"))).unwrap();
        let scenario = Scenario::parse("still", text).unwrap();
        let simulation = Simulation::new(&scenario, &rig).unwrap();
        let mut settings = simulation.settings().clone();
        change(&mut settings);
        let leg = Leg::new(&settings).unwrap();
        let mut read = Vec::new();
        let watch = &mut |tick: &Tick<'_>| read.push(*tick.sensors);
        simulation.run(&mut InProcess::new(), watch).unwrap();
        let sensors = *read.last().unwrap();
        let (servo, axis) = (&settings.servos[0], &settings.axes[0]);
        let mut still = Self {
            leg,
            sensors,
            codes_per_duty: 24.0 / servo.resistance_ohm / axis.current_a_per_code,
        };
        for sensors in &read {
            still.leg.tick(sensors);
        }
        assert_eq!(still.obey(Command::Arm), Ok(()));
        assert_eq!(still.leg.state(), State::Active);
        still
    }

    /// With a host that keeps alive.
    pub fn run(&mut self, ticks: u16) {
        for _ in 0..ticks / 400 {
            self.run_silent(400);
            assert!(self.leg.command(0, Command::KeepAlive));
        }
        self.run_silent(ticks % 400);
    }

    /// With a host that says nothing.
    pub fn run_silent(&mut self, ticks: u16) {
        for tick in 0..ticks {
            if tick.is_multiple_of(CYCLE_TICKS.into()) {
                // A living cell is never quite still.
                for code in &mut self.sensors.cell_codes {
                    *code ^= 1;
                }
            }
            let duty = self.leg.tick(&self.sensors).duty;
            let middle = f32::from(CODE_MAX) * 0.5;
            self.sensors.current_codes =
                duty.map(|duty| (middle + duty * self.codes_per_duty) as u16);
        }
    }

    /// What becomes of a command, once those before it are done.
    pub fn obey(&mut self, command: Command) -> Result<(), CommandRefusal> {
        assert!(self.leg.command(2, command));
        for _ in 0..4 * CYCLE_TICKS {
            self.run_silent(1);
            if let Some(CommandOutcome { number: 2, result }) = self.leg.outcome() {
                return result;
            }
        }
        panic!("no outcome of {command:?}");
    }
}
