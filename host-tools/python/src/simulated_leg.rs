//! The class `SimulatedLeg`: its methods check their arguments and hand them to a [`Session`], without the interpreter's lock.

use crate::arguments::{self, bounded, time_s};
use crate::errors::leg_error;
use crate::rig::Rig;
use crate::session::{Session, SessionError};
use crate::signal_log::SignalLog;
use crate::signals::NumericSignal;
use crate::start;
use crate::telemetry::{self, numbers_as};
use leg_base::description;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::State;
use leg_host::signals::Report;
use leg_sim::action::Action;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::json;
use std::sync::{Mutex, MutexGuard, TryLockError};

/// Longest homing, longest move and longest relaxing with all that belongs to them, s: those of the command line.
const HOMING_S: f64 = 120.0;
const MOVE_S: f64 = 60.0;

/// Most ticks of one step: a day.
const TICKS_MAX: u64 = 86_400 * TICK_HZ as u64;

/// Ticks in a time, to the nearest.
fn ticks(seconds: f64) -> u64 {
    (seconds * f64::from(TICK_HZ)).round() as u64
}

/// See `_native.pyi`.
#[pyclass(frozen, module = "tendon_leg")]
pub struct SimulatedLeg(Mutex<Session>);

impl SimulatedLeg {
    /// The leg for this thread alone.
    fn session(&self) -> PyResult<MutexGuard<'_, Session>> {
        self.0.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => leg_error(
                "another thread uses this leg; let one thread step it, or clone() it before",
            ),
            TryLockError::Poisoned(_) => {
                leg_error("this leg is lost: a call on it failed in the middle of a tick")
            }
        })
    }

    /// Works with the leg while other threads of Python run.
    fn work<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Session) -> Result<T, SessionError> + Send,
    ) -> PyResult<T> {
        py.detach(|| Ok(work(&mut *self.session()?)?))
    }

    fn act(&self, action: &Action) -> PyResult<()> {
        let mut session = self.session()?;
        action.apply(session.leg_mut().leg_mut().plant_mut());
        Ok(())
    }

    /// Commands the leg, and waits for the end of that unless it shall not.
    fn settled(&self, py: Python<'_>, command: Command, waits: bool) -> PyResult<()> {
        self.work(py, |session| {
            session.command(&command)?;
            if waits {
                session.settle(MOVE_S)
            } else {
                Ok(())
            }
        })
    }
}

/// Fails on Ctrl-C.
fn interrupted() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}

fn signal(name: &str) -> PyResult<NumericSignal> {
    NumericSignal::named(name).ok_or_else(|| {
        let sentence = format!("signals holds {name:?}, which is none; SIGNALS lists them");
        PyValueError::new_err(sentence)
    })
}

#[pymethods]
impl SimulatedLeg {
    #[new]
    #[pyo3(signature = (rig = None, *, seed = 0, slack = false, azimuth_deg = 0.0, tilt_deg = 0.0, payload_kg = 0.0, pretension_n = None))]
    #[allow(clippy::too_many_arguments, reason = "they have names in Python")]
    fn new(
        rig: Option<&Bound<'_, PyAny>>,
        seed: u64,
        slack: bool,
        azimuth_deg: f64,
        tilt_deg: f64,
        payload_kg: f64,
        pretension_n: Option<f64>,
    ) -> PyResult<Self> {
        let rig = match arguments::rig(rig)? {
            Some(rig) => rig,
            None => Rig::load(None)?.file,
        };
        let pose = [azimuth_deg, tilt_deg, payload_kg];
        let start = start::start(&rig, slack, pose, pretension_n)?;
        Ok(Self(Mutex::new(Session::new(
            &rig,
            start,
            seed,
            interrupted,
        )?)))
    }

    #[getter]
    fn time_s(&self) -> PyResult<f64> {
        Ok(self.session()?.leg().time_s())
    }

    #[getter]
    fn ticks(&self) -> PyResult<u64> {
        Ok(self.session()?.leg().ticks())
    }

    #[getter]
    fn state(&self) -> PyResult<&'static str> {
        Ok(description::state(self.session()?.leg().state()))
    }

    #[getter]
    fn following(&self) -> PyResult<bool> {
        Ok(self.session()?.following())
    }

    #[getter]
    fn faults<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        telemetry::faults(py, self.session()?.reported())
    }

    #[pyo3(signature = (ticks = 8))]
    fn step(&self, py: Python<'_>, ticks: i64) -> PyResult<()> {
        let count = u64::try_from(ticks)
            .ok()
            .filter(|count| *count <= TICKS_MAX);
        let Some(count) = count else {
            let sentence = format!("ticks = {ticks} is not from 0 to {TICKS_MAX}");
            return Err(PyValueError::new_err(sentence));
        };
        self.work(py, |session| session.step(count))
    }

    fn run(&self, py: Python<'_>, seconds: f64) -> PyResult<()> {
        let count = ticks(time_s("seconds", seconds)?);
        self.work(py, |session| session.step(count))
    }

    #[pyo3(signature = (timeout_s = 60.0))]
    fn wait(&self, py: Python<'_>, timeout_s: f64) -> PyResult<()> {
        let timeout_s = time_s("timeout_s", timeout_s)?;
        self.work(py, |session| session.settle(timeout_s))
    }

    #[pyo3(signature = (*, wait = true))]
    fn arm(&self, py: Python<'_>, wait: bool) -> PyResult<()> {
        self.settled(py, Command::Arm, wait)
    }

    #[pyo3(signature = (*, wait = true))]
    fn home(&self, py: Python<'_>, wait: bool) -> PyResult<()> {
        self.work(py, |session| {
            session.command(&Command::Home)?;
            if wait {
                session.reach(State::Active, "find its zero", HOMING_S)?;
                session.settle(MOVE_S)?;
            }
            Ok(())
        })
    }

    #[pyo3(name = "move", signature = (azimuth_deg, tilt_deg, *, wait = true))]
    fn move_to(&self, py: Python<'_>, azimuth_deg: f64, tilt_deg: f64, wait: bool) -> PyResult<()> {
        let numbers = [("azimuth_deg", azimuth_deg), ("tilt_deg", tilt_deg)];
        let command = arguments::command("move", &numbers)?.command();
        self.settled(py, command, wait)
    }

    #[pyo3(signature = (points, *, wait = true))]
    fn follow(&self, py: Python<'_>, points: &Bound<'_, PyAny>, wait: bool) -> PyResult<()> {
        let path = arguments::path("points", points)?;
        let lasts_s = path.points().last().map_or(0.0, |last| last.time_s);
        self.work(py, |session| {
            session.follow(path)?;
            if wait {
                session.settle(lasts_s + 2.0 * MOVE_S)
            } else {
                Ok(())
            }
        })
    }

    #[pyo3(signature = (nm_per_rad, towards_deg = None, *, wait = true))]
    fn stiffness(
        &self,
        py: Python<'_>,
        nm_per_rad: f64,
        towards_deg: Option<f64>,
        wait: bool,
    ) -> PyResult<()> {
        let mut numbers = vec![("nm_per_rad", nm_per_rad)];
        numbers.extend(towards_deg.map(|deg| ("towards_deg", deg)));
        let command = arguments::command("stiffness", &numbers)?.command();
        self.settled(py, command, wait)
    }

    #[pyo3(signature = (newtons, *, wait = true))]
    fn pretension(&self, py: Python<'_>, newtons: f64, wait: bool) -> PyResult<()> {
        let newtons = bounded("newtons", newtons, -1e9, 1e9)?;
        self.settled(py, Command::Pretension(newtons as f32), wait)
    }

    fn compensation(&self, py: Python<'_>, load: &str) -> PyResult<()> {
        let load: Compensation = arguments::read(&json!(load)).map_err(|_| {
            let sentence =
                format!("load = {load:?} is none of \"off\", \"estimated\" and \"frozen\"");
            PyValueError::new_err(sentence)
        })?;
        self.work(py, |session| session.command(&Command::Compensation(load)))
    }

    #[pyo3(signature = (*, wait = true))]
    fn hold(&self, py: Python<'_>, wait: bool) -> PyResult<()> {
        self.work(py, |session| {
            session.leave_path();
            session.command(&Command::Hold)?;
            if wait { session.settle(MOVE_S) } else { Ok(()) }
        })
    }

    fn stop(&self, py: Python<'_>) -> PyResult<()> {
        self.work(py, |session| {
            session.leave_path();
            session.command(&Command::Stop)
        })
    }

    #[pyo3(signature = (*, wait = true))]
    fn disarm(&self, py: Python<'_>, wait: bool) -> PyResult<()> {
        self.work(py, |session| {
            session.leave_path();
            session.command(&Command::Disarm)?;
            if wait {
                session.reach(State::Disarmed, "relax its tendons", MOVE_S)?;
            }
            Ok(())
        })
    }

    fn clear(&self, py: Python<'_>) -> PyResult<()> {
        self.work(py, |session| session.command(&Command::Clear))
    }

    fn keep_station(&self, py: Python<'_>) -> PyResult<()> {
        self.work(py, |session| session.command(&Command::KeepStation))
    }

    #[pyo3(signature = (kg, over_s = 0.0))]
    fn payload(&self, kg: f64, over_s: f64) -> PyResult<()> {
        self.act(&arguments::action(
            "payload",
            &[("kg", kg), ("over_s", over_s)],
        )?)
    }

    fn push(&self, azimuth_deg: f64, force_n: f64, for_s: f64) -> PyResult<()> {
        let numbers = [
            ("azimuth_deg", azimuth_deg),
            ("force_n", force_n),
            ("for_s", for_s),
        ];
        self.act(&arguments::action("push", &numbers)?)
    }

    #[pyo3(signature = (fault, tendon = None))]
    fn fault(&self, fault: &str, tendon: Option<u8>) -> PyResult<()> {
        self.act(&arguments::defect_action("fault", fault, tendon)?)
    }

    #[pyo3(signature = (fault, tendon = None))]
    fn repair(&self, fault: &str, tendon: Option<u8>) -> PyResult<()> {
        self.act(&arguments::defect_action("repair", fault, tendon)?)
    }

    fn emergency_stop(&self, pressed: bool) -> PyResult<()> {
        self.act(&Action::EmergencyStop(pressed))
    }

    fn silence(&self, silent: bool) -> PyResult<()> {
        self.session()?.leg_mut().host_mut().silent = silent;
        Ok(())
    }

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

    fn read<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let signal = signal(name)?;
        let session = self.session()?;
        let mut numbers = Vec::with_capacity(signal.width());
        if let Some(snapshot) = session.snapshot() {
            signal.read(&snapshot, &mut numbers);
        }
        numbers_as(py, numbers)
    }

    #[pyo3(signature = (signals, *, every_ticks = 16))]
    fn record(&self, signals: Vec<String>, every_ticks: u64) -> PyResult<()> {
        if every_ticks == 0 {
            return Err(PyValueError::new_err("every_ticks = 0 is not from 1"));
        }
        let found: PyResult<Vec<_>> = signals.iter().map(|name| signal(name)).collect();
        let signal_log = SignalLog::new(&found?, every_ticks);
        self.session()?.record(Some(signal_log));
        Ok(())
    }

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

    fn clone(&self) -> PyResult<Self> {
        let session = self.session()?;
        Ok(Self(Mutex::new(Session::clone(&session))))
    }

    fn __copy__(&self) -> PyResult<Self> {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.clone()
    }

    fn __repr__(&self) -> PyResult<String> {
        let session = self.session()?;
        let state = description::state(session.leg().state());
        Ok(format!(
            "SimulatedLeg({state} at {:.3} s)",
            session.leg().time_s()
        ))
    }
}
