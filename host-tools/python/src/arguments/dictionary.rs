//! Dictionaries of Python as JSON, and JSON as Python has it.

use super::finite;
use crate::interpreter::Call;
use pyo3::exceptions::{PyAttributeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::Serialize;

/// Levels of keys by which a value is named: a dictionary may hold itself.
const NAMED_LEVELS: usize = 8;

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
