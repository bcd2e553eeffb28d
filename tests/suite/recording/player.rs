//! Recordings as a player reads them: every signal by its name.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::recorded::{logged, recorded, simulation};
use leg_recording::{SignalReader, read_signals};
use leg_sim::link::InProcess;
use leg_sim::signals::{LegConstants, REPORT_SIGNALS, SIMULATED_SIGNALS};
use leg_sim::simulation::{SAMPLE_TICKS, Tick};
use mcap::records::MessageHeader;
use std::collections::BTreeMap;
use std::io::Cursor;

/// Every number of a simulation as a player has it, to the digits of an f32; cut anywhere, as far as it goes.
#[test]
fn every_signal_is_read_by_its_name_as_far_as_it_goes() {
    let (bytes, _) = recorded(|_, _| ());
    let whole = read_signals("leg.mcap", &bytes).unwrap();
    assert!(whole.finished && whole.simulated);
    assert!(whole.rig.unwrap().contains("f_max_n = 150"));
    let constants = LegConstants::new(simulation().settings());
    let mut written = Vec::new();
    let watch = &mut |tick: &Tick<'_>| {
        let (report, simulated) = tick.signals(&constants);
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
    let every = SAMPLE_TICKS as usize;
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

/// In parts as in one: so many messages at a time, and the result once.
#[test]
fn a_recording_is_read_in_parts() {
    let bytes = logged(0..100);
    let whole = read_signals("leg.mcap", &bytes).unwrap();
    let mut reader = SignalReader::new("leg.mcap".into(), bytes);
    let mut parts = 0;
    let read = loop {
        assert_eq!(reader.messages(), 10 * parts);
        match reader.read_on(10) {
            Some(read) => break read.unwrap(),
            None => parts += 1,
        }
    };
    assert_eq!(parts, 10);
    assert_eq!(read.rows.len(), whole.rows.len());
    assert!(reader.read_on(10).is_none());
}

/// The last message that is whole is read, though the chunk in which it stands is not.
#[test]
fn a_cut_within_a_chunk_loses_no_whole_message() {
    let bytes = logged(0..100);
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
    let bytes = logged([8000, 16_000, 800, 1600]);
    let read = read_signals("leg.mcap", &bytes).unwrap();
    let times: Vec<f64> = read.rows.iter().map(|row| row.time_s).collect();
    assert_eq!(times, [1.0, 2.0, 2.1, 2.2]);
    assert!(!read.simulated);
}

#[test]
fn a_broken_or_foreign_recording_is_refused_with_name_place_and_remedy() {
    let (good, _) = recorded(|_, _| ());
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
