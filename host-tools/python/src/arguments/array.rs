//! Arrays of numbers.

use crate::interpreter::Call;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyKeyboardInterrupt, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// Most numbers of an array: they have to fit into memory.
const NUMBERS_MAX: usize = 100_000_000;

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
