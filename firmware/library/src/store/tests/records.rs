//! What a record holds, and why one is refused.

use super::mock::Mock;
use super::{CorruptReason, Loaded, block_on, large, load, small, store};
use crate::settings::{OutOfRange, Settings, SettingsError};
use crate::store::record::{pack, unpack};
use crate::store::{KEY, RECORD_MAX, SETTINGS_SCHEMA};
use crc::{CRC_32_ISO_HDLC, Crc};

fn packed(settings: &Settings) -> Vec<u8> {
    let mut out = vec![0; RECORD_MAX];
    let Some(length) = pack(settings, &mut out) else {
        panic!("every record fits")
    };
    out.truncate(length);
    out
}

/// The record with other contents and the CRC that belongs to them.
fn changed(settings: &Settings, change: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
    let mut record = packed(settings);
    record.truncate(record.len() - 4);
    change(&mut record);
    let crc = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&record);
    record.extend(crc.to_le_bytes());
    record
}

/// What is loaded where such a record is stored.
fn loaded(record: &[u8]) -> Loaded {
    let mut flash = Mock::new(3);
    let mut store = store(&mut flash);
    let stored = store.map.store_item(&mut store.buffer, &KEY, &record);
    assert_eq!(block_on(stored), Ok(()));
    match load(&mut flash) {
        Ok(loaded) => loaded,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn the_layout_is_fixed() {
    let record = packed(&small(3));
    assert_eq!(record[..8], SETTINGS_SCHEMA);
    let mut data = [0; RECORD_MAX];
    let Ok(data) = postcard::to_slice(&small(3), &mut data) else {
        panic!("settings fit")
    };
    assert_eq!(record[8..record.len() - 4], *data);
    assert_eq!(
        record,
        changed(&small(3), |_| {}),
        "the CRC covers the rest"
    );
    assert_eq!(loaded(&record), Loaded::Settings(small(3)));
}

#[test]
fn every_flipped_bit_is_found() {
    let mut record = packed(&large(3));
    for bit in 0..8 * record.len() {
        record[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(unpack(&record), Err(CorruptReason::Crc), "bit {bit}");
        record[bit / 8] ^= 1 << (bit % 8);
    }
    assert_eq!(unpack(&record), Ok(large(3)));
}

#[test]
fn a_record_that_the_storage_takes_for_whole_has_its_own_crc() {
    let mut record = packed(&small(3));
    record[100] ^= 1;
    assert_eq!(loaded(&record), Loaded::Corrupt(CorruptReason::Crc));
}

#[test]
fn a_record_that_ends_early_is_refused() {
    let record = packed(&small(3));
    for length in 0..record.len() {
        assert_eq!(
            unpack(&record[..length]),
            Err(CorruptReason::Crc),
            "{length}"
        );
    }
    for length in 0..record.len() - 4 {
        let short = changed(&small(3), |record| record.truncate(length));
        assert_eq!(unpack(&short), Err(CorruptReason::NotSettings), "{length}");
    }
}

#[test]
fn another_firmwares_settings_are_told_by_their_schema() {
    let found = *b"another!";
    let other = changed(&small(3), |record| record[..8].copy_from_slice(&found));
    assert_eq!(
        loaded(&other),
        Loaded::Corrupt(CorruptReason::OtherSchema { found })
    );
}

#[test]
fn a_record_holds_settings_and_nothing_else() {
    let long = changed(&small(3), |record| record.push(0));
    assert_eq!(loaded(&long), Loaded::Corrupt(CorruptReason::NotSettings));
    // The kind of support, after the mechanism's eighteen numbers.
    let odd = changed(&small(3), |record| record[8 + 18 * 4] = 9);
    assert_eq!(loaded(&odd), Loaded::Corrupt(CorruptReason::NotSettings));
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let mut fast = small(3);
    fast.motion.speed_rad_per_s = 1e6;
    let why = SettingsError::OutOfRange(OutOfRange {
        section: 0,
        field: 0,
        axis: 0,
    });
    let found = loaded(&packed(&fast));
    assert_eq!(found, Loaded::Corrupt(CorruptReason::Refused(why)));
    assert_eq!(
        CorruptReason::Refused(why).to_string(),
        "the settings stored are refused: motion.speed_rad_per_s is outside 0.01 to 20"
    );
}
