//! The class `Leg`: a leg on a serial port, or emulated in this process, commanded as by the command line.

mod access;
mod calibration;
mod settings;

use crate::arguments::{self, bounded, tensioning};
use crate::errors::leg_error;
use crate::operator_thread::{OperatorThread, Place};
use crate::rig::Rig;
use crate::scope;
use crate::telemetry;
use calibration::Keep;
use leg_base::angles;
use leg_firmware::can::LegAddress;
use leg_firmware::telemetry::Telemetry;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{Goal, Operator, OperatorError, setting_differences};
use leg_host::sensor_report;
use leg_host::signals::{LegConstants, Report};
use leg_rig::settings_text;
use leg_sim::action::Action;
use leg_sim::emulated_leg::InitialState;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, SystemTime};

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
    fn reach<'py>(&self, py: Python<'py>, goal: Goal) -> PyResult<Bound<'py, PyDict>> {
        self.report(py, move |operator| operator.reach(&goal))
    }

    /// What the leg reports at the end of some work, with what is known of it here.
    fn report<'py>(
        &self,
        py: Python<'py>,
        work: impl FnOnce(&mut Operator) -> Result<Telemetry<f32>, OperatorError> + Send + 'static,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (telemetry, wall_time_s, damaged_frames) = self.ask(py, |operator| {
            let telemetry = work(operator)?;
            Ok((telemetry, wall_time_s(operator), operator.damaged_frames()))
        })?;
        let constants = self.constants.get();
        let constants = constants.ok_or_else(|| leg_error("this leg was not opened"))?;
        let report = Report::new(&telemetry, constants).received(wall_time_s, damaged_frames);
        telemetry::dictionary(py, &report, telemetry.faults)
    }
}

/// The time of the day, s since 1970; not a number beside a leg whose time is emulated.
fn wall_time_s(operator: &Operator) -> f64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    let known = since.ok().filter(|_| !operator.clock_is_emulated());
    known.map_or(f64::NAN, |since| since.as_secs_f64())
}

#[pymethods]
impl Leg {
    #[staticmethod]
    #[pyo3(signature = (port = None))]
    fn open(py: Python<'_>, port: Option<String>) -> PyResult<Self> {
        Self::opened(py, Place::Port(port))
    }

    #[staticmethod]
    #[pyo3(signature = (interface, leg = 1))]
    fn can(py: Python<'_>, interface: String, leg: i64) -> PyResult<Self> {
        let address = u8::try_from(leg).ok().and_then(LegAddress::new);
        let address = address
            .ok_or_else(|| PyValueError::new_err(format!("leg = {leg} is none of 1 to 6")))?;
        Self::opened(py, Place::Can(interface, address))
    }

    #[staticmethod]
    #[pyo3(signature = (rig = None, *, slack = false))]
    fn emulated(py: Python<'_>, rig: Option<&Bound<'_, PyAny>>, slack: bool) -> PyResult<Self> {
        let rig = arguments::rig_or_default(rig)?;
        let initial = if slack {
            InitialState::Slack
        } else {
            InitialState::Homed
        };
        Self::opened(py, Place::Emulated(Box::new(rig), initial))
    }

    fn home<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.report(py, Operator::home)
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
        let azimuth_deg = bounded("azimuth_deg", azimuth_deg, -3600.0, 3600.0)?;
        let tilt_deg = bounded("tilt_deg", tilt_deg, -90.0, 90.0)?;
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
        let nm_per_rad = bounded("nm_per_rad", nm_per_rad, 0.0, 1e9)?;
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
        let lead = Duration::from_secs_f64(bounded("lead_s", lead_s, 0.0, 10.0)?);
        self.report(py, move |operator| operator.follow_whole(&path, lead))
    }

    fn hold<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.reach(py, Goal::default())
    }

    fn stop(&self, py: Python<'_>) -> PyResult<()> {
        self.ask_at_once(py, Operator::stop).map(|_| ())
    }

    fn disarm(&self, py: Python<'_>) -> PyResult<()> {
        self.ask(py, Operator::disarm)
    }

    fn clear(&self, py: Python<'_>) -> PyResult<()> {
        self.ask(py, Operator::clear)
    }

    fn telemetry<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.report(py, |operator| Ok(operator.telemetry()?.telemetry))
    }

    fn scope<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let scope = self.ask(py, Operator::scope)?;
        scope::arrays(py, &scope)
    }

    fn sensors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let both = self.ask(py, |operator| {
            Ok((operator.sensors()?, operator.settings()?))
        })?;
        arguments::from_json(py, &sensor_report::json(&both.0, &both.1))
    }

    fn wait(&self, py: Python<'_>, seconds: f64) -> PyResult<()> {
        let time = Duration::from_secs_f64(arguments::time_s("seconds", seconds)?);
        self.ask(py, move |operator| operator.pause(time))
    }

    fn disturb(&self, py: Python<'_>, action: &Bound<'_, PyDict>) -> PyResult<()> {
        let text = arguments::to_json("action", action)?;
        let action = Action::parse(&text).map_err(|error| {
            let list = "`leg emulate --help` lists the disturbances";
            PyValueError::new_err(format!("action = {text}: {error}; {list}"))
        })?;
        self.call(py, |call| call.disturb(action))
    }

    fn settings(&self, py: Python<'_>) -> PyResult<Rig> {
        let settings = self.ask(py, Operator::settings)?;
        Rig::read_text("the leg's settings", settings_text::rig_file(&settings))
    }

    fn settings_differences<'py>(
        &self,
        py: Python<'py>,
        rig: &Bound<'_, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = settings::of_rig(rig)?;
        let found = setting_differences(&given, &self.ask(py, Operator::settings)?);
        let rows = found.iter().map(|difference| {
            json!({ "name": difference.name, "rig": difference.ours, "leg": difference.theirs })
        });
        arguments::from_json(py, &rows.collect::<Vec<_>>())
    }

    #[pyo3(signature = (rig, *, save = false))]
    fn set_settings(&self, py: Python<'_>, rig: &Bound<'_, PyAny>, save: bool) -> PyResult<()> {
        let settings = settings::of_rig(rig)?;
        self.ask(py, move |operator| settings::set(operator, &settings, save))
    }

    #[pyo3(signature = (cell, weights_kg, hang, *, set = false, save = false))]
    fn calibrate_cell<'py>(
        &self,
        py: Python<'py>,
        cell: i64,
        weights_kg: Vec<f64>,
        hang: &Bound<'_, PyAny>,
        set: bool,
        save: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let keep = Keep { set, save };
        let fit = calibration::cell(self, py, cell, weights_kg, hang, keep)?;
        arguments::from_json(py, &fit)
    }

    #[pyo3(signature = (turn, rig = None))]
    fn calibrate_motors<'py>(
        &self,
        py: Python<'py>,
        turn: &Bound<'_, PyAny>,
        rig: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rig = arguments::rig_or_default(rig)?;
        arguments::from_json(py, &calibration::motors(self, py, turn, &rig)?)
    }

    #[pyo3(signature = (motor, travel_mm, *, volts = None))]
    fn jog<'py>(
        &self,
        py: Python<'py>,
        motor: i64,
        travel_mm: f64,
        volts: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let seen = calibration::jog(self, py, motor, travel_mm, volts)?;
        arguments::from_json(py, &seen)
    }

    fn close(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| {
            if let Some(thread) = self.owned()?.take() {
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
