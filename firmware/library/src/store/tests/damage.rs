//! Bits that flip, and flash that never held a store.

use super::mock::{FlashFailure, Mock, Random};
use super::{
    CorruptReason, Loaded, StoreError, assert_holds, block_on, clear, keep, large, load, save,
    small, store,
};
use crate::store::sealed::SEAL;
use crate::store::{KEY, PAGE_SIZE, RECORD_MAX, WORD_SIZE};
use core::ops::Range;

/// Where a large record and its header lie, in bits: each in a page, which begins with its seal and its state.
fn record(number: usize) -> Range<usize> {
    let length = WORD_SIZE + RECORD_MAX;
    let start = number * PAGE_SIZE + 2 * WORD_SIZE;
    8 * start..8 * (start + length)
}

#[test]
fn every_flipped_bit_of_the_only_record_is_found() {
    let mut flash = Mock::new(3);
    keep(&mut flash, &large(0));
    for bit in record(0) {
        flash.flip(bit);
        assert_eq!(
            load(&mut flash),
            Ok(Loaded::Corrupt(CorruptReason::Storage)),
            "bit {bit}"
        );
        flash.flip(bit);
    }
    assert_holds(&mut flash, &large(0));
}

#[test]
fn a_flipped_bit_of_the_newest_record_leaves_the_older_one() {
    let mut flash = Mock::new(3);
    keep(&mut flash, &large(0));
    keep(&mut flash, &large(1));
    for bit in record(1) {
        flash.flip(bit);
        assert_eq!(
            load(&mut flash),
            Ok(Loaded::Settings(large(0))),
            "bit {bit}"
        );
        flash.flip(bit);
    }
    for bit in record(0) {
        flash.flip(bit);
        assert_holds(&mut flash, &large(1));
        flash.flip(bit);
    }
}

/// A flash with a record in its second turn: some pages full, one begun, one erased.
fn used() -> Mock {
    let mut flash = Mock::new(3);
    for number in 0..9 {
        keep(&mut flash, &large(number));
    }
    flash
}

#[test]
fn wherever_a_bit_flips_no_settings_arise_that_were_not_saved() {
    let flash = used();
    let saved: Vec<_> = (0..9).map(large).collect();
    for bit in 0..8 * flash.bytes.len() {
        let mut flipped = flash.clone();
        flipped.flip(bit);
        flipped.restart();
        match load(&mut flipped) {
            Ok(Loaded::Settings(settings)) => assert!(saved.contains(&settings), "bit {bit}"),
            other => assert_eq!(
                other,
                Ok(Loaded::Corrupt(CorruptReason::Storage)),
                "bit {bit}"
            ),
        }
    }
}

#[test]
fn after_a_flipped_bit_settings_can_be_saved() {
    let flash = used();
    for bit in (0..8 * flash.bytes.len()).step_by(11) {
        let mut flipped = flash.clone();
        flipped.flip(bit);
        flipped.restart();
        // A bit that flipped where nothing was written yet makes the flash refuse one save.
        if save(&mut flipped, &large(10)).is_err() {
            assert_eq!(clear(&mut flipped), Ok(()), "bit {bit}");
        }
        for number in 11..20 {
            if save(&mut flipped, &large(number)).is_err() {
                assert_eq!(clear(&mut flipped), Ok(()), "bit {bit}");
                assert_eq!(save(&mut flipped, &large(number)), Ok(()), "bit {bit}");
            }
            assert_holds(&mut flipped, &large(number));
        }
    }
}

#[test]
fn a_damaged_header_may_claim_any_length() {
    let mut flash = Mock::new(3);
    keep(&mut flash, &small(0));
    let long: &[u8] = &[7; 1500];
    let mut store = store(&mut flash);
    let mut buffer = [0; PAGE_SIZE];
    let stored = store.map.store_item(&mut buffer, &KEY, &long);
    assert_eq!(block_on(stored), Ok(()));
    let data = flash.bytes.windows(8).position(|bytes| bytes == [7; 8]);
    flash.flip(8 * data.unwrap_or(0));
    assert_holds(&mut flash, &small(0));
    keep(&mut flash, &small(1));
}

#[test]
fn clearing_ends_what_a_word_that_refuses_writes_has_begun() {
    let mut flash = Mock::new(3);
    keep(&mut flash, &small(0));
    let erased = |at: &usize| flash.bytes[*at..][..2 * WORD_SIZE] == [0xff; 2 * WORD_SIZE];
    let words = (0..PAGE_SIZE).step_by(WORD_SIZE);
    let free = words.into_iter().find(erased).unwrap_or_default();
    flash.refuse(free);
    let refused = FlashFailure::NotErased(free as u32);
    assert_eq!(save(&mut flash, &small(1)), Err(StoreError::Flash(refused)));
    assert_holds(&mut flash, &small(0));
    assert_eq!(clear(&mut flash), Ok(()));
    assert_eq!(load(&mut flash), Ok(Loaded::Empty));
    keep(&mut flash, &small(1));
}

fn noise(pages: usize, random: &mut Random) -> Vec<u8> {
    (0..pages * PAGE_SIZE)
        .map(|_| random.next() as u8)
        .collect()
}

#[test]
fn foreign_contents_are_corrupt_and_can_be_written_over() {
    for seed in 0..100 {
        let mut flash = Mock::holding(noise(3, &mut Random(seed)));
        assert_eq!(
            load(&mut flash),
            Ok(Loaded::Corrupt(CorruptReason::Storage))
        );
        for number in 0..12 {
            keep(&mut flash, &large(number));
        }
    }
}

/// Noise that claims to be the store's, each page in a state by chance, or with part of it erased.
fn imposture(random: &mut Random) -> Mock {
    let mut bytes = noise(3, random);
    for page in bytes.chunks_mut(PAGE_SIZE) {
        let erased = random.number_below(PAGE_SIZE);
        page[erased..].fill(0xFF);
        for state in [WORD_SIZE, PAGE_SIZE - WORD_SIZE] {
            let byte = [0, 0xFF][random.number_below(2)];
            page[state..state + WORD_SIZE].fill(byte);
        }
        page[..WORD_SIZE].copy_from_slice(&SEAL);
    }
    Mock::holding(bytes)
}

#[test]
fn contents_that_claim_to_be_a_store_do_no_harm() {
    let mut random = Random(7);
    for _ in 0..2000 {
        let mut flash = imposture(&mut random);
        assert_eq!(
            load(&mut flash),
            Ok(Loaded::Corrupt(CorruptReason::Storage))
        );
        let _ = save(&mut flash, &large(1));
        assert_eq!(clear(&mut flash), Ok(()));
        assert_eq!(load(&mut flash), Ok(Loaded::Empty));
        if save(&mut flash, &large(2)).is_err() {
            assert_eq!(clear(&mut flash), Ok(()));
            assert_eq!(save(&mut flash, &large(2)), Ok(()));
        }
        assert_holds(&mut flash, &large(2));
    }
}
