//! What a leg reports, as Python has it.

use leg_base::description;
use leg_firmware::supervisor::FaultSet;
use leg_host::signals::{REPORT_SIGNALS, Report, Values};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The signals of a report by name. Of the faults it has not only the names.
pub fn dictionary<'py>(
    py: Python<'py>,
    report: &Report,
    reported: FaultSet,
) -> PyResult<Bound<'py, PyDict>> {
    let values = PyDict::new(py);
    for signal in REPORT_SIGNALS {
        let value = match signal.values {
            Values::Word(read) => read(report).into_pyobject(py)?.into_any(),
            Values::Flag(read) => read(report).into_pyobject(py)?.to_owned().into_any(),
            Values::Count(read) => read(report).into_pyobject(py)?.into_any(),
            Values::Names(_) => faults(py, reported)?.into_any(),
            Values::Number(_)
            | Values::Two(_)
            | Values::Three(_)
            | Values::Single(_)
            | Values::SingleTwo(_)
            | Values::SingleThree(_) => {
                let mut numbers = Vec::new();
                signal.numbers(report, &mut numbers);
                numbers_as(py, numbers)?
            }
        };
        values.set_item(signal.name, value)?;
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
pub fn numbers_as(py: Python<'_>, numbers: Vec<f64>) -> PyResult<Bound<'_, PyAny>> {
    match numbers[..] {
        [number] => Ok(number.into_pyobject(py)?.into_any()),
        _ => Ok(PyArray1::from_vec(py, numbers).into_any()),
    }
}
