//! How many bytes a value takes at most in postcard's format, found when this is compiled.

use leg_model::CURVE_POINTS_MAX;
use postcard_schema::schema::{DataModelType, DataModelVariant, NamedType, NamedValue};

/// Most bytes that a value of a type in the settings takes: their only sequences are curves, and no enum has 128 variants.
pub(super) const fn max_size(named: &NamedType) -> usize {
    match named.ty {
        DataModelType::Bool | DataModelType::U8 | DataModelType::I8 => 1,
        DataModelType::F32 => 4,
        DataModelType::Option(inner) => 1 + max_size(inner),
        DataModelType::NewtypeStruct(inner) => max_size(inner),
        DataModelType::Seq(inner) => 1 + CURVE_POINTS_MAX * max_size(inner),
        DataModelType::Tuple(all) | DataModelType::TupleStruct(all) => sum(all),
        DataModelType::Struct(fields) => sum_fields(fields),
        DataModelType::Enum(variants) => {
            let mut largest = 0;
            let mut rest: &[_] = variants;
            while let [variant, others @ ..] = rest {
                let size = match variant.ty {
                    DataModelVariant::UnitVariant => 0,
                    DataModelVariant::NewtypeVariant(inner) => max_size(inner),
                    DataModelVariant::TupleVariant(all) => sum(all),
                    DataModelVariant::StructVariant(fields) => sum_fields(fields),
                };
                if size > largest {
                    largest = size;
                }
                rest = others;
            }
            1 + largest
        }
        _ => panic!("a type that is not counted here"),
    }
}

const fn sum(all: &[&NamedType]) -> usize {
    match all {
        [] => 0,
        [first, rest @ ..] => max_size(first) + sum(rest),
    }
}

const fn sum_fields(fields: &[&NamedValue]) -> usize {
    match fields {
        [] => 0,
        [first, rest @ ..] => max_size(first.ty) + sum_fields(rest),
    }
}
