//! The constants, held to the types and to the linker's memory.

use super::large;
use crate::store::sealed::Sealed;
use crate::store::tests::mock::Mock;
use crate::store::{
    BANK_2, FLASH_SIZE, FLASH_START, PAGE_SIZE, RECORD_MAX, REGION, SETTINGS_MAX, WORD_SIZE,
};
use embedded_storage_async::nor_flash::NorFlash;

#[test]
fn the_largest_settings_are_as_large_as_said() {
    let mut out = [0; 2 * SETTINGS_MAX];
    let encoded = postcard::to_slice(&large(0), &mut out).map(|encoded| encoded.len());
    assert_eq!(encoded, Ok(SETTINGS_MAX));
}

#[test]
fn a_page_holds_one_of_the_largest_records() {
    // A page has a state at its start and end, a record a header; each is a word.
    let room = Sealed::<Mock>::ERASE_SIZE - 2 * WORD_SIZE;
    let record = WORD_SIZE + RECORD_MAX.next_multiple_of(WORD_SIZE);
    assert_eq!(room / record, 1, "{room} bytes, {record} a record");
}

#[test]
fn the_region_is_the_end_of_the_second_bank() {
    const { assert!(REGION.start >= BANK_2) };
    assert_eq!(REGION.end, FLASH_SIZE);
    assert_eq!(REGION.len(), 8 * PAGE_SIZE);
    assert!(REGION.start.is_multiple_of(PAGE_SIZE as u32));
}

#[test]
fn programs_are_kept_out_of_the_region() {
    let memory = include_str!("../../../../../memory.x");
    let origin = format!("_flash_origin : {FLASH_START:#010x}, ");
    let length = format!("LENGTH = {}K", REGION.start / 1024);
    assert!(memory.contains(&(origin + &length)), "{memory}");
}
