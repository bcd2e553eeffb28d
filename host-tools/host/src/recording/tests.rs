#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{About, RecordingError, Samples, read_samples, record, replay};
use crate::signals::{LegConstants, REPORT_SIGNALS, Report, SIMULATED_SIGNALS};
use leg_base::failure::Failure;
use leg_firmware::drive::Drive;
use leg_firmware::leg::Leg;
use leg_firmware::telemetry::Telemetry;
use leg_recording::read_signals;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::ready_scenarios;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Tick};
use mcap::records::MessageHeader;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Cursor;
use std::path::Path;
use tempfile::TempDir;

/// A short scenario.
fn simulation() -> Simulation {
    let text = ready_scenarios::named("fault_driver_fault").unwrap().text;
    let scenario = Scenario::parse("test", text).unwrap();
    Simulation::new(&scenario, &RigFile::load(None).unwrap()).unwrap()
}

/// Records that scenario; `spoil` may change what a tick gave.
fn record_spoilt(file: &Path, spoil: impl Fn(&mut Drive<f32>, u32)) -> u64 {
    let simulation = simulation();
    let settings = simulation.settings().clone();
    record(file, &About::log("test"), &settings, |recording| {
        let watch = &mut |tick: &Tick<'_>| {
            let mut drive = *tick.drive;
            spoil(&mut drive, tick.telemetry.tick - 1);
            let drive = &drive;
            recording.take_tick(&Tick { drive, ..*tick }).unwrap();
        };
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
fn a_recording_is_reproduced_bit_for_bit_and_a_single_other_bit_is_reported() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    let ticks = record_spoilt(&file, |_, _| ());
    let same = replay(&file).unwrap();
    assert_eq!((u64::from(same.ticks), same.other), (ticks, 0));
    assert_eq!(same.first, None);
    record_spoilt(&file, |drive, tick| {
        if tick == 777 {
            drive.duty[1] = f32::from_bits(drive.duty[1].to_bits() ^ 1);
        }
    });
    let differing = replay(&file).unwrap();
    assert_eq!((differing.other, differing.first.unwrap().tick), (1, 777));
}

#[test]
fn a_table_has_a_row_a_millisecond_and_units_in_its_names() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.csv");
    let ticks = record_spoilt(&file, |_, _| ());
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
    record_spoilt(&file, |_, _| ());
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

/// A recording that is cut anywhere, as by a program that is killed, is replayed as far as it goes.
#[test]
fn a_recording_that_is_cut_is_replayed_up_to_there() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    let ticks = record_spoilt(&file, |_, _| ());
    let bytes = std::fs::read(&file).unwrap();
    let cut = |count: usize| {
        std::fs::write(&file, &bytes[..count]).unwrap();
        replay(&file)
    };
    let mut most = 0;
    for part in 1..40 {
        let count = bytes.len() * part / 40;
        let replayed = cut(count).unwrap();
        assert_eq!((replayed.other, replayed.finished), (0, false), "{count}");
        assert!(replayed.ticks >= most, "{count}");
        most = replayed.ticks;
    }
    assert!(u64::from(most) > ticks / 2, "{most} of {ticks}");
    for count in bytes.len() - 40..bytes.len() {
        let replayed = cut(count).unwrap();
        assert_eq!((replayed.ticks.into(), replayed.finished), (ticks, false));
    }
    assert!(cut(bytes.len()).unwrap().finished);
    // Nothing, or no more than where it begins.
    for count in 0..100 {
        assert!(cut(count).is_err(), "{count}");
    }
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

/// Every number of a simulation comes back from its recording as it was, so that its charts are the same.
#[test]
fn the_samples_of_a_simulation_are_read_as_they_were() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    record_spoilt(&file, |_, _| ());
    let mut written = Vec::new();
    let watch = &mut |tick: &Tick<'_>| written.push((*tick.comparison, *tick.telemetry));
    simulation().run(&mut InProcess::new(), watch).unwrap();
    let Samples::Simulation(read) = read_samples(&file).unwrap().samples else {
        panic!("a simulation is no log");
    };
    let every = leg_sim::simulation::SAMPLE_TICKS as usize;
    assert_eq!(read.len(), written.len().div_ceil(every));
    for (read, written) in read.iter().zip(written.iter().step_by(every)) {
        assert_eq!((read.comparison, read.telemetry), *written);
    }
}

#[test]
fn what_a_recording_is_of_is_in_its_metadata() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    record_spoilt(&file, |_, _| ());
    let bytes = std::fs::read(&file).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let [index] = &summary.metadata_indexes[..] else {
        panic!("{:?}", summary.metadata_indexes);
    };
    let metadata = mcap::read::metadata(&bytes, index).unwrap();
    assert_eq!(
        (&*metadata.name, &*metadata.metadata["title"]),
        ("leg", "test")
    );
    assert!(metadata.metadata["settings"].contains("f_max_n = 150"));
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
            begin_wall_time_s,
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

#[test]
fn a_recording_of_other_sources_is_refused_by_name() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    let mut writer = mcap::Writer::new(File::create(&file).unwrap()).unwrap();
    let metadata = BTreeMap::from([("schema".into(), "abababababababab".into())]);
    let header = MessageHeader {
        channel_id: writer
            .add_channel(0, "/settings", "postcard", &metadata)
            .unwrap(),
        sequence: 0,
        log_time: 0,
        publish_time: 0,
    };
    writer.write_to_known_channel(&header, &[0]).unwrap();
    writer.finish().unwrap();
    let text = replay(&file).unwrap_err().to_string();
    let expected = "was recorded by other sources (schema abababababababab, this program ";
    assert!(text.contains(expected), "{text}");
}

/// Every number of a simulation as a player has it, to the digits of an f32; cut anywhere, as far as it goes.
#[test]
fn every_signal_is_read_by_its_name_as_far_as_it_goes() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    record_spoilt(&file, |_, _| ());
    let bytes = std::fs::read(&file).unwrap();
    let whole = read_signals("leg.mcap", &bytes).unwrap();
    assert!(whole.finished && whole.simulated);
    assert!(whole.rig.unwrap().contains("f_max_n = 150"));
    let constants = LegConstants::new(simulation().settings());
    let mut written = Vec::new();
    let watch = &mut |tick: &Tick<'_>| {
        let (report, simulated) = super::simulation(&constants, tick);
        let mut numbers = Vec::new();
        for signal in REPORT_SIGNALS {
            signal.numbers(&report, &mut numbers);
        }
        for signal in SIMULATED_SIGNALS {
            signal.numbers(&simulated, &mut numbers);
        }
        let bits = numbers.iter().map(|number| (*number as f32).to_bits());
        written.push((*tick.telemetry, bits.collect::<Vec<_>>()));
    };
    simulation().run(&mut InProcess::new(), watch).unwrap();
    let every = leg_sim::simulation::SAMPLE_TICKS as usize;
    let written: Vec<_> = written.into_iter().step_by(every).collect();
    assert_eq!(whole.rows.len(), written.len());
    for (row, (telemetry, bits)) in whole.rows.iter().zip(&written) {
        assert_eq!(row.telemetry, *telemetry);
        assert_eq!(row.time_s, f64::from(telemetry.tick) / 8000.0);
        assert_eq!(row.numbers.len(), bits.len());
        for (read, bits) in row.numbers.iter().zip(bits) {
            let wrote = f32::from_bits(*bits);
            assert!(
                *read == wrote || read.is_nan() && wrote.is_nan(),
                "{read} {wrote}"
            );
        }
    }
    let mut most = 0;
    for part in 10..40 {
        let cut = read_signals("leg.mcap", &bytes[..bytes.len() * part / 40]).unwrap();
        assert!(!cut.finished && cut.rows.len() >= most);
        most = cut.rows.len();
    }
    assert!(most > written.len() / 2, "{most} of {}", written.len());
}

/// The last message that is whole is read, though the chunk in which it stands is not.
#[test]
fn a_cut_within_a_chunk_loses_no_whole_message() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    let settings = simulation().settings().clone();
    let telemetry = Leg::<f32>::new(&settings).unwrap().telemetry();
    record(&file, &About::log("test"), &settings, |recording| {
        for tick in 0..100 {
            let telemetry = Telemetry { tick, ..telemetry };
            recording.take_telemetry(&telemetry, None, 0)?;
        }
        Ok(())
    })
    .unwrap();
    let bytes = std::fs::read(&file).unwrap();
    let place = |tick: u32| {
        let text = format!("\"tick\":{tick},");
        let found = bytes
            .windows(text.len())
            .position(|part| part == text.as_bytes());
        found.unwrap()
    };
    // In the middle of the message of a tick.
    for tick in [1, 50, 99] {
        let cut = read_signals("leg.mcap", &bytes[..place(tick)]).unwrap();
        assert_eq!(cut.rows.len() as u32, tick);
        assert!(!cut.finished);
    }
}

/// A board that starts anew begins its time again: a player goes on.
#[test]
fn the_time_of_a_player_only_goes_on() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    let settings = simulation().settings().clone();
    let telemetry = Leg::<f32>::new(&settings).unwrap().telemetry();
    record(&file, &About::log("test"), &settings, |recording| {
        for tick in [8000, 16_000, 800, 1600] {
            let telemetry = Telemetry { tick, ..telemetry };
            recording.take_telemetry(&telemetry, None, 0)?;
        }
        Ok(())
    })
    .unwrap();
    let read = read_signals("leg.mcap", &std::fs::read(&file).unwrap()).unwrap();
    let times: Vec<f64> = read.rows.iter().map(|row| row.time_s).collect();
    assert_eq!(times, [1.0, 2.0, 2.1, 2.2]);
    assert!(!read.simulated);
}

#[test]
fn a_broken_or_foreign_recording_is_refused_with_name_place_and_remedy() {
    let directory = TempDir::new().unwrap();
    let file = directory.path().join("leg.mcap");
    record_spoilt(&file, |_, _| ());
    let good = std::fs::read(&file).unwrap();
    let mut broken = good.clone();
    // One digit of a tension in the middle.
    let name = b"\"tensions_n\":[";
    let places = |from: usize| {
        good[from..]
            .windows(name.len())
            .position(|part| part == name)
    };
    let middle = good.len() / 2;
    broken[middle + places(middle).unwrap() + name.len()] ^= 1;
    let foreign = |topic: &str, text: &[u8]| {
        let mut writer = mcap::Writer::new(Cursor::new(Vec::new())).unwrap();
        let header = MessageHeader {
            channel_id: writer
                .add_channel(0, topic, "json", &BTreeMap::new())
                .unwrap(),
            sequence: 7,
            log_time: 0,
            publish_time: 0,
        };
        writer.write_to_known_channel(&header, text).unwrap();
        writer.finish().unwrap();
        writer.into_inner().into_inner()
    };
    for (bytes, told) in [
        (broken, "messages"),
        (Vec::new(), "is no whole MCAP file"),
        (good[..8].to_vec(), "holds no telemetry"),
        (b"time_s,tick".to_vec(), "is no whole MCAP file"),
        (foreign("/camera", b"{}"), "holds no telemetry"),
        (
            foreign("/leg", b"{}"),
            "message 7 of /leg cannot be read: missing field",
        ),
        (foreign("/leg", b"\0"), "message 7 of /leg cannot be read"),
        (foreign("/recorder", b"{}"), "`leg plot` shows it"),
        (foreign("/simulation", b"{}"), "message 7 of /simulation"),
    ] {
        let failure = read_signals("given.mcap", &bytes).err().unwrap();
        let text = failure.render(false);
        assert!(text.starts_with("error: given.mcap: "), "{text}");
        assert!(
            text.contains(told) && text.contains("help: give a file"),
            "{text}"
        );
    }
}
