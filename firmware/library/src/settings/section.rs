//! A section of the settings: each field with its meaning, unit, range and default.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// What is known of one field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Its name, which ends with its unit.
    pub name: &'static str,
    /// What it means and what it does.
    pub meaning: &'static str,
    /// Lowest and highest value.
    pub range: [f32; 2],
    /// The value unless another is given.
    pub default: f32,
}

/// A field outside its range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct OutOfRange {
    /// The section's number, as in [`SECTIONS`](super::SECTIONS).
    pub section: u8,
    /// The field's number in the section.
    pub field: u8,
}

/// Declares a section: `name: low..=high = default;` for each field.
macro_rules! section {
    (
        $(#[doc = $about:literal])*
        $number:literal $section:ident {
            $($(#[doc = $meaning:literal])* $field:ident: $low:literal..=$high:literal = $default:literal;)*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize, postcard_schema::Schema)]
        #[serde(default, deny_unknown_fields)]
        pub struct $section {
            $($(#[doc = $meaning])* pub $field: f32,)*
        }

        impl Default for $section {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        impl $section {
            /// Every field.
            pub const FIELDS: &'static [$crate::settings::Field] = &[
                $($crate::settings::Field {
                    name: stringify!($field),
                    meaning: concat!($($meaning),*),
                    range: [$low, $high],
                    default: $default,
                },)*
            ];

            /// The value of every field, in the order of [`Self::FIELDS`].
            #[must_use]
            pub fn values(&self) -> [f32; Self::FIELDS.len()] {
                [$(self.$field),*]
            }

            /// The same, to be changed. [`Self::check`] tells whether they are in range.
            pub fn values_mut(&mut self) -> [&mut f32; Self::FIELDS.len()] {
                [$(&mut self.$field),*]
            }

            /// Checks every field against its range.
            ///
            /// # Errors
            /// The first that is outside, or not a number.
            pub fn check(&self) -> Result<(), $crate::settings::OutOfRange> {
                for ((number, known), value) in (0..).zip(Self::FIELDS).zip(self.values()) {
                    if !(known.range[0] <= value && value <= known.range[1]) {
                        return Err($crate::settings::OutOfRange { section: $number, field: number });
                    }
                }
                Ok(())
            }
        }
    };
}

pub(super) use section;
