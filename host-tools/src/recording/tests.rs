#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Recorder, around, replay};
use crate::failure::Failure;
use crate::ready_scenarios;
use crate::rig_file::RigFile;
use crate::scenario::Scenario;
use crate::simulation::{InThisProcess, Simulation, Tick};
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
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("leg.mcap");
    let ticks = record(&file, |_, _| ());
    let replay = replay(&file).unwrap();
    assert_eq!((u64::from(replay.ticks), replay.other), (ticks, 0));
    assert_eq!(replay.first, None);
}

#[test]
fn a_single_other_bit_is_told_with_its_tick() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("leg.mcap");
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
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("leg.csv");
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
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("leg.mcap");
    let rig = RigFile::load(None).unwrap();
    let text = ready_scenarios::named("fig9").unwrap().text;
    let scenario = Scenario::parse("test", text).unwrap();
    let settings = Simulation::new(&scenario, &rig).unwrap().settings().clone();
    let failure = Failure::missed("no", "");
    let failed = around(&file, &settings, |_| Err::<(), _>(failure.clone()));
    assert_eq!(failed, Err(failure));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    assert!(replay(&file).is_err());
}
