//! The shapes of the messages, from their schemas.

use leg_firmware::host_link::{HostReply, HostRequest};
use postcard_schema::Schema;
use postcard_schema::schema::{DataModelType, DataModelVariant, NamedType, NamedValue};
use std::fmt::Write;

/// Every type that a request or a reply is made of, in the order in which they are met, and their shapes in words.
pub fn message_types() -> (Vec<&'static NamedType>, String) {
    let mut types: Vec<&'static NamedType> = vec![HostRequest::SCHEMA, HostReply::SCHEMA];
    let mut text = String::new();
    let mut next = 0;
    while let Some(&one) = types.get(next) {
        write_type(&mut text, one, &mut types);
        next += 1;
    }
    (types, text)
}

fn write_type(text: &mut String, one: &NamedType, types: &mut Vec<&'static NamedType>) {
    let name = one.name;
    match one.ty {
        DataModelType::Enum(variants) => {
            writeln!(text, "{name}: one of").unwrap();
            for (number, variant) in variants.iter().enumerate() {
                let rest = match variant.ty {
                    DataModelVariant::UnitVariant => String::new(),
                    DataModelVariant::NewtypeVariant(inner) => format!(": {}", word(inner, types)),
                    DataModelVariant::TupleVariant(inner) => format!(": {}", list(inner, types)),
                    DataModelVariant::StructVariant(fields) => {
                        let fields = fields.iter().map(|field| words(field, types));
                        format!(": {}", fields.collect::<Vec<_>>().join(", "))
                    }
                };
                writeln!(text, "    {number} {}{rest}", variant.name).unwrap();
            }
        }
        DataModelType::Struct(fields) => {
            writeln!(text, "{name}:").unwrap();
            for field in *fields {
                writeln!(text, "    {}", words(field, types)).unwrap();
            }
        }
        DataModelType::NewtypeStruct(inner) => {
            writeln!(text, "{name}: {}", word(inner, types)).unwrap();
        }
        other => panic!("{name} has a shape that the page does not describe: {other:?}"),
    }
}

fn words(field: &NamedValue, types: &mut Vec<&'static NamedType>) -> String {
    format!("{} {}", field.name, word(field.ty, types))
}

/// A type in a word; one with a name of its own is listed, too.
fn word(one: &'static NamedType, types: &mut Vec<&'static NamedType>) -> String {
    match one.ty {
        DataModelType::Bool => "bool".into(),
        DataModelType::U8 => "u8".into(),
        DataModelType::U16 => "u16".into(),
        DataModelType::U32 => "u32".into(),
        DataModelType::I32 => "i32".into(),
        DataModelType::F32 => "f32".into(),
        DataModelType::String => "text".into(),
        DataModelType::Option(inner) => format!("none or {}", word(inner, types)),
        DataModelType::Seq(inner) => format!("list of {}", word(inner, types)),
        DataModelType::Tuple(inner) => list(inner, types),
        _ => {
            if !types.contains(&one) {
                types.push(one);
            }
            one.name.into()
        }
    }
}

/// Several types in turn: `f32 × 3`.
fn list(all: &[&'static NamedType], types: &mut Vec<&'static NamedType>) -> String {
    match all {
        [first, rest @ ..] if !rest.is_empty() && rest.iter().all(|one| one == first) => {
            format!("{} × {}", word(first, types), all.len())
        }
        _ => {
            let words: Vec<_> = all.iter().map(|one| word(one, types)).collect();
            words.join(", ")
        }
    }
}
