//! What is known of the leg, and recorded.

use super::SimulatedLeg;
use crate::errors::leg_error;
use crate::signal_log::SignalLog;
use crate::signals::NumericSignal;
use crate::telemetry::{self, numbers_as};
use crate::{arguments, named};
use leg_host::signals::Report;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

fn signal(argument: &str, name: &str) -> PyResult<NumericSignal> {
    NumericSignal::named(name).ok_or_else(|| {
        let sentence = format!("{argument} holds {name:?}, which is none; SIGNALS lists them");
        PyValueError::new_err(sentence)
    })
}

#[pymethods]
impl SimulatedLeg {
    /// How the leg really is: every signal of the mechanism, by name, and `time_s`.
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let session = self.session()?;
        let values = PyDict::new(py);
        if let Some(snapshot) = session.snapshot() {
            for signal in NumericSignal::all() {
                if let NumericSignal::Simulated(_) = signal {
                    let mut numbers = Vec::with_capacity(signal.width());
                    signal.read(&snapshot, &mut numbers);
                    values.set_item(signal.name(), numbers_as(py, numbers)?)?;
                }
            }
        }
        values.set_item("time_s", session.leg().time_s())?;
        Ok(values)
    }

    /// What the firmware reports: its signals by name, and `state`, `faults`, `homed` and `time_s`.
    fn telemetry<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let session = self.session()?;
        session.leg().telemetry().map_or_else(
            || Ok(PyDict::new(py)),
            |reported| {
                let report = Report::new(reported, session.constants());
                telemetry::dictionary(py, &report, reported.faults)
            },
        )
    }

    /// One signal of `SIGNALS` now: a number, or an array of three or two.
    fn read<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::name)] name: String,
    ) -> PyResult<Bound<'py, PyAny>> {
        let signal = signal("name", &name)?;
        let session = self.session()?;
        let mut numbers = Vec::with_capacity(signal.width());
        if let Some(snapshot) = session.snapshot() {
            signal.read(&snapshot, &mut numbers);
        }
        numbers_as(py, numbers)
    }

    /// Records signals from the next tick on, in whatever calls the ticks pass: 500 rows a second if left out.
    ///
    /// What was recorded before is forgotten.
    #[pyo3(signature = (signals, *, every_ticks = 16))]
    fn record(
        &self,
        #[pyo3(from_py_with = named::signals)] signals: Vec<String>,
        #[pyo3(from_py_with = named::every_ticks)] every_ticks: i128,
    ) -> PyResult<()> {
        let every_ticks = arguments::whole("every_ticks", every_ticks, 1..=u64::MAX)?;
        let found: PyResult<Vec<_>> = signals.iter().map(|name| signal("signals", name)).collect();
        let signal_log = SignalLog::new(&found?, every_ticks);
        self.session()?.record(Some(signal_log));
        Ok(())
    }

    /// What was recorded until now: `time_s`, and each signal as an array with a row for each time.
    fn recording<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let session = self.session()?;
        let Some(signal_log) = session.signal_log() else {
            return Err(leg_error("nothing is recorded; call record() first"));
        };
        let arrays = PyDict::new(py);
        arrays.set_item("time_s", PyArray1::from_slice(py, &signal_log.times_s))?;
        for (signal, numbers) in &signal_log.columns {
            let flat = PyArray1::from_slice(py, numbers);
            if signal.width() == 1 {
                arrays.set_item(signal.name(), flat)?;
            } else {
                let shape = [signal_log.times_s.len(), signal.width()];
                arrays.set_item(signal.name(), flat.reshape(shape)?)?;
            }
        }
        Ok(arrays)
    }
}
