//! The class `Leg`: a leg on a serial port, or emulated in this process, commanded as by the command line.

use crate::arguments::{self, within};
use crate::errors::{leg_error, leg_failure};
use crate::operator_thread::{LegFailure, OperatorThread, Place};
use crate::rig::Rig;
use crate::telemetry;
use leg_base::angles;
use leg_firmware::telemetry::Telemetry;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{Goal, Operator, OperatorError, Tensioning};
use leg_host::signals::LegConstants;
use leg_sim::emulated_leg::InitialState;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, MutexGuard, OnceLock, TryLockError};
use std::time::Duration;

/// See `_native.pyi`.
#[pyclass(frozen, module = "tendon_leg")]
pub struct Leg {
    /// None once it is closed.
    thread: Mutex<Option<OperatorThread>>,
    cancel: CancelFlag,
    /// What its reports need of its settings; asked for when it is opened.
    constants: OnceLock<LegConstants>,
}

impl Leg {
    fn opened(py: Python<'_>, place: Place) -> PyResult<Self> {
        let cancel = CancelFlag::default();
        let mut signal = None;
        let thread =
            py.detach(|| OperatorThread::open(place, &cancel, || interrupted(&mut signal)));
        if let Some(signal) = signal {
            return Err(signal);
        }
        let leg = Self {
            thread: Mutex::new(Some(thread.map_err(leg_failure)?)),
            cancel,
            constants: OnceLock::new(),
        };
        let settings = leg.ask(py, Operator::settings)?;
        leg.constants.get_or_init(|| LegConstants::new(&settings));
        Ok(leg)
    }

    /// The leg for this thread alone.
    fn thread(&self) -> PyResult<MutexGuard<'_, Option<OperatorThread>>> {
        self.thread.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => leg_error(
                "another thread uses this leg; stop() is the only call that does not wait for it",
            ),
            TryLockError::Poisoned(_) => leg_error("this leg is lost; open it again"),
        })
    }

    /// Lets the operator work while other threads of Python run. Ctrl-C ends it, and a driven leg is held then.
    fn ask<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError> + Send + 'static,
    ) -> PyResult<T> {
        let mut signal = None;
        let result = py.detach(|| {
            let thread = self.thread()?;
            let Some(thread) = thread.as_ref() else {
                return Err(leg_error("this leg is closed; open it again"));
            };
            self.cancel.clear();
            Ok(thread.ask(&self.cancel, || interrupted(&mut signal), work))
        })?;
        match (result, signal) {
            (Err(LegFailure::Operator(error, _)), Some(signal))
                if matches!(*error, OperatorError::Cancelled) =>
            {
                Err(signal)
            }
            (result, _) => result.map_err(leg_failure),
        }
    }

    fn reach<'py>(&self, py: Python<'py>, goal: Goal) -> PyResult<Bound<'py, PyDict>> {
        let reached = self.ask(py, move |operator| operator.reach(&goal))?;
        self.report(py, &reached)
    }

    fn report<'py>(
        &self,
        py: Python<'py>,
        telemetry: &Telemetry<f32>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let constants = self.constants.get();
        let constants = constants.ok_or_else(|| leg_error("this leg was not opened"))?;
        telemetry::dictionary(py, telemetry, constants)
    }
}

/// Whether Python has a signal, as Ctrl-C; it is kept for later.
fn interrupted(signal: &mut Option<PyErr>) -> bool {
    if signal.is_none() {
        *signal = Python::attach(|py| py.check_signals().err());
        return signal.is_some();
    }
    false
}

/// What the tendons shall be tensioned to.
fn tensioning(
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
            within("pretension_n", n, 0.0, 1e9)? as f32
        )),
        (None, Some(demand)) => {
            let demand = within("stiffness_nm_per_rad", demand, 0.0, 1e9)?;
            let azimuth = towards_deg.map(|deg| within("towards_deg", deg, -3600.0, 3600.0));
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

#[pymethods]
impl Leg {
    #[staticmethod]
    #[pyo3(signature = (port = None))]
    fn open(py: Python<'_>, port: Option<String>) -> PyResult<Self> {
        Self::opened(py, Place::Port(port))
    }

    #[staticmethod]
    #[pyo3(signature = (rig = None, *, slack = false))]
    fn emulated(py: Python<'_>, rig: Option<&Bound<'_, PyAny>>, slack: bool) -> PyResult<Self> {
        let rig = match arguments::rig(rig)? {
            Some(rig) => rig,
            None => Rig::load(None)?.file,
        };
        let initial = if slack {
            InitialState::Slack
        } else {
            InitialState::Homed
        };
        Self::opened(py, Place::Emulated(Box::new(rig), initial))
    }

    fn home<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let homed = self.ask(py, Operator::home)?;
        self.report(py, &homed)
    }

    #[pyo3(name = "move", signature = (azimuth_deg, tilt_deg, *, pretension_n = None, stiffness_nm_per_rad = None, towards_deg = None))]
    fn move_to<'py>(
        &self,
        py: Python<'py>,
        azimuth_deg: f64,
        tilt_deg: f64,
        pretension_n: Option<f64>,
        stiffness_nm_per_rad: Option<f64>,
        towards_deg: Option<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let azimuth_deg = within("azimuth_deg", azimuth_deg, -3600.0, 3600.0)?;
        let tilt_deg = within("tilt_deg", tilt_deg, -90.0, 90.0)?;
        let direction = angles::direction(azimuth_deg, tilt_deg);
        let goal = Goal {
            tensioning: tensioning(pretension_n, stiffness_nm_per_rad, towards_deg)?,
            direction: Some(direction.map(|component| component as f32)),
        };
        self.reach(py, goal)
    }

    #[pyo3(signature = (nm_per_rad, towards_deg = None))]
    fn stiffness<'py>(
        &self,
        py: Python<'py>,
        nm_per_rad: f64,
        towards_deg: Option<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let nm_per_rad = within("nm_per_rad", nm_per_rad, 0.0, 1e9)?;
        let goal = Goal {
            tensioning: tensioning(None, Some(nm_per_rad), towards_deg)?,
            direction: None,
        };
        self.reach(py, goal)
    }

    #[pyo3(signature = (points, *, lead_s = 0.2))]
    fn follow<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'_, PyAny>,
        lead_s: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let path = arguments::path("points", points)?;
        let lead = Duration::from_secs_f64(within("lead_s", lead_s, 0.0, 10.0)?);
        let followed = self.ask(py, move |operator| operator.follow_whole(&path, lead))?;
        self.report(py, &followed)
    }

    fn hold<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.reach(py, Goal::default())
    }

    fn stop(&self, py: Python<'_>) -> PyResult<()> {
        match self.thread.try_lock() {
            // What another thread does ends with the leg in hold.
            Err(TryLockError::WouldBlock) => {
                self.cancel.set();
                Ok(())
            }
            free => {
                drop(free);
                self.ask(py, Operator::stop).map(|_| ())
            }
        }
    }

    fn disarm(&self, py: Python<'_>) -> PyResult<()> {
        self.ask(py, Operator::disarm)
    }

    fn clear(&self, py: Python<'_>) -> PyResult<()> {
        self.ask(py, Operator::clear)
    }

    fn telemetry<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let report = self.ask(py, Operator::telemetry)?;
        self.report(py, &report.telemetry)
    }

    fn close(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| {
            if let Some(thread) = self.thread()?.take() {
                thread.close();
            }
            Ok(())
        })
    }

    fn __enter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&self, py: Python<'_>, _exception: &Bound<'_, PyAny>) -> PyResult<()> {
        self.close(py)
    }
}
