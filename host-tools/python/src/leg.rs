//! The class `Leg`: a leg on a serial port, or emulated in this process, commanded as by the command line.

use crate::arguments::{self, tensioning, within};
use crate::errors::{leg_error, leg_failure};
use crate::operator_thread::{LegFailure, OperatorThread, Place};
use crate::rig::Rig;
use crate::scope;
use crate::telemetry;
use leg_base::angles;
use leg_firmware::can::LegAddress;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_host::calibration::{KnownWeight, fit, mean_code, require_drivers_off, too_few_weights};
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{Goal, Operator, OperatorError, setting_differences};
use leg_host::sensor_report;
use leg_host::signals::{LegConstants, Report};
use leg_rig::{control_settings, settings_text};
use leg_sim::action::Action;
use leg_sim::emulated_leg::InitialState;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;
use std::sync::{Mutex, MutexGuard, OnceLock, TryLockError};
use std::thread;
use std::time::{Duration, SystemTime};

/// How long it takes until a thread that uses the leg is told again that another one stops it.
const TOLD_AGAIN: Duration = Duration::from_millis(1);

/// How a call has the leg for its thread alone.
type Lock = for<'leg> fn(
    &'leg Leg,
    &mut Option<PyErr>,
) -> PyResult<MutexGuard<'leg, Option<OperatorThread>>>;

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
        self.free_thread()?.ok_or_else(|| {
            leg_error(
                "another thread uses this leg; stop() is the only call that does not wait for it",
            )
        })
    }

    /// The same; none while another thread has it.
    fn free_thread(&self) -> PyResult<Option<MutexGuard<'_, Option<OperatorThread>>>> {
        match self.thread.try_lock() {
            Ok(thread) => Ok(Some(thread)),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Poisoned(_)) => Err(leg_error("this leg is lost; open it again")),
        }
    }

    /// Ends what another thread does with the leg, which is in hold then, and has the leg for this thread alone.
    ///
    /// The other thread may only be about to begin, and takes back then what was told to it before: it is told until it has ended.
    fn taken_over(
        &self,
        signal: &mut Option<PyErr>,
    ) -> PyResult<MutexGuard<'_, Option<OperatorThread>>> {
        loop {
            if let Some(thread) = self.free_thread()? {
                return Ok(thread);
            }
            self.cancel.set();
            if interrupted(signal) {
                return self.thread();
            }
            thread::sleep(TOLD_AGAIN);
        }
    }

    /// Lets the operator work while other threads of Python run. Ctrl-C ends it, and a driven leg is held then.
    fn ask<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError> + Send + 'static,
    ) -> PyResult<T> {
        self.with_thread(py, |thread, cancel, interrupted| {
            thread.ask(cancel, interrupted, work)
        })
    }

    fn with_thread<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(
            &OperatorThread,
            &CancelFlag,
            &mut dyn FnMut() -> bool,
        ) -> Result<T, LegFailure>
        + Send,
    ) -> PyResult<T> {
        self.with_locked(py, |leg, _| leg.thread(), work)
    }

    /// The same with the leg locked in one way or another, to which a signal of Python may come, too.
    fn with_locked<T: Send>(
        &self,
        py: Python<'_>,
        lock: Lock,
        work: impl FnOnce(
            &OperatorThread,
            &CancelFlag,
            &mut dyn FnMut() -> bool,
        ) -> Result<T, LegFailure>
        + Send,
    ) -> PyResult<T> {
        let mut signal = None;
        let result = py.detach(|| {
            let thread = lock(self, &mut signal)?;
            let Some(thread) = thread.as_ref() else {
                return Err(leg_error("this leg is closed; open it again"));
            };
            self.cancel.clear();
            let result = work(thread, &self.cancel, &mut || interrupted(&mut signal));
            result.map_err(leg_failure)
        });
        // It is raised even where the work came to its end meanwhile.
        signal.map_or(result, Err)
    }

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

/// The settings of a board that a rig gives.
fn settings_of(rig: &Bound<'_, PyAny>) -> PyResult<Settings> {
    let rig = match arguments::rig(Some(rig))? {
        Some(rig) => rig,
        None => Rig::load(None)?.file,
    };
    Ok(control_settings::settings(&rig, &rig.gains, None))
}

/// Replaces the settings of a leg, and keeps them over a reset if that is asked for.
fn set(operator: &mut Operator, settings: &Settings, save: bool) -> Result<(), OperatorError> {
    operator.set_settings(settings)?;
    if save {
        operator.save_settings()?;
    }
    Ok(())
}

/// Whether Python has a signal, as Ctrl-C; it is kept for later.
fn interrupted(signal: &mut Option<PyErr>) -> bool {
    if signal.is_none() {
        *signal = Python::attach(|py| py.check_signals().err());
        return signal.is_some();
    }
    false
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
        self.report(py, move |operator| operator.follow_whole(&path, lead))
    }

    fn hold<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.reach(py, Goal::default())
    }

    fn stop(&self, py: Python<'_>) -> PyResult<()> {
        let stopped = self.with_locked(py, Self::taken_over, |thread, cancel, interrupted| {
            thread.ask(cancel, interrupted, Operator::stop)
        });
        stopped.map(|_| ())
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
        self.with_thread(py, |thread, cancel, interrupted| {
            thread.disturb(cancel, interrupted, action)
        })
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
        let given = settings_of(rig)?;
        let found = setting_differences(&given, &self.ask(py, Operator::settings)?);
        let rows = found.iter().map(|difference| {
            json!({ "name": difference.name, "rig": difference.ours, "leg": difference.theirs })
        });
        arguments::from_json(py, &rows.collect::<Vec<_>>())
    }

    #[pyo3(signature = (rig, *, save = false))]
    fn set_settings(&self, py: Python<'_>, rig: &Bound<'_, PyAny>, save: bool) -> PyResult<()> {
        let settings = settings_of(rig)?;
        self.ask(py, move |operator| set(operator, &settings, save))
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
        let mut cells = [1_u8, 2, 3].into_iter().enumerate();
        let found = cells.find(|(_, number)| i64::from(*number) == cell);
        let (axis, number) = found
            .ok_or_else(|| PyValueError::new_err(format!("cell = {cell} is none of 1 to 3")))?;
        if save && !set {
            return Err(PyValueError::new_err("save is given without set"));
        }
        let refused = |failure| leg_failure(LegFailure::Refused(failure));
        for kg in &weights_kg {
            within("weights_kg", *kg, 0.0, 1e3)?;
        }
        if weights_kg.iter().all(|kg| Some(kg) == weights_kg.first()) {
            return Err(refused(too_few_weights()));
        }
        let off = self.ask(py, |operator| {
            Ok(require_drivers_off(
                operator,
                "let weights be hung on its cells",
            ))
        })?;
        off.map_err(refused)?;
        let mut settings = self.ask(py, Operator::settings)?;
        let gravity = f64::from(settings.rig.gravity_m_per_s2);
        let mut weighings = Vec::new();
        for kg in weights_kg {
            hang.call1((kg,))?;
            let newtons = kg * gravity;
            let code = self.ask(py, move |operator| mean_code(operator, axis))?;
            weighings.push(KnownWeight { newtons, code });
        }
        let fit = fit(&weighings).map_err(refused)?;
        fit.require_straight(number, &weighings).map_err(refused)?;
        if set {
            settings.axes[axis].cell_n_per_code = fit.n_per_code as f32;
            settings.axes[axis].cell_zero_code = fit.zero_code as f32;
            let settings = settings.without_zero();
            self.ask(py, move |operator| self::set(operator, &settings, save))?;
        }
        arguments::from_json(py, &fit)
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
