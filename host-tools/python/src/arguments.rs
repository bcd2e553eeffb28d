//! Arguments from Python, each refused by its name.

use crate::interpreter::Call;
use crate::rig::Rig;
use leg_base::angles;
use leg_base::timed_path::{PathRow, TimedPath};
use leg_host::operator::Tensioning;
use leg_rig::rig_file::RigFile;
use leg_sim::action::Action;
use leg_sim::scenario::CommandStep;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyAttributeError, PyKeyboardInterrupt, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Longest time that is simulated by one call, s: a day.
const LONGEST_S: f64 = 86_400.0;

/// Most numbers of an array: they have to fit into memory.
const NUMBERS_MAX: usize = 100_000_000;

/// Most points of a path: three hours at 100 Hz.
const POINTS_MAX: usize = 1_000_000;

/// Levels of keys by which a value is named: a dictionary may hold itself.
const NAMED_LEVELS: usize = 8;

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

/// A dictionary as JSON. What cannot be is named by its keys.
pub fn to_json<'py>(name: &str, values: &Bound<'py, PyDict>) -> PyResult<String> {
    let _call = Call::begin(values.py())?;
    let json = values.py().import("json")?;
    let strict = PyDict::new(values.py());
    strict.set_item("allow_nan", false)?;
    // Numbers and arrays of numpy, as lists and numbers of Python.
    let operator = values.py().import("operator")?;
    strict.set_item(
        "default",
        operator.call_method1("methodcaller", ("tolist",))?,
    )?;
    let dumped = |value: &Bound<'py, PyAny>| json.call_method("dumps", (value,), Some(&strict));
    let mut value = values.clone().into_any();
    let mut error = match dumped(&value) {
        Ok(text) => return text.extract(),
        Err(error) => error,
    };
    let mut place = name.to_owned();
    for _ in 0..NAMED_LEVELS {
        let mut parts = parts(&value)?.into_iter();
        let failing = parts.find_map(|(key, part)| Some((key, dumped(&part).err()?, part)));
        let Some((key, of_part, part)) = failing else {
            break;
        };
        place = format!("{place}[{key}]");
        (value, error) = (part, of_part);
    }
    if let Ok(number) = value.extract() {
        finite(&place, number)?;
    }
    let sentence = if error.is_instance_of::<PyAttributeError>(values.py()) {
        format!("{place} cannot be JSON: it is {}", value.get_type())
    } else {
        format!("{place} cannot be JSON: {error}")
    };
    Err(PyValueError::new_err(sentence))
}

/// The values of a dictionary or a list, each with its key in Python's words; none of anything else.
fn parts<'py>(value: &Bound<'py, PyAny>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    if let Ok(values) = value.cast::<PyDict>() {
        let named = |(key, part): (Bound<'py, PyAny>, _)| Ok((key.repr()?.to_string(), part));
        return values.iter().map(named).collect();
    }
    let Ok(values) = value.cast::<PyList>() else {
        return Ok(Vec::new());
    };
    let numbered = |(index, part): (usize, _)| (index.to_string(), part);
    Ok(values.iter().enumerate().map(numbered).collect())
}

/// What a JSON text says, as Python has it.
pub fn loads<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    let _call = Call::begin(py)?;
    py.import("json")?.call_method1("loads", (text,))
}

/// The same of what can be written as JSON.
pub fn from_json<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value);
    loads(
        py,
        &text.map_err(|error| PyValueError::new_err(error.to_string()))?,
    )
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

/// Numbers in the order of an array, and its shape.
pub struct Numbers {
    /// Row by row.
    pub values: Vec<f64>,
    /// None for a single number.
    pub shape: Vec<usize>,
}

/// The shape that arguments have together, by numpy's rules.
pub fn common_shape(given: &[(&str, &Numbers)]) -> PyResult<Vec<usize>> {
    let mut common: Vec<usize> = Vec::new();
    for (name, numbers) in given {
        let shape = &numbers.shape;
        let length = common.len().max(shape.len());
        let from_end = |shape: &[usize], i: usize| {
            shape
                .len()
                .checked_sub(i + 1)
                .map_or(1, |place| shape[place])
        };
        let mut together = Vec::with_capacity(length);
        for i in (0..length).rev() {
            together.push(match (from_end(&common, i), from_end(shape, i)) {
                (a, b) if a == b => a,
                (1, b) => b,
                (a, 1) => a,
                _ => {
                    let sentence = format!(
                        "{name} has the shape {shape:?}, which does not go with {common:?} of those before it"
                    );
                    return Err(PyValueError::new_err(sentence));
                }
            });
        }
        common = together;
    }
    Ok(common)
}

/// The same numbers in a shape that goes with theirs.
pub fn broadcast(py: Python<'_>, numbers: Numbers, shape: &[usize]) -> PyResult<Vec<f64>> {
    if numbers.shape == shape {
        return Ok(numbers.values);
    }
    let numpy = py.import("numpy")?;
    let array = PyArray1::from_vec(py, numbers.values).reshape(numbers.shape)?;
    let wide = numpy.call_method1("broadcast_to", (array, shape.to_vec()))?;
    let wide = numpy.call_method1("ascontiguousarray", (wide,))?;
    Ok(wide.cast_into::<PyArrayDyn<f64>>()?.to_vec()?)
}

/// An array of finite numbers, with its shape; whatever numpy makes an array of.
pub fn numbers(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<Numbers> {
    let _call = Call::begin(argument.py())?;
    let numpy = argument.py().import("numpy")?;
    let no_numbers = |error: PyErr| {
        if error.is_instance_of::<PyKeyboardInterrupt>(argument.py()) {
            return error;
        }
        PyTypeError::new_err(format!("{name} is no array of numbers: {error}"))
    };
    let given = numpy.call_method1("asanyarray", (argument,));
    let given = given.map_err(no_numbers)?;
    require_real(name, &given)?;
    let size: usize = given.getattr("size")?.extract()?;
    if size > NUMBERS_MAX {
        let sentence = format!("{name} holds {size} numbers, more than {NUMBERS_MAX}");
        return Err(PyValueError::new_err(sentence));
    }
    // Not `ascontiguousarray`: that makes an array of a single number.
    let converted = numpy.call_method1("asarray", (given, "float64", "C"));
    let array = converted.map_err(no_numbers)?;
    let array = array.cast_into::<PyArrayDyn<f64>>();
    let array = array.map_err(|error| no_numbers(error.into()))?;
    let values = array.to_vec()?;
    if let Some(index) = values.iter().position(|value| !value.is_finite()) {
        let sentence = format!("{name} holds {} at index {index}", values[index]);
        return Err(PyValueError::new_err(sentence));
    }
    let shape = array.shape().to_vec();
    Ok(Numbers { values, shape })
}

/// The same, none of them below zero.
pub fn not_negative(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<Numbers> {
    let numbers = numbers(name, argument)?;
    match numbers.values.iter().position(|value| *value < 0.0) {
        None => Ok(numbers),
        Some(index) => Err(PyValueError::new_err(format!(
            "{name} holds {} at index {index}, which is below 0",
            numbers.values[index]
        ))),
    }
}

/// Finite numbers, one after the other.
pub fn list(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let Numbers { values, shape } = numbers(name, argument)?;
    if shape.len() != 1 {
        let sentence = format!("{name} has the shape {shape:?}, not (n,)");
        return Err(PyValueError::new_err(sentence));
    }
    Ok(values)
}

/// Refuses an array of what numpy would make real numbers of in silence: complex numbers, words, times, and numbers that are masked.
fn require_real(name: &str, array: &Bound<'_, PyAny>) -> PyResult<()> {
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    // Truth values, integers, floating-point numbers; objects, of which each says what number it is.
    if !["b", "i", "u", "f", "O"].contains(&kind.as_str()) {
        let sentence = format!("{name} is no array of numbers, but of {dtype}");
        return Err(PyTypeError::new_err(sentence));
    }
    let masks = array.py().import("numpy.ma")?;
    if masks.call_method1("is_masked", (array,))?.extract()? {
        let sentence = format!("{name} holds numbers that are masked; fill them in first");
        return Err(PyValueError::new_err(sentence));
    }
    Ok(())
}

/// A path: rows of time in s, azimuth and tilt in degrees.
pub fn path(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<TimedPath> {
    let Numbers { values, shape } = numbers(name, argument)?;
    let refuse = |what: String| Err(PyValueError::new_err(format!("{name} {what}")));
    if !matches!(shape[..], [2..=POINTS_MAX, 3]) {
        return refuse(format!(
            "has the shape {shape:?}, not (n, 3) with 2 to {POINTS_MAX} rows of time_s, azimuth_deg, tilt_deg"
        ));
    }
    let mut rows = Vec::with_capacity(shape[0]);
    let mut last_s = f64::NEG_INFINITY;
    for (index, row) in values.chunks_exact(3).enumerate() {
        let [time_s, azimuth_deg, tilt_deg] = [row[0], row[1], row[2]];
        if time_s <= last_s || time_s - values[0] > LONGEST_S {
            return refuse(format!(
                "has the time {time_s} s at index {index}, which is not after {last_s} s and within a day"
            ));
        }
        if azimuth_deg.abs() > 1e6 || tilt_deg.abs() > 90.0 {
            return refuse(format!(
                "leads to azimuth {azimuth_deg}°, tilt {tilt_deg}° at index {index}; a tilt is from -90 to 90"
            ));
        }
        last_s = time_s;
        rows.push(PathRow {
            time_s,
            direction: angles::direction(azimuth_deg, tilt_deg),
        });
    }
    Ok(TimedPath::new(&rows))
}
