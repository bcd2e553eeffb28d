//! A section of numbers as one table: name, unit, range, default and meaning of every field.
//!
//! The table drives everything that is done with a section: the struct and its documentation, the check on the board,
//! and on the host reading with places, listing, overriding and writing back.

/// One field of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field<T = f32> {
    /// Its name, which ends with its unit.
    pub name: &'static str,
    /// Its unit, `1` for a pure number.
    pub unit: &'static str,
    /// What it means and what it does.
    pub meaning: &'static str,
    /// Lowest and highest value; of the magnitude where it is [`signed`](Self::signed).
    pub range: [T; 2],
    /// Whether the range is that of the magnitude, and the sign is free.
    pub signed: bool,
    /// The value unless another is given.
    pub default: T,
}

impl<T> Field<T> {
    /// A field that no section declares, for values that [`fields`](crate::fields) does not cover.
    #[must_use]
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        range: [T; 2],
        default: T,
    ) -> Self {
        Self {
            name,
            unit,
            meaning,
            range,
            signed: false,
            default,
        }
    }
}

impl<T: Copy + PartialOrd + core::ops::Neg<Output = T>> Field<T> {
    /// Whether a value is in the range. NaN is not.
    #[must_use]
    pub fn contains(&self, value: T) -> bool {
        let [low, high] = self.range;
        let inside = |value: T| low <= value && value <= high;
        inside(value) || self.signed && inside(-value)
    }
}

/// Declares a section of numbers: a struct and its [`Field`]s, one line a field:
/// `name [unit]: low..=high = default;`, its documentation being its meaning. `and` adds fields of other types, which the
/// table does not cover.
///
/// ```
/// leg_firmware::fields! {
///     /// A tank.
///     #[derive(Clone, Copy)]
///     pub struct Tank: f32 {
///         /// How much it holds.
///         volume_m3 ["m³"]: 0.1..=10.0 = 1.0;
///     }
/// }
/// let tank = Tank { volume_m3: 20.0 };
/// let [field] = Tank::FIELDS else { unreachable!() };
/// assert_eq!((field.name, field.unit), ("volume_m3", "m³"));
/// assert!(!field.contains(tank.volume_m3));
/// ```
#[macro_export]
macro_rules! fields {
    (
        $(#[$attribute:meta])*
        pub struct $section:ident: $number:ident {
            $(
                $(#[doc = $meaning:literal])+
                $field:ident [$unit:literal]: $low:literal..=$high:literal = $default:literal $($signed:ident)?;
            )*
        }
        $(and {
            $($(#[$other_attribute:meta])* $other:ident: $kind:ty = $other_default:expr;)*
        })?
    ) => {
        $(#[$attribute])*
        pub struct $section {
            $(
                $(#[doc = $meaning])+
                #[doc = concat!(" Unit: ", $unit, "; from ", $low, " to ", $high, ", by default ", $default, ".")]
                pub $field: $number,
            )*
            $($($(#[$other_attribute])* pub $other: $kind,)*)?
        }

        impl $section {
            /// Every field at its default.
            pub const DEFAULT: Self = Self {
                $($field: $default,)*
                $($($other: $other_default,)*)?
            };

            /// The table of its fields.
            pub const FIELDS: &'static [$crate::settings::Field<$number>] = &[
                $($crate::settings::Field {
                    name: stringify!($field),
                    unit: $unit,
                    meaning: concat!($($meaning),+),
                    range: [$low, $high],
                    signed: $crate::fields!(@signed $($signed)?),
                    default: $default,
                },)*
            ];

            /// The value of every field, in the order of [`Self::FIELDS`].
            #[must_use]
            pub fn values(&self) -> [$number; Self::FIELDS.len()] {
                [$(self.$field),*]
            }

            /// The same, to be changed; they may leave their ranges by that.
            pub fn values_mut(&mut self) -> [&mut $number; Self::FIELDS.len()] {
                [$(&mut self.$field),*]
            }
        }

        impl Default for $section {
            fn default() -> Self {
                Self::DEFAULT
            }
        }
    };
    (@signed) => { false };
    (@signed signed) => { true };
}
