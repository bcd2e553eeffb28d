//! What a board's recorder held, as Python has it.

use leg_host::operator::Scope;
use leg_host::signals::RECORDER_SIGNALS;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The signals that were recorded, each as an array with a row for each tick, and the faults that have ended the recording.
pub fn arrays<'py>(py: Python<'py>, scope: &Scope) -> PyResult<Bound<'py, PyDict>> {
    let arrays = PyDict::new(py);
    for signal in RECORDER_SIGNALS {
        let Some(width) = signal.width() else {
            continue;
        };
        let mut numbers = Vec::with_capacity(width * scope.rows.len());
        for row in &scope.rows {
            signal.numbers(row, &mut numbers);
        }
        if numbers.iter().all(|number| number.is_nan()) {
            continue;
        }
        let flat = PyArray1::from_vec(py, numbers);
        if width == 1 {
            arrays.set_item(signal.name, flat)?;
        } else {
            arrays.set_item(signal.name, flat.reshape([scope.rows.len(), width])?)?;
        }
    }
    if let Some(fault) = scope.report.fault {
        let names: Vec<_> = fault
            .faults
            .faults()
            .map(|each| each.entry().name)
            .collect();
        arrays.set_item("fault_names", names)?;
    }
    Ok(arrays)
}
