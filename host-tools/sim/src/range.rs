//! The range of every number in scenarios and actions, checked while it is read: so a refusal has its place.

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// The longest time of a step, s.
const LONGEST_S: f64 = 600.0;

/// Beyond every number that means something here; it only keeps out what is not finite.
const ANY: f64 = 1e9;

macro_rules! ranges {
    ($($name:ident $key:literal $low:expr, $high:expr;)*) => {$(
        pub(crate) fn $name<'de, D: Deserializer<'de>, T: Ranged<'de>>(
            deserializer: D,
        ) -> Result<T, D::Error> {
            read(deserializer, $key, [$low, $high])
        }
    )*};
}

ranges! {
    // Ten turns.
    azimuth_deg "azimuth_deg" -3600.0, 3600.0;
    towards_deg "towards_deg" -3600.0, 3600.0;
    tilt_deg "tilt_deg" -90.0, 90.0;
    start_tilt_deg "tilt_deg" 0.0, 60.0;
    // What the leg itself refuses is let through, so that the refusal can be seen.
    pretension_n "pretension_n" -ANY, ANY;
    demand_nm_per_rad "nm_per_rad" -ANY, ANY;
    travel_mm "travel_mm" -ANY, ANY;
    volts "volts" -ANY, ANY;
    mm_per_s "mm_per_s" -ANY, ANY;
    start_pretension_n "pretension_n" 0.0, 1e3;
    slack_mm "slack_mm" 0.0, 50.0;
    // The tendons of no rig here hold more.
    kg "kg" 0.0, 50.0;
    payload_kg "payload_kg" 0.0, 50.0;
    force_n "force_n" -1e4, 1e4;
    test_force_n "force_n" 1e-3, 1e4;
    turns "turns" -1e3, 1e3;
    newtons "newtons" 0.0, 1e4;
    over_s "over_s" 0.0, LONGEST_S;
    for_s "for_s" 0.0, LONGEST_S;
    period_s "period_s" 0.1, 60.0;
    circle_turns "turns" 0.01, 5.0;
    points_per_s "points_per_s" 0.1, 200.0;
    wait_s "wait_s" 0.0, LONGEST_S;
    then_s "then_s" 0.0, LONGEST_S;
    timeout_s "timeout_s" 0.0, LONGEST_S;
    settle_s "settle_s" 0.1, LONGEST_S;
    within_ms "within_ms" 0.0, 1e3 * LONGEST_S;
    within_percent "within_percent" 0.0, 100.0;
    stiffness_nm_per_rad "nm_per_rad" 0.0, ANY;
    between "between" -ANY, ANY;
    cell_gain_error_percent "cell_gain_error_percent" -50.0, 50.0;
    cell_offset_n "cell_offset_n" -100.0, 100.0;
    cell_noise_n "cell_noise_n" 0.0, 100.0;
    curve_error_percent "curve_error_percent" -50.0, 50.0;
}

fn read<'de, D: Deserializer<'de>, T: Ranged<'de>>(
    deserializer: D,
    key: &str,
    [low, high]: [f64; 2],
) -> Result<T, D::Error> {
    let read = T::read(deserializer)?;
    let mut outside = read
        .numbers()
        .iter()
        .filter(|number| !(low..=high).contains(*number));
    match outside.next() {
        None => Ok(read),
        Some(value) => {
            let sentence = format!("{key} = {value} is not from {low} to {high}");
            Err(D::Error::custom(sentence))
        }
    }
}

/// The most letters of a title: two lines of a terminal.
const TITLE_LETTERS: usize = 200;

/// The most letters of what is measured: it stands in a row of a table.
const NAME_LETTERS: usize = 100;

/// The most bytes that are sent at once: what the line carries in a second.
const GARBAGE_BYTES: u32 = 100_000;

/// A title: one line.
pub(crate) fn title<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    line(deserializer, "title", TITLE_LETTERS)
}

/// A name in a table: one line.
pub(crate) fn name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    line(deserializer, "name", NAME_LETTERS)
}

fn line<'de, D: Deserializer<'de>>(
    deserializer: D,
    key: &str,
    letters_max: usize,
) -> Result<String, D::Error> {
    let text = String::deserialize(deserializer)?;
    if text.chars().nth(letters_max).is_some() {
        let sentence = format!("{key} has more than {letters_max} letters");
        return Err(D::Error::custom(sentence));
    }
    if text.contains(char::is_control) {
        let sentence = format!("{key} is not one line of plain letters");
        return Err(D::Error::custom(sentence));
    }
    Ok(text)
}

/// A number of bytes.
pub(crate) fn garbage<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    let count = u32::deserialize(deserializer)?;
    if count > GARBAGE_BYTES {
        let sentence = format!("garbage = {count} is not from 0 to {GARBAGE_BYTES}");
        return Err(D::Error::custom(sentence));
    }
    Ok(count)
}

/// One number or several.
pub(crate) trait Ranged<'de>: Sized {
    fn read<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error>;

    fn numbers(&self) -> &[f64];
}

/// Reads a number. serde itself would say that it expected an `f64`.
struct NumberVisitor;

impl Visitor<'_> for NumberVisitor {
    type Value = f64;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a number")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
        Ok(value)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
        Ok(value as f64)
    }
}

impl<'de> Ranged<'de> for f64 {
    fn read<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_f64(NumberVisitor)
    }

    fn numbers(&self) -> &[f64] {
        std::slice::from_ref(self)
    }
}

impl<'de> Ranged<'de> for Option<f64> {
    fn read<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::deserialize(deserializer)
    }

    fn numbers(&self) -> &[f64] {
        self.as_slice()
    }
}

impl<'de, const N: usize> Ranged<'de> for [f64; N]
where
    Self: Deserialize<'de>,
{
    fn read<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::deserialize(deserializer)
    }

    fn numbers(&self) -> &[f64] {
        self
    }
}
