//! A simulation and a log, recorded in memory.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::drive::Drive;
use leg_firmware::leg::Leg;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::telemetry::Telemetry;
use leg_recording::{About, McapWriter};
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::signals::{LegConstants, Report};
use leg_sim::simulation::{SAMPLE_TICKS, Simulation, Tick};
use std::io::Cursor;

/// A short scenario.
pub fn simulation() -> Simulation {
    ready_simulation("fault_driver_fault")
}

/// A ready scenario.
pub fn ready_simulation(name: &str) -> Simulation {
    let text = ready_scenarios::named(name).unwrap().text;
    let scenario = Scenario::parse(name, text).unwrap();
    let rig = RigFile::load(Some(scenario.rig.as_ref())).unwrap();
    Simulation::new(&scenario, &rig).unwrap()
}

/// Records the short scenario; `spoil` may change what a tick gave. Gives the file, and the number of its ticks.
pub fn recorded(spoil: impl Fn(&mut Drive<f32>, u32)) -> (Vec<u8>, u64) {
    recorded_run(simulation(), spoil)
}

/// The same of any simulation.
pub fn recorded_run(
    simulation: Simulation,
    spoil: impl Fn(&mut Drive<f32>, u32),
) -> (Vec<u8>, u64) {
    let leg = LegConstants::new(simulation.settings());
    let about = About::log("test");
    let mut file = McapWriter::new(Cursor::new(Vec::new()), &about, simulation.settings()).unwrap();
    let watch = &mut |tick: &Tick<'_>| {
        let number = tick.telemetry.tick - 1;
        let mut drive = *tick.drive;
        spoil(&mut drive, number);
        let drive = &drive;
        file.write_tick(number, &Tick { drive, ..*tick }).unwrap();
        if number.is_multiple_of(SAMPLE_TICKS) {
            file.write_simulation(number, &tick.signals(&leg)).unwrap();
        }
        if number.is_multiple_of(TICK_HZ.into()) {
            file.flush().unwrap();
        }
    };
    let ticks = simulation.run(&mut InProcess::new(), watch).unwrap().ticks;
    (file.finish().unwrap().into_inner(), ticks)
}

/// Records what a leg reports in these of its ticks.
pub fn logged(ticks: impl IntoIterator<Item = u32>) -> Vec<u8> {
    let settings = simulation().settings().clone();
    let leg = LegConstants::new(&settings);
    let telemetry = Leg::<f32>::new(&settings).unwrap().telemetry();
    let about = About::log("test");
    let mut file = McapWriter::new(Cursor::new(Vec::new()), &about, &settings).unwrap();
    for (number, tick) in (0..).zip(ticks) {
        let report = Report::new(&Telemetry { tick, ..telemetry }, &leg);
        let time_ns = u64::from(tick) * (1_000_000_000 / u64::from(TICK_HZ));
        file.write_report(number, time_ns, &report).unwrap();
    }
    file.finish().unwrap().into_inner()
}
