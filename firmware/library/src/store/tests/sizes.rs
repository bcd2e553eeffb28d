//! The constants, held to the types and to the linker's memory.

use super::large;
use crate::settings::Settings;
use crate::store::sealed::Sealed;
use crate::store::tests::mock::Mock;
use crate::store::{
    BANK_2, FLASH_SIZE, FLASH_START, PAGE_SIZE, RECORD_MAX, REGION, SETTINGS_MAX, WORD_SIZE,
};
use embedded_storage_async::nor_flash::NorFlash;
use leg_model::CURVE_POINTS_MAX;
use postcard_schema::Schema;
use postcard_schema::schema::{DataModelType, DataModelVariant, NamedType, NamedValue};

/// Most bytes that a value takes; the only sequences in settings are curves, and no enum has 128 variants.
fn max_size(named: &NamedType) -> usize {
    match named.ty {
        DataModelType::Bool | DataModelType::U8 | DataModelType::I8 => 1,
        DataModelType::F32 => 4,
        DataModelType::Option(inner) => 1 + max_size(inner),
        DataModelType::NewtypeStruct(inner) => max_size(inner),
        DataModelType::Seq(inner) => 1 + CURVE_POINTS_MAX * max_size(inner),
        DataModelType::Tuple(all) | DataModelType::TupleStruct(all) => sum(all),
        DataModelType::Struct(fields) => sum_fields(fields),
        DataModelType::Enum(variants) => {
            let bodies = variants.iter().map(|variant| match variant.ty {
                DataModelVariant::UnitVariant => 0,
                DataModelVariant::NewtypeVariant(inner) => max_size(inner),
                DataModelVariant::TupleVariant(all) => sum(all),
                DataModelVariant::StructVariant(fields) => sum_fields(fields),
            });
            1 + bodies.max().unwrap_or(0)
        }
        other => panic!("{}: {other:?} is not counted here", named.name),
    }
}

fn sum(all: &[&NamedType]) -> usize {
    all.iter().map(|one| max_size(one)).sum()
}

fn sum_fields(fields: &[&NamedValue]) -> usize {
    fields.iter().map(|field| max_size(field.ty)).sum()
}

#[test]
fn the_largest_settings_are_as_large_as_said() {
    assert_eq!(max_size(Settings::SCHEMA), SETTINGS_MAX);
    let mut out = [0; 2 * SETTINGS_MAX];
    let encoded = postcard::to_slice(&large(0), &mut out).map(|encoded| encoded.len());
    assert_eq!(encoded, Ok(SETTINGS_MAX));
}

#[test]
fn a_page_holds_two_of_the_largest_records() {
    // A page has a state at its start and end, a record a header; each is a word.
    let room = Sealed::<Mock>::ERASE_SIZE - 2 * WORD_SIZE;
    let record = WORD_SIZE + RECORD_MAX.next_multiple_of(WORD_SIZE);
    assert_eq!((room / record, room % record), (2, 8));
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
