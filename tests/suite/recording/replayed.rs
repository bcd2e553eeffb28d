//! Recordings that are replayed.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::recorded::{ready_simulation, recorded, recorded_run};
use leg_firmware::settings::Settings;
use leg_recording::replay;
use mcap::records::MessageHeader;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::Cursor;

#[test]
fn a_recording_is_reproduced_bit_for_bit_and_a_single_other_bit_is_reported() {
    let (bytes, ticks) = recorded(|_, _| ());
    let same = replay("leg.mcap", &bytes).unwrap();
    assert_eq!((u64::from(same.ticks), same.other), (ticks, 0));
    assert_eq!(same.first, None);
    let (bytes, _) = recorded(|drive, tick| {
        if tick == 777 {
            drive.duty[1] = f32::from_bits(drive.duty[1].to_bits() ^ 1);
        }
    });
    let differing = replay("leg.mcap", &bytes).unwrap();
    assert_eq!((differing.other, differing.first.unwrap().tick), (1, 777));
}

/// Whatever a leg does: it homes, stands, follows a stream, and one that ends too soon; keeps station, jogs, changes its stiffness, is stopped by
/// a swing, an encoder, a tension and bytes that mean nothing.
const SCENARIOS: [&str; 12] = [
    "homing",
    "tour",
    "circle",
    "fault_point_missing",
    "station",
    "fault_off_station",
    "jog",
    "stiffness",
    "fault_swings",
    "fault_encoder_jump",
    "fault_over_tension",
    "fault_bad_frame",
];

#[test]
fn every_kind_of_run_is_reproduced_bit_for_bit() {
    for name in SCENARIOS {
        let (bytes, ticks) = recorded_run(ready_simulation(name), |_, _| ());
        let same = replay(name, &bytes).unwrap();
        println!("{name}: {ticks} ticks, {} bytes", bytes.len());
        assert!(same.finished, "{name}");
        assert_eq!((u64::from(same.ticks), same.other), (ticks, 0), "{name}");
        let at = (ticks / 2) as u32;
        let (bytes, _) = recorded_run(ready_simulation(name), |drive, tick| {
            if tick == at {
                drive.duty[2] = f32::from_bits(drive.duty[2].to_bits() ^ 1);
            }
        });
        let differing = replay(name, &bytes).unwrap();
        let first = differing.first.unwrap();
        assert_eq!((differing.other, first.tick), (1, at), "{name}");
    }
}

/// The settings are JSON, which gives the same bits again; earlier versions wrote them in postcard's format.
#[test]
fn settings_are_json_and_those_of_earlier_recordings_are_read() {
    let (bytes, ticks) = recorded(|_, _| ());
    let messages: Vec<_> = mcap::MessageStream::new(&bytes).unwrap().collect();
    let first = messages[0].as_ref().unwrap();
    assert_eq!(
        (&*first.channel.topic, &*first.channel.message_encoding),
        ("/settings", "json")
    );
    let settings: Settings = serde_json::from_slice(&first.data).unwrap();
    let schema: Value =
        serde_json::from_slice(&first.channel.schema.as_ref().unwrap().data).unwrap();
    assert_eq!(
        schema["properties"]["motion"]["properties"]["speed_rad_per_s"]["type"],
        "number"
    );

    let mut writer = mcap::Writer::new(Cursor::new(Vec::new())).unwrap();
    for message in messages {
        let message = message.unwrap();
        let channel = &message.channel;
        let earlier = channel.topic == "/settings";
        let [encoding, content] = if earlier {
            let exact = postcard::to_slice(&settings, &mut [0; 2048])
                .unwrap()
                .to_vec();
            [b"postcard".to_vec(), exact]
        } else {
            [
                channel.message_encoding.clone().into_bytes(),
                message.data.to_vec(),
            ]
        };
        let encoding = String::from_utf8(encoding).unwrap();
        let id = writer.add_channel(0, &channel.topic, &encoding, &channel.metadata);
        let header = MessageHeader {
            channel_id: id.unwrap(),
            sequence: message.sequence,
            log_time: message.log_time,
            publish_time: message.publish_time,
        };
        writer.write_to_known_channel(&header, &content).unwrap();
    }
    writer.finish().unwrap();
    let replayed = replay("leg.mcap", &writer.into_inner().into_inner()).unwrap();
    assert_eq!((u64::from(replayed.ticks), replayed.other), (ticks, 0));
    assert!(replayed.finished);
}

/// A recording that is cut anywhere, as by a program that is killed, is replayed as far as it goes.
#[test]
fn a_recording_that_is_cut_is_replayed_up_to_there() {
    let (bytes, ticks) = recorded(|_, _| ());
    let cut = |count: usize| replay("leg.mcap", &bytes[..count]);
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
fn a_recording_of_other_sources_is_refused_by_name() {
    let mut writer = mcap::Writer::new(Cursor::new(Vec::new())).unwrap();
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
    let bytes = writer.into_inner().into_inner();
    let text = replay("leg.mcap", &bytes).unwrap_err().to_string();
    let expected = "was recorded by other sources (schema abababababababab, this program ";
    assert!(text.contains(expected), "{text}");
}
