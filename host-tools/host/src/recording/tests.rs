#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Recorder, around, replay};
use leg_base::failure::Failure;
use leg_rig::rig_file::RigFile;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{InThisProcess, Simulation, Tick};
use std::path::Path;

/// Records a short scenario; `spoil` may change what a tick gave.
fn record(file: &Path, spoil: impl Fn(&mut leg_firmware::drive::Drive<f32>, u32)) -> u64 {
    let text = ready_scenarios::named("fault_driver_fault").unwrap().text;
    let scenario = Scenario::parse("test", text).unwrap();
    let rig = RigFile::load(None).unwrap();
    let simulation = Simulation::new(&scenario, &rig).unwrap();
    let settings = simulation.settings().clone();
    around(file, &settings, |recorder: &mut Recorder| {
        let watch = &mut |tick: &Tick<'_>| {
            let mut drive = *tick.drive;
            spoil(&mut drive, tick.telemetry.tick - 1);
            let tick = Tick {
                drive: &drive,
                ..*tick
            };
            recorder.take(&tick).unwrap();
        };
        let summary = simulation.run(&mut InThisProcess::default(), watch);
        Ok(summary.unwrap().ticks)
    })
    .unwrap()
}

#[test]
fn a_recording_is_reproduced_bit_for_bit() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("leg.mcap");
    let ticks = record(&file, |_, _| ());
    let replay = replay(&file).unwrap();
    assert_eq!((u64::from(replay.ticks), replay.other), (ticks, 0));
    assert_eq!(replay.first, None);
}

#[test]
fn a_single_other_bit_is_told_with_its_tick() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("leg.mcap");
    record(&file, |drive, tick| {
        if tick == 777 {
            drive.duty[1] = f32::from_bits(drive.duty[1].to_bits() ^ 1);
        }
    });
    let replay = replay(&file).unwrap();
    assert_eq!((replay.other, replay.first.unwrap().tick), (1, 777));
}

#[test]
fn a_table_has_a_row_a_millisecond_and_units_in_its_names() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("leg.csv");
    let ticks = record(&file, |_, _| ());
    let mut reader = csv::Reader::from_path(&file).unwrap();
    let names = reader.headers().unwrap().clone();
    for name in ["time_s", "tensions_n_1", "pulled_m_3", "state", "duty_2"] {
        assert!(names.iter().any(|found| found == name), "{name}: {names:?}");
    }
    assert_eq!(reader.records().count() as u64, ticks.div_ceil(8));
}

#[test]
fn work_that_fails_leaves_no_recording() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("leg.mcap");
    let rig = RigFile::load(None).unwrap();
    let text = ready_scenarios::named("fig9").unwrap().text;
    let scenario = Scenario::parse("test", text).unwrap();
    let settings = Simulation::new(&scenario, &rig).unwrap().settings().clone();
    let failure = Failure::missed("no", "");
    let failed = around(&file, &settings, |_| Err::<(), _>(failure.clone()));
    assert_eq!(failed, Err(failure));
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 0);
    assert!(replay(&file).is_err());
}

#[test]
fn telemetry_alone_is_recorded_with_the_legs_time() {
    let directory = tempfile::tempdir().unwrap();
    let mut told = Vec::new();
    let text = ready_scenarios::named("fault_driver_fault").unwrap().text;
    let scenario = Scenario::parse("test", text).unwrap();
    let rig = RigFile::load(None).unwrap();
    let simulation = Simulation::new(&scenario, &rig).unwrap();
    let watch = &mut |tick: &Tick<'_>| told.push(*tick.telemetry);
    simulation
        .run(&mut InThisProcess::default(), watch)
        .unwrap();
    for name in ["leg.mcap", "leg.csv"] {
        let file = directory.path().join(name);
        super::around_telemetry(&file, |recorder| {
            for telemetry in &told {
                recorder.take(telemetry).unwrap();
            }
            Ok(())
        })
        .unwrap();
    }
    let bytes = std::fs::read(directory.path().join("leg.mcap")).unwrap();
    let messages: Vec<_> = mcap::MessageStream::new(&bytes)
        .unwrap()
        .map(Result::unwrap)
        .collect();
    assert_eq!(messages.len(), told.len());
    let last = messages.last().unwrap();
    assert_eq!(last.channel.topic, "/leg");
    let tick = told.last().unwrap().tick;
    assert_eq!(last.log_time, u64::from(tick) * 125_000);
    let value: serde_json::Value = serde_json::from_slice(&last.data).unwrap();
    assert_eq!(value["tick"], tick);
    let mut rows = csv::Reader::from_path(directory.path().join("leg.csv")).unwrap();
    assert!(
        rows.headers()
            .unwrap()
            .iter()
            .any(|name| name == "tensions_n_2")
    );
    assert_eq!(rows.records().count(), told.len());
}
