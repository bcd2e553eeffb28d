//! Arguments from Python, each refused by its name.

mod array;
mod dictionary;
mod path;

pub use array::{Numbers, broadcast, common_shape, list, not_negative, numbers};
pub use dictionary::{from_json, loads, to_json};
pub use path::{TensionArguments, path};

use crate::rig::Rig;
use leg_base::angles;
use leg_host::operator::Tensioning;
use leg_rig::rig_file::RigFile;
use leg_sim::action::Action;
use leg_sim::scenario::CommandStep;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Longest time that is simulated by one call, s: a day.
const LONGEST_S: f64 = 86_400.0;

/// A finite number.
pub fn finite(name: &str, value: f64) -> PyResult<f64> {
    bounded(name, value, f64::MIN, f64::MAX)
}

/// A finite number in a range.
pub fn bounded(name: &str, value: f64, low: f64, high: f64) -> PyResult<f64> {
    if !value.is_finite() {
        let sentence = format!("{name} = {value} is not a finite number");
        return Err(PyValueError::new_err(sentence));
    }
    if !(low..=high).contains(&value) {
        let sentence = format!("{name} = {value} is not from {low} to {high}");
        return Err(PyValueError::new_err(sentence));
    }
    Ok(value)
}

/// A time to simulate, s.
pub fn time_s(name: &str, value: f64) -> PyResult<f64> {
    bounded(name, value, 0.0, LONGEST_S)
}

/// A whole number in a range.
pub fn whole<T>(name: &str, value: i128, range: RangeInclusive<T>) -> PyResult<T>
where
    T: Copy + Display + PartialOrd + TryFrom<i128>,
{
    let fitting = T::try_from(value).ok();
    fitting
        .filter(|value| range.contains(value))
        .ok_or_else(|| {
            let (least, most) = (range.start(), range.end());
            PyValueError::new_err(format!("{name} = {value} is not from {least} to {most}"))
        })
}

/// The place of a tendon, a motor or a load cell, from 1, in an array.
pub fn place(name: &str, number: i128) -> PyResult<usize> {
    let mut places = (1..=3).zip(0..);
    let found = places.find(|(known, _)| *known == number);
    let none = || PyValueError::new_err(format!("{name} = {number} is none of 1, 2 and 3"));
    found.map(|(_, place)| place).ok_or_else(none)
}

/// What can fail, with the tendon where it is one's, from 1.
fn defect(name: &str, tendon: Option<i128>) -> PyResult<Value> {
    let known = leg_sim::plant::Defect::descriptions().any(|(known, _)| known == name);
    if !known {
        let sentence = format!("fault = {name:?} is no defect; DEFECTS lists them");
        return Err(PyValueError::new_err(sentence));
    }
    let mut all = leg_sim::plant::Defect::all();
    let of_leg = all.any(|defect| serde_json::to_value(defect).ok().as_ref() == Some(&json!(name)));
    match (of_leg, tendon) {
        (true, Some(_)) => Err(PyValueError::new_err(format!(
            "tendon is given, but {name} is a defect of the whole leg"
        ))),
        (false, None) => Err(PyValueError::new_err(format!(
            "tendon is not given: {name} is a defect of tendon 1, 2 or 3"
        ))),
        (false, Some(number)) => Ok(json!({ name: place("tendon", number)? + 1 })),
        (true, None) => Ok(json!(name)),
    }
}

/// A defect that begins or ends.
pub fn defect_action(action: &str, name: &str, tendon: Option<i128>) -> PyResult<Action> {
    read(&json!({ action: defect(name, tendon)? }))
}

/// What is done to the leg from outside, its numbers checked as those of a scenario.
pub fn action(name: &str, numbers: &[(&str, f64)]) -> PyResult<Action> {
    read(&with_numbers(name, numbers)?)
}

/// A command, its numbers checked as those of a scenario.
pub fn command(name: &str, numbers: &[(&str, f64)]) -> PyResult<CommandStep> {
    read(&with_numbers(name, numbers)?)
}

/// A command or an action with words.
pub fn read<T: DeserializeOwned>(value: &Value) -> PyResult<T> {
    T::deserialize(value).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// What the tendons shall be tensioned to.
pub fn tensioning(
    pretension_n: Option<f64>,
    stiffness_nm_per_rad: Option<f64>,
    towards_deg: Option<f64>,
) -> PyResult<Option<Tensioning>> {
    let tensioning = match (pretension_n, stiffness_nm_per_rad) {
        (Some(_), Some(_)) => {
            return Err(PyValueError::new_err(
                "pretension_n and stiffness_nm_per_rad are given; give one of them",
            ));
        }
        (Some(n), None) => Some(Tensioning::Pretension(
            bounded("pretension_n", n, 0.0, 1e9)? as f32,
        )),
        (None, Some(demand)) => {
            let demand = bounded("stiffness_nm_per_rad", demand, 0.0, 1e9)?;
            let azimuth = towards_deg.map(|deg| bounded("towards_deg", deg, -3600.0, 3600.0));
            let towards = azimuth.transpose()?.map(angles::unit_vector);
            Some(Tensioning::Stiffness {
                demand_nm_per_rad: demand as f32,
                towards: towards.map(|towards| towards.map(|component| component as f32)),
            })
        }
        (None, None) => None,
    };
    match (&tensioning, towards_deg) {
        (None | Some(Tensioning::Pretension(_)), Some(_)) => Err(PyValueError::new_err(
            "towards_deg is given without stiffness_nm_per_rad",
        )),
        _ => Ok(tensioning),
    }
}

fn with_numbers(name: &str, numbers: &[(&str, f64)]) -> PyResult<Value> {
    let mut entries = serde_json::Map::new();
    for (key, value) in numbers {
        entries.insert((*key).into(), json!(finite(key, *value)?));
    }
    Ok(json!({ name: entries }))
}

/// What can be called.
pub fn callable(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<()> {
    if argument.is_callable() {
        return Ok(());
    }
    let kind = argument.get_type();
    Err(PyTypeError::new_err(format!(
        "{name} cannot be called: it is {kind}"
    )))
}

/// A name or a path of a file.
pub fn path_of(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<PathBuf> {
    let no_path = |_| PyTypeError::new_err(format!("{name} is no name and no path of a file"));
    argument.extract().map_err(no_path)
}

/// A `Rig`, or that of a name or a file; none stays none.
pub fn rig(argument: Option<&Bound<'_, PyAny>>) -> PyResult<Option<RigFile>> {
    let Some(argument) = argument else {
        return Ok(None);
    };
    if let Ok(rig) = argument.cast::<Rig>() {
        return Ok(Some(rig.get().file));
    }
    Ok(Some(Rig::load(Some(&path_of("rig", argument)?))?.file))
}

/// The same; the paper's rig where none is given.
pub fn rig_or_default(argument: Option<&Bound<'_, PyAny>>) -> PyResult<RigFile> {
    match rig(argument)? {
        Some(rig) => Ok(rig),
        None => Ok(Rig::load(None)?.file),
    }
}
