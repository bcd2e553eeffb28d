//! Recordings that are replayed.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::recorded::recorded;
use leg_recording::replay;
use mcap::records::MessageHeader;
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
