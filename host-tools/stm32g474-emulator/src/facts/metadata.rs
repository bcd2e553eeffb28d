//! The registers as `stm32-metapac` has them.

use stm32_metapac::metadata::ir::{self, Array, BitOffset, BlockItem, BlockItemInner, IR};
use stm32_metapac::metadata::{METADATA, Peripheral, PeripheralRccRegister};

use super::{Access, Block, Register, RegisterField, Switch, description};

/// All blocks, by rising address.
pub fn blocks() -> Vec<Block> {
    let mut blocks: Vec<_> = METADATA.peripherals.iter().filter_map(block).collect();
    blocks.sort_by_key(|block| block.base);
    blocks
}

fn block(peripheral: &Peripheral) -> Option<Block> {
    let kind = peripheral.registers.as_ref()?;
    let base = u32::try_from(peripheral.address).ok()?;
    let names = description::registers(base);
    let mut views = Vec::new();
    collect_views(kind.ir, kind.block, names, "", 0, &mut views);
    views.sort_by_key(|view| view.offset);
    let mut registers: Vec<Register> = Vec::new();
    for view in views {
        match registers.last_mut() {
            Some(last) if last.offset == view.offset => merge(last, view),
            _ => registers.push(view),
        }
    }
    let end = registers.last().map_or(0, |last| last.offset + 4);
    // The common registers of converters have their clock from the converters.
    let clocked = match peripheral.name {
        "ADC12_COMMON" => "ADC1",
        "ADC345_COMMON" => "ADC3",
        "FDCANRAM1" => "FDCAN1",
        "FDCANRAM2" => "FDCAN2",
        "FDCANRAM3" => "FDCAN3",
        own => own,
    };
    let rcc = METADATA.peripherals.iter().find(|p| p.name == clocked);
    let rcc = rcc.and_then(|peripheral| peripheral.rcc.as_ref());
    Some(Block {
        name: peripheral.name,
        base,
        size: end.next_multiple_of(4),
        registers,
        enable: rcc.and_then(|rcc| switch(rcc.enable.as_ref()?)),
        reset: rcc.and_then(|rcc| switch(rcc.reset.as_ref()?)),
    })
}

/// The bit of RCC that a peripheral names.
fn switch(place: &PeripheralRccRegister) -> Option<Switch> {
    let mut all = METADATA.peripherals.iter();
    let rcc = all.find(|peripheral| peripheral.name == "RCC")?;
    let ir = rcc.registers.as_ref()?.ir;
    let mut registers = Vec::new();
    collect_views(ir, "RCC", &[], "", 0, &mut registers);
    let register = registers
        .into_iter()
        .find(|register| register.name == place.register)?;
    let field = register.field(place.field)?;
    Some(Switch {
        offset: register.offset,
        bit: field.mask.trailing_zeros(),
    })
}

/// Adds the registers of a block: several of one offset where it has several views.
fn collect_views(
    ir: &'static IR,
    name: &str,
    names: &[description::DescribedRegister],
    prefix: &str,
    base: u32,
    views: &mut Vec<Register>,
) {
    for item in items(ir, name) {
        for (number, offset) in places(item.array.as_ref(), item.byte_offset) {
            let offset = base + offset;
            let names_here = names.iter().filter(|register| register.offset == offset);
            let name = item_name(
                item,
                number,
                names_here.clone().map(|register| register.name),
            );
            let name = format!("{prefix}{name}");
            match &item.inner {
                BlockItemInner::Block(inner) => {
                    collect_views(ir, inner.block, names, &format!("{name}_"), offset, views);
                }
                BlockItemInner::Register(register) => {
                    let names = names_here.flat_map(|register| register.fields);
                    views.push(view(ir, name, offset, register, &names.collect::<Vec<_>>()));
                }
            }
        }
    }
}

/// The items of a block, which override those of the block that it extends.
fn items(ir: &'static IR, name: &str) -> Vec<&'static BlockItem> {
    let mut blocks = ir.blocks.iter();
    let Some(block) = blocks.find(|block| plain(block.name) == plain(name)) else {
        return Vec::new();
    };
    let mut items = block
        .extends
        .map(|parent| items(ir, parent))
        .unwrap_or_default();
    items.retain(|inherited| block.items.iter().all(|own| own.name != inherited.name));
    items.extend(block.items);
    items
}

/// A name as the metadata compare: `TIM_ADV` is `TimAdv`.
fn plain(name: &str) -> String {
    name.replace('_', "").to_uppercase()
}

fn view(
    ir: &'static IR,
    name: String,
    offset: u32,
    register: &ir::Register,
    names: &[&(&str, u32)],
) -> Register {
    let fields = register.fieldset.map(|set| fields(ir, set, names));
    let fields = fields.unwrap_or_default();
    Register {
        name,
        offset,
        bits: register.bit_size,
        access: match register.access {
            ir::Access::ReadWrite => Access::ReadWrite,
            ir::Access::Read => Access::Read,
            ir::Access::Write => Access::Write,
        },
        known: known(&fields, register.bit_size),
        fields,
        reset: 0,
        contradicted: false,
    }
}

/// The bits of the fields; all where there are none.
pub fn known(fields: &[RegisterField], bits: u32) -> u32 {
    let union = fields.iter().fold(0, |bits, field| bits | field.mask);
    if union == 0 { mask(0, bits) } else { union }
}

/// The number within its array, if it is in one, and the offset of each.
fn places(array: Option<&Array>, start: u32) -> Vec<(Option<u32>, u32)> {
    let offsets: Vec<u32> = match array {
        None => return vec![(None, start)],
        Some(Array::Regular(array)) => (0..array.len).map(|n| n * array.stride).collect(),
        Some(Array::Cursed(array)) => array.offsets.to_vec(),
    };
    let numbered = (0..).map(Some).zip(offsets);
    numbered.map(|(n, offset)| (n, start + offset)).collect()
}

/// Without the name of a view. One of an array has the name that ST's description gives to the place, if that is the array's
/// with a number; else it is numbered from 1.
fn item_name<'n>(
    item: &BlockItem,
    number: Option<u32>,
    mut names: impl Iterator<Item = &'n str>,
) -> String {
    let stem = view_name(&item.name.to_uppercase());
    let Some(number) = number else { return stem };
    match (stem.as_str(), number) {
        ("AFR", 0) => "AFRL".to_owned(),
        ("AFR", _) => "AFRH".to_owned(),
        _ => names
            .find(|name| unnumbered(name) == unnumbered(&stem))
            .map_or_else(|| format!("{stem}{}", number + 1), str::to_owned),
    }
}

/// A register's name without that of a view of it.
pub fn view_name(name: &str) -> String {
    let views = ["_INPUT", "_OUTPUT", "_DITHER"];
    views
        .iter()
        .fold(name.to_owned(), |name, view| name.replace(view, ""))
}

fn unnumbered(name: &str) -> String {
    name.replace(|digit: char| digit.is_ascii_digit(), "")
}

/// The fields of a set, which override those of the set that it extends.
fn set_fields(ir: &'static IR, name: &str) -> Vec<&'static ir::Field> {
    let Some(set) = ir.fieldsets.iter().find(|set| set.name == name) else {
        return Vec::new();
    };
    let mut fields = set
        .extends
        .map(|parent| set_fields(ir, parent))
        .unwrap_or_default();
    fields.retain(|inherited| set.fields.iter().all(|own| own.name != inherited.name));
    fields.extend(set.fields);
    fields
}

fn fields(ir: &'static IR, set: &str, names: &[&(&str, u32)]) -> Vec<RegisterField> {
    let mut fields = Vec::new();
    for field in set_fields(ir, set) {
        let stem = field.name.to_uppercase();
        let mut array = Vec::new();
        for (number, shift) in places(field.array.as_ref(), 0) {
            let name = number.map_or(stem.clone(), |number| format!("{stem}{number}"));
            array.push(RegisterField {
                name_by_st: name.clone(),
                name,
                mask: field_mask(field) << shift,
                values: field.enumm.and_then(|name| values(ir, name)),
                names: field
                    .enumm
                    .map(|name| meanings(ir, name))
                    .unwrap_or_default(),
            });
        }
        if field.array.is_some() {
            name_by_st(&stem, &mut array, names);
        }
        fields.extend(array);
    }
    fields
}

/// Gives an array's fields the names that ST's description gives to their places, if those are the array's with numbers
/// that rise.
fn name_by_st(stem: &str, array: &mut [RegisterField], names: &[&(&str, u32)]) {
    // Where a field is in two parts, the description has them as two fields: the lower one has the name.
    let lowest = |mask: u32| mask & mask.wrapping_neg();
    let named = |field: &RegisterField| {
        let mut names = names
            .iter()
            .filter(|(_, mask)| lowest(*mask) == lowest(field.mask));
        names
            .find(|(name, _)| unnumbered(name) == unnumbered(stem))
            .map(|(name, _)| *name)
    };
    let found: Vec<_> = array.iter().map(named).collect();
    let numbers = found.iter().flatten().map(|name| number(name));
    if !numbers.is_sorted_by(|one, next| one < next) {
        return;
    }
    for (field, name) in array.iter_mut().zip(found) {
        if let Some(name) = name {
            field.name_by_st = name.to_owned();
        }
    }
}

/// The digits of a name.
fn number(name: &str) -> u32 {
    let digits = name.chars().filter_map(|digit| digit.to_digit(10));
    digits.fold(0, |number, digit| number * 10 + digit)
}

fn field_mask(field: &ir::Field) -> u32 {
    match &field.bit_offset {
        BitOffset::Regular(place) => mask(place.offset, field.bit_size),
        BitOffset::Cursed(place) => place.ranges.iter().fold(0, |bits, range| {
            bits | mask(*range.start(), range.end() - range.start() + 1)
        }),
    }
}

/// `count` bits from `start`.
fn mask(start: u32, count: u32) -> u32 {
    u32::MAX.unbounded_shr(32 - count) << start
}

/// The names of an enumeration's values.
fn meanings(ir: &'static IR, name: &str) -> Vec<(u32, &'static str)> {
    let known = ir.enums.iter().find(|known| known.name == name);
    let variants = known.map_or(&[][..], |known| known.variants).iter();
    variants
        .filter_map(|variant| Some((u32::try_from(variant.value).ok()?, variant.name)))
        .collect()
}

/// The values of an enumeration; none where it has all that its bits can hold.
fn values(ir: &IR, name: &str) -> Option<Vec<u32>> {
    let known = ir.enums.iter().find(|known| known.name == name)?;
    let values = known.variants.iter().map(|variant| variant.value);
    let values: Vec<u32> = values
        .filter_map(|value| u32::try_from(value).ok())
        .collect();
    (values.len() < 1 << known.bit_size).then_some(values)
}

/// Makes one register of two views of it: the capture and the compare side of a timer's channel, a count with and without
/// dither.
fn merge(one: &mut Register, other: Register) {
    one.known |= other.known;
    one.bits = one.bits.max(other.bits);
    if one.access != other.access {
        one.access = Access::ReadWrite;
    }
    for field in &mut one.fields {
        let mut rivals = other.fields.iter();
        if rivals.any(|rival| rival.mask & field.mask != 0 && rival.values != field.values) {
            field.values = None;
        }
    }
    for mut field in other.fields {
        let mut rivals = one
            .fields
            .iter()
            .filter(|rival| rival.mask & field.mask != 0);
        if rivals
            .clone()
            .any(|rival| rival.name == field.name && rival.mask == field.mask)
        {
            continue;
        }
        if rivals.any(|rival| rival.values != field.values || rival.mask != field.mask) {
            field.values = None;
        }
        one.fields.push(field);
    }
}
