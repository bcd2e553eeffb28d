//! What a leg reports, as Python has it.

use crate::signals::{SIGNALS, Signal};
use leg_base::description;
use leg_base::tick_time::seconds;
use leg_firmware::supervisor::FaultSet;
use leg_firmware::telemetry::Telemetry;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Every signal of telemetry by name, with the state, the faults, whether the zero is known, and the time of the leg.
pub fn dictionary<'py>(
    py: Python<'py>,
    telemetry: &Telemetry<f32>,
) -> PyResult<Bound<'py, PyDict>> {
    let values = PyDict::new(py);
    values.set_item("time_s", seconds(telemetry.tick.into()))?;
    values.set_item("state", description::state(telemetry.state))?;
    values.set_item("faults", faults(py, telemetry.faults)?)?;
    values.set_item("homed", telemetry.homed)?;
    for signal in SIGNALS {
        if let Some(numbers) = signal.reported(telemetry) {
            values.set_item(signal.name, numbers_as(py, signal, numbers)?)?;
        }
    }
    Ok(values)
}

/// The rows of the fault table of some faults.
pub fn faults(py: Python<'_>, reported: FaultSet) -> PyResult<Bound<'_, PyList>> {
    let faults = PyList::empty(py);
    for fault in reported.faults() {
        let entry = fault.entry();
        let row = PyDict::new(py);
        row.set_item("code", fault.code())?;
        row.set_item("name", entry.name)?;
        row.set_item("cause", entry.cause)?;
        row.set_item("remedy", entry.remedy)?;
        row.set_item("reaction", description::reaction(entry.reaction))?;
        faults.append(row)?;
    }
    Ok(faults)
}

/// One number as a float, several as an array.
pub fn numbers_as<'py>(
    py: Python<'py>,
    signal: &Signal,
    numbers: Vec<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    match numbers[..] {
        [number] if signal.width == 1 => Ok(number.into_pyobject(py)?.into_any()),
        _ => Ok(PyArray1::from_vec(py, numbers).into_any()),
    }
}
