//! Arguments of a kind, each refused by its name where it is of another: `#[pyo3(from_py_with = named::seed)]`.

use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt, PyString};
use std::any::type_name;

/// A function for each name.
macro_rules! named {
    ($($name:ident)*) => {
        $(
            pub fn $name<'py, T: FromPyObjectOwned<'py>>(given: &Bound<'py, PyAny>) -> PyResult<T> {
                extract(stringify!($name), given)
            }
        )*
    };
}

named! {
    action azimuth_deg azimuths can cell every_ticks fault for_s force_n interface kg l_upper_m
    lead_s leg leg_mass_kg load motor name newtons nm_per_rad nonlinear outputs over_s
    payload_kg port pressed pretension_n raises save seconds seed set signals silent slack
    stiffness_at stiffness_n_per_m stiffness_nm_per_rad support tendon text ticks tilt_deg tilts
    timeout_s towards_deg travel_mm values volts wait
}

fn extract<'py, T: FromPyObjectOwned<'py>>(name: &str, given: &Bound<'py, PyAny>) -> PyResult<T> {
    let py = given.py();
    if type_name::<T>().contains("f64") && is_complex(given)? {
        return Err(PyTypeError::new_err(format!("{name} is a complex number")));
    }
    given.extract().map_err(|error: T::Error| {
        let error = error.into();
        let sentence = if given.is_instance_of::<PyString>() && is_list::<T>() {
            format!("{name} is a word, not a list of words")
        } else {
            format!("{name}: {}", error.value(py))
        };
        if error.is_instance_of::<PyTypeError>(py) {
            PyTypeError::new_err(sentence)
        } else if error.is_instance_of::<PyOverflowError>(py) {
            PyValueError::new_err(format!("{name} is too large: {}", error.value(py)))
        } else if error.is_instance_of::<PyValueError>(py) {
            PyValueError::new_err(sentence)
        } else {
            // The given object's own, as Ctrl-C in the middle of it.
            error
        }
    })
}

fn is_list<T>() -> bool {
    type_name::<T>().contains("Vec<")
}

/// Whether it is a complex number, of which numpy would give the real part.
fn is_complex(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    if given.is_instance_of::<PyFloat>() || given.is_instance_of::<PyInt>() {
        return Ok(false);
    }
    let numpy = given.py().import("numpy")?;
    numpy.call_method1("iscomplexobj", (given,))?.extract()
}
