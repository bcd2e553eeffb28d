//! Numbers that a file may leave out: each with its meaning and its range.

use leg_firmware::settings;

/// What is known of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Its key, which ends with its unit.
    pub name: &'static str,
    /// What it means, in one sentence or two.
    pub meaning: &'static str,
    /// Lowest and highest value.
    pub range: [f64; 2],
}

impl Field {
    /// Whether a value is in the range.
    #[must_use]
    pub fn takes(&self, value: f64) -> bool {
        (self.range[0]..=self.range[1]).contains(&value)
    }
}

impl From<&settings::Field> for Field {
    fn from(field: &settings::Field) -> Self {
        Self {
            name: field.name,
            meaning: field.meaning.trim(),
            range: field.range.map(decimal),
        }
    }
}

/// The number that is written like an f32: 0.05 for 0.05, not 0.05000000074505806.
#[must_use]
pub fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value.into())
}

/// Digits that suffice to tell values apart.
const SHORT: usize = 9;

/// A number for people: as short as it can be, else with six digits.
#[must_use]
pub fn plain(value: f64) -> String {
    let written = |value: f64| {
        if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
            format!("{value}")
        } else {
            format!("{value:e}")
        }
    };
    let exact = written(value);
    if exact.len() <= SHORT {
        return exact;
    }
    format!("{value:.5e}").parse().map_or(exact, written)
}

/// Declares a struct of numbers, `name: low..=high = default;` each, and of whatever is `besides` them.
macro_rules! fields {
    (
        $(#[doc = $about:literal])*
        $name:ident {
            $($(#[doc = $meaning:literal])* $field:ident: $low:literal..=$high:literal = $default:literal;)*
        }
        besides {
            $($(#[doc = $other_meaning:literal])* $other:ident: $kind:ty = $other_default:expr;)*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name {
            $($(#[doc = $meaning])* pub $field: f64,)*
            $($(#[doc = $other_meaning])* pub $other: $kind,)*
        }

        impl $name {
            /// Unless another is given.
            pub const DEFAULT: Self = Self {
                $($field: $default,)*
                $($other: $other_default,)*
            };

            /// Every number of its own.
            #[must_use]
            pub fn fields() -> Vec<$crate::fields::Field> {
                vec![$($crate::fields::Field {
                    name: stringify!($field),
                    meaning: concat!($($meaning),*).trim(),
                    range: [$low, $high],
                },)*]
            }

            /// The value of each, in the same order.
            #[must_use]
            pub fn values(&self) -> Vec<f64> {
                vec![$(self.$field),*]
            }

            /// The same, to be changed.
            pub fn values_mut(&mut self) -> Vec<&mut f64> {
                vec![$(&mut self.$field),*]
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self::DEFAULT
            }
        }
    };
}

pub(crate) use fields;

#[cfg(test)]
mod tests {
    use super::{decimal, plain};

    #[test]
    fn numbers_are_written_short() {
        let written = [0.0, 0.3, -20.0, 1e5, 2e-7, 0.1 + 0.2, 1.0 / 3e5].map(plain);
        let short = ["0", "0.3", "-20", "1e5", "2e-7", "0.3", "3.33333e-6"];
        assert_eq!(written, short);
        assert_eq!(decimal(0.05), 0.05);
    }
}
