#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{About, RecordingError, Samples, read_samples, record, replay};
use crate::signals::{LegConstants, Report};
use leg_base::failure::Failure;
use leg_firmware::leg::Leg;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Tick};
use std::fs::File;
use std::path::Path;
use tempfile::TempDir;

/// A short scenario.
fn simulation() -> Simulation {
    let text = ready_scenarios::named("fault_driver_fault").unwrap().text;
    let scenario = Scenario::parse("test", text).unwrap();
    Simulation::new(&scenario, &RigFile::load(None).unwrap()).unwrap()
}

/// Records that scenario; gives the number of its ticks.
fn record_simulation(file: &Path) -> u64 {
    let simulation = simulation();
    let settings = simulation.settings().clone();
    record(file, &About::log("test"), &settings, |recording| {
        let watch = &mut |tick: &Tick<'_>| recording.take_tick(tick).unwrap();
        let summary = simulation.run(&mut InProcess::new(), watch);
        Ok(summary.unwrap().ticks)
    })
    .unwrap()
}

/// The rows of a table, which has these columns.
fn rows(file: &Path, names: &[&str]) -> u64 {
    let mut reader = csv::Reader::from_path(file).unwrap();
    let found = reader.headers().unwrap().clone();
    for name in names {
        assert!(
            found.iter().any(|found| found == *name),
            "{name}: {found:?}"
        );
    }
    reader.records().count() as u64
}

#[test]
fn a_table_has_a_row_a_millisecond_and_units_in_its_names() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.csv");
    let ticks = record_simulation(&file);
    let names = [
        "time_s",
        "faults",
        "tilt_deg",
        "motor_currents_true_a_2",
        "supply_true_v",
        "tensions_n_1",
        "pulled_m_3",
        "state",
        "duties_2",
        "tip_commanded_mm_1",
        "tip_reference_mm_2",
        "tip_estimated_mm_3",
        "tip_true_mm_1",
        "tensions_true_n_2",
        "payload_true_kg",
    ];
    assert_eq!(rows(&file, &names), ticks.div_ceil(8));
}

#[test]
fn the_true_leg_stands_beside_what_it_reports() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    record_simulation(&file);
    let bytes = std::fs::read(file).unwrap();
    let messages = mcap::MessageStream::new(&bytes)
        .unwrap()
        .map(Result::unwrap);
    let (mut reports, mut simulated) = (Vec::new(), Vec::new());
    for message in messages {
        match &*message.channel.topic {
            "/leg" => reports.push(message.data.into_owned()),
            "/simulation" => simulated.push(message.data.into_owned()),
            _ => {}
        }
    }
    assert_eq!(simulated.len(), reports.len());
    let last = |of: &[Vec<u8>]| -> serde_json::Value {
        serde_json::from_slice(of.last().unwrap()).unwrap()
    };
    let [report, truth] = [last(&reports), last(&simulated)];
    let depth = |of: &serde_json::Value, tip: &str| of[tip][2].as_f64().unwrap();
    let true_mm = depth(&truth, "tip_true_mm");
    assert!(true_mm < -200.0, "{truth}");
    assert!(
        (true_mm - depth(&report, "tip_reference_mm")).abs() < 5.0,
        "{report}"
    );
}

#[test]
fn work_that_fails_leaves_no_recording() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    let failure = Failure::failed("no", "");
    let settings = simulation().settings().clone();
    let failed = record(&file, &About::log("test"), &settings, |_| {
        Err::<(), _>(failure.clone().into())
    });
    assert_eq!(failed, Err(failure));
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 0);
    assert!(replay(&file).is_err());
}

#[test]
fn a_recording_is_beside_its_name_until_it_is_whole_and_is_never_overwritten() {
    let directory = TempDir::new().unwrap();
    let place = |name: &str| directory.path().join(name);
    let file = place("leg.mcap");
    std::fs::write(&file, "old").unwrap();
    std::fs::write(place("leg.part.mcap"), "of a program that was killed").unwrap();
    let settings = simulation().settings().clone();
    record(&file, &About::log("test"), &settings, |recording| {
        let mut ticks = 0;
        let watch = &mut |tick: &Tick<'_>| {
            recording.take_tick(tick).unwrap();
            ticks += 1;
        };
        simulation().run(&mut InProcess::new(), watch).unwrap();
        // What is on the disk now is what there would be if the program were killed.
        let replayed = replay(&place("leg.part2.mcap"))?;
        let missing = ticks - replayed.ticks;
        assert!(!replayed.finished && missing <= 8000, "{missing}");
        // Other programs find a whole file.
        let bytes = std::fs::read(place("leg.part2.mcap")).unwrap();
        let messages = mcap::MessageStream::new(&bytes).unwrap();
        let read = messages
            .map(Result::unwrap)
            .filter(|message| message.channel.topic == "/ticks");
        assert_eq!(read.count(), replayed.ticks as usize);
        assert_eq!(std::fs::read(&file).unwrap(), b"old");
        Ok(())
    })
    .unwrap();
    assert!(replay(&file).unwrap().finished);
    assert!(!place("leg.part2.mcap").exists());
    let other = std::fs::read(super::unfinished(&file).unwrap()).unwrap();
    assert_eq!(other, b"of a program that was killed");
}

#[test]
fn a_full_disk_is_an_error_and_no_panic() {
    let full = || {
        let full = File::options().write(true).open("/dev/full");
        full.unwrap()
    };
    let settings = simulation().settings().clone();
    let error: RecordingError = super::McapFile::new(full(), &About::log("test"), &settings)
        .err()
        .unwrap();
    let failure = error.failure(Path::new("leg.mcap"), Some("leg.part.mcap".into()));
    let text = failure.render(false);
    assert!(
        text.starts_with("error: cannot write leg.mcap: No space left on device (os error 28); what was recorded until then is leg.part.mcap")
            && text.ends_with("help: make room on the disk, or write to another one"),
        "{text}"
    );
    let mut table = super::CsvFile::new(full());
    let leg = LegConstants::new(&settings);
    let telemetry = Leg::<f32>::new(&settings).unwrap().telemetry();
    table.write_report(&Report::new(&telemetry, &leg)).unwrap();
    assert!(table.flush().is_err());
}

#[test]
fn telemetry_alone_is_recorded_with_the_legs_time() {
    let directory = TempDir::new().unwrap();
    let mut telemetry = Vec::new();
    let watch = &mut |tick: &Tick<'_>| telemetry.push(*tick.telemetry);
    simulation().run(&mut InProcess::new(), watch).unwrap();
    let [mcap, csv] = ["leg.mcap", "leg.csv"].map(|name| directory.path().join(name));
    let settings = simulation().settings().clone();
    let wall_s = |tick: u32| (tick > 8).then(|| 1.7e9 + f64::from(tick) / 8000.0);
    for file in [&mcap, &csv] {
        record(file, &About::log("test"), &settings, |recording| {
            for telemetry in &telemetry {
                let wall_time_s = wall_s(telemetry.tick);
                recording.take_telemetry(telemetry, wall_time_s, 3).unwrap();
            }
            Ok(())
        })
        .unwrap();
    }
    let error = replay(&mcap).unwrap_err().to_string();
    assert!(error.contains("holds no ticks"), "{error}");
    let Samples::Log(read) = read_samples(&mcap).unwrap().samples else {
        panic!("a log is no simulation");
    };
    assert_eq!(read.len(), telemetry.len());
    for ((time_s, read), written) in read.iter().zip(&telemetry) {
        assert_eq!(read, written);
        assert_eq!(*time_s, f64::from(written.tick) / 8000.0);
    }
    let bytes = std::fs::read(mcap).unwrap();
    let messages: Vec<_> = mcap::MessageStream::new(&bytes)
        .unwrap()
        .map(Result::unwrap)
        .collect();
    let topics: Vec<_> = messages[..3].iter().map(|m| &*m.channel.topic).collect();
    assert_eq!(topics, ["/settings", "/about", "/leg"]);
    assert_eq!(messages.len(), 2 + telemetry.len());
    assert_eq!(messages[1].log_time, messages[2].log_time);
    let (last, tick) = (messages.last().unwrap(), telemetry.last().unwrap().tick);
    let wall_ns = 1_700_000_000_000_000_000 + u64::from(tick) * 125_000;
    assert!(last.log_time.abs_diff(wall_ns) < 1000, "{}", last.log_time);
    let value: serde_json::Value = serde_json::from_slice(&last.data).unwrap();
    assert_eq!(
        (&value["tick"], &value["damaged_frames"]),
        (&tick.into(), &3.into())
    );
    assert_eq!(
        rows(&csv, &["tensions_n_2", "wall_time_s", "state"]),
        telemetry.len() as u64
    );
}

/// The time of the day at which a recording begins is what it says; with the same one the same simulation gives the same messages.
/// The summary lists the channels in any order.
#[test]
fn the_messages_of_a_simulation_have_the_time_of_the_day_at_which_it_begins() {
    let directory = TempDir::new().unwrap();
    let settings = simulation().settings().clone();
    let messages = |name: &str, begin_wall_time_s: f64| {
        let file = directory.path().join(name);
        let about = About {
            begin_wall_time_s: Some(begin_wall_time_s),
            ..About::log("test")
        };
        record(&file, &about, &settings, |recording| {
            let watch = &mut |tick: &Tick<'_>| recording.take_tick(tick).unwrap();
            let summary = simulation().run(&mut InProcess::new(), watch);
            Ok(summary.unwrap())
        })
        .unwrap();
        assert_eq!(read_samples(&file).unwrap().about, about);
        let bytes = std::fs::read(file).unwrap();
        let messages = mcap::MessageStream::new(&bytes).unwrap();
        let parts = messages.map(Result::unwrap).map(|message| {
            let topic = message.channel.topic.clone();
            let data = message.data.into_owned();
            (topic, message.sequence, message.log_time, data)
        });
        parts.collect::<Vec<_>>()
    };
    let begin_s = 1_764_000_000.125;
    let one = messages("one.mcap", begin_s);
    assert!(one == messages("other.mcap", begin_s));
    for (topic, tick, time_ns, _) in &one {
        let expected_ns = 1_764_000_000_125_000_000 + u64::from(*tick) * 125_000;
        assert_eq!(*time_ns, expected_ns, "{topic}");
    }
}
