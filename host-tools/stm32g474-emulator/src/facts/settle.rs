//! Makes one description of two.
//!
//! Fields are compared by their place and by [`Field::name_by_st`].

use super::description;
use super::metadata::{known, view_name};
use super::rulings::{Holds, RESETS, RULINGS, Ruling, Source, complete_source};
use super::{Access, Block, Register, RegisterField};

/// A difference that neither a rule nor a ruling settles; what both sources say is kept then.
#[derive(Debug, PartialEq, Eq)]
pub struct Unsettled {
    pub block: &'static str,
    pub register: String,
    /// Names and masks.
    pub metapac: Vec<(String, u32)>,
    pub described: Vec<(String, u32)>,
}

/// Adds to a block what ST's description knows of it.
///
/// Rules settle what is no contradiction:
/// - What one source lacks, the other knows: a register, a field.
/// - A field that the other source has in parts is whole.
/// - Where the names alone differ, both are kept; a register has the name that it has in stm32-metapac.
/// - What the processor may do with a register is as ST says; stm32-metapac often says both for what can only be read.
///
/// The rulings settle the rest, and go before the rules.
pub fn settle(block: &mut Block) -> Vec<Unsettled> {
    let described = description::registers(block.base);
    let mut unsettled = Vec::new();
    if described.is_empty() {
        return unsettled;
    }
    let complete = |register: &str| complete_source(block.name, register);
    block.registers.retain(|register| {
        let unknown = described.iter().all(|view| view.offset != register.offset);
        !(unknown && complete(&register.name) == Some(Source::Description))
    });
    for register in described.chunk_by(|one, next| one.offset == next.offset) {
        let Some(mut theirs) = merged(register) else {
            continue;
        };
        let mut known = block.registers.iter_mut();
        if let Some(ours) = known.find(|known| known.offset == theirs.offset) {
            let fields = (
                std::mem::take(&mut ours.fields),
                std::mem::take(&mut theirs.fields),
            );
            let difference;
            (theirs.fields, difference) =
                settle_fields(block.name, &theirs.name, fields.0, fields.1);
            ours.contradicted = difference.is_some();
            unsettled.extend(difference);
            ours.known = self::known(&theirs.fields, ours.bits);
            ours.fields = theirs.fields;
            ours.access = theirs.access;
            ours.reset = theirs.reset;
        } else if complete(&theirs.name) != Some(Source::Metapac) {
            block.registers.push(theirs);
        }
    }
    block.registers.sort_by_key(|register| register.offset);
    for (blocks, name, value, _) in RESETS {
        let mut registers = block.registers.iter_mut();
        if blocks.contains(&block.name)
            && let Some(register) = registers.find(|register| register.name == *name)
        {
            register.reset = *value;
        }
    }
    block.registers.iter_mut().for_each(add_reset_values);
    let end = block.registers.last().map_or(0, |last| last.offset + 4);
    block.size = end.next_multiple_of(4);
    unsettled
}

/// What a field is after a reset has a meaning, too: enumerations of what starts something omit it.
fn add_reset_values(register: &mut Register) {
    if register.access == Access::Write {
        return;
    }
    for field in &mut register.fields {
        let reset = field.value(register.reset);
        let all = 1_usize.checked_shl(field.mask.count_ones());
        if let Some(values) = &mut field.values {
            if !values.contains(&reset) {
                values.push(reset);
                values.sort_unstable();
            }
            if Some(values.len()) == all {
                field.values = None;
            }
        }
    }
}

/// The register of its described views.
fn merged(views: &[description::DescribedRegister]) -> Option<Register> {
    let first = views.first()?;
    let read = views.iter().any(|view| view.read);
    let write = views.iter().any(|view| view.write);
    let mut fields: Vec<RegisterField> = Vec::new();
    for &(name, mask) in views.iter().flat_map(|view| view.fields) {
        if !fields
            .iter()
            .any(|field| field.name == name && field.mask == mask)
        {
            fields.push(field(name, mask));
        }
    }
    Some(Register {
        name: view_name(first.name),
        offset: first.offset,
        bits: 32,
        access: match (read, write) {
            (true, false) => Access::Read,
            (false, true) => Access::Write,
            _ => Access::ReadWrite,
        },
        known: known(&fields, 32),
        fields,
        reset: first.reset,
        contradicted: false,
    })
}

fn field(name: &str, mask: u32) -> RegisterField {
    RegisterField {
        name: name.to_owned(),
        name_by_st: name.to_owned(),
        mask,
        values: None,
        names: Vec::new(),
    }
}

fn settle_fields(
    block: &'static str,
    register: &str,
    mut ours: Vec<RegisterField>,
    mut theirs: Vec<RegisterField>,
) -> (Vec<RegisterField>, Option<Unsettled>) {
    let all_ours = ours.clone();
    let all_theirs = theirs.clone();
    let same = |one: &RegisterField, other: &RegisterField| {
        one.name_by_st == other.name_by_st && one.mask == other.mask
    };
    let mut settled = take(&mut ours, |field| {
        all_theirs.iter().any(|other| same(field, other))
    });
    theirs.retain(|field| !all_ours.iter().any(|other| same(field, other)));
    match complete_source(block, register) {
        Some(Source::Metapac) => theirs.retain(|field| !is_lacking(field, &all_ours)),
        Some(Source::Description) => ours.retain(|field| !is_lacking(field, &all_theirs)),
        None => {}
    }
    let about = |one: &&Ruling| one.register == register && one.blocks.contains(&block);
    for ruling in RULINGS.iter().filter(about) {
        let mut from_ours = take(&mut ours, |field| ruling.is_about(ruling.metapac, field));
        let mut from_theirs = take(&mut theirs, |field| {
            ruling.is_about(ruling.described, field)
        });
        match ruling.holds {
            Holds::Of(Source::Metapac) => settled.append(&mut from_ours),
            Holds::Of(Source::Description) => settled.append(&mut from_theirs),
            Holds::Fields(fields) => {
                settled.extend(fields.iter().map(|(name, mask)| field(name, *mask)));
            }
        }
    }
    settled.extend(take_wholes(&mut ours, &mut theirs));
    settled.extend(take_wholes(&mut theirs, &mut ours));
    for mut field in take(&mut ours, |field| {
        other_name(field, &theirs, &all_ours, &all_theirs).is_some()
    }) {
        if let Some(name) = other_name(&field, &theirs, &all_ours, &all_theirs) {
            theirs.retain(|other| other.name != name);
            field.name_by_st = name;
        }
        settled.push(field);
    }
    settled.extend(take(&mut ours, |field| is_lacking(field, &all_theirs)));
    settled.extend(take(&mut theirs, |field| is_lacking(field, &all_ours)));
    let unsettled = (!ours.is_empty() || !theirs.is_empty()).then(|| Unsettled {
        block,
        register: register.to_owned(),
        metapac: places(&ours),
        described: places(&theirs),
    });
    settled.append(&mut ours);
    settled.append(&mut theirs);
    settled.sort_by_key(|field| field.mask);
    (settled, unsettled)
}

fn places(fields: &[RegisterField]) -> Vec<(String, u32)> {
    fields
        .iter()
        .map(|field| (field.name_by_st.clone(), field.mask))
        .collect()
}

fn union(fields: &[RegisterField]) -> u32 {
    fields.iter().fold(0, |union, field| union | field.mask)
}

fn take(
    fields: &mut Vec<RegisterField>,
    which: impl FnMut(&RegisterField) -> bool,
) -> Vec<RegisterField> {
    let mut which = which;
    fields.extract_if(.., |field| which(field)).collect()
}

/// The fields that the other source has in parts; the parts are dropped.
fn take_wholes(
    fields: &mut Vec<RegisterField>,
    parts: &mut Vec<RegisterField>,
) -> Vec<RegisterField> {
    take(fields, |whole| {
        let within = |part: &RegisterField| part.mask & !whole.mask == 0;
        let found: Vec<_> = parts.iter().filter(|part| within(part)).cloned().collect();
        let mut names = found.iter().map(|part| &part.name_by_st);
        let is_whole = found.len() > 1
            && union(&found) == whole.mask
            && names.any(|name| name.starts_with(&whole.name_by_st));
        parts.retain(|part| !(is_whole && within(part)));
        is_whole
    })
}

/// Whether the other source knows nothing of a field: neither its bits nor its name at another place.
fn is_lacking(field: &RegisterField, others: &[RegisterField]) -> bool {
    let named = others
        .iter()
        .any(|other| other.name_by_st == field.name_by_st);
    union(others) & field.mask == 0 && !named
}

/// What ST calls a field of the same bits, if neither name is at another place in the other source.
fn other_name(
    field: &RegisterField,
    theirs: &[RegisterField],
    all_ours: &[RegisterField],
    all_theirs: &[RegisterField],
) -> Option<String> {
    let other = theirs.iter().find(|other| other.mask == field.mask)?;
    let moved = all_ours.iter().any(|ours| ours.name_by_st == other.name)
        || all_theirs
            .iter()
            .any(|theirs| theirs.name == field.name_by_st);
    (!moved).then(|| other.name.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(ours: &[(&str, u32)], theirs: &[(&str, u32)]) -> (Vec<(String, u32)>, bool) {
        let fields =
            |list: &[(&str, u32)]| list.iter().map(|(name, mask)| field(name, *mask)).collect();
        let (settled, rest) = settle_fields("NONE", "NONE", fields(ours), fields(theirs));
        (places(&settled), rest.is_some())
    }

    #[test]
    fn contradictions_are_not_settled_by_rules() {
        for (what, ours, theirs) in [
            ("moved", &[("A", 0x1)][..], &[("A", 0x2)][..]),
            (
                "swapped",
                &[("A", 0x1), ("B", 0x2)],
                &[("A", 0x2), ("B", 0x1)],
            ),
            (
                "others in its place",
                &[("A", 0x3)],
                &[("B", 0x1), ("C", 0x2)],
            ),
            ("wider", &[("A", 0x3)], &[("A", 0x7)]),
            ("overlapping", &[("A", 0x3)], &[("B", 0x6)]),
            (
                "renamed and moved",
                &[("A", 0x1)],
                &[("B", 0x1), ("A", 0x2)],
            ),
        ] {
            let (fields, is_contradiction) = settled(ours, theirs);
            assert!(is_contradiction, "{what}: {fields:x?}");
        }
    }

    #[test]
    fn what_is_no_contradiction_is_settled() {
        for (what, ours, theirs, one) in [
            (
                "lacking",
                &[("A", 0x1)][..],
                &[("B", 0x2)][..],
                &[("A", 0x1), ("B", 0x2)][..],
            ),
            (
                "in parts",
                &[("A", 0x13)],
                &[("A", 0x3), ("A_2", 0x10)],
                &[("A", 0x13)],
            ),
            (
                "whole",
                &[("A0", 0x1), ("A1", 0x2)],
                &[("A", 0x3)],
                &[("A", 0x3)],
            ),
            ("renamed", &[("A", 0x1)], &[("B", 0x1)], &[("B", 0x1)]),
        ] {
            let one: Vec<_> = one
                .iter()
                .map(|(name, mask)| ((*name).to_owned(), *mask))
                .collect();
            assert_eq!(settled(ours, theirs), (one, false), "{what}");
        }
    }
}
