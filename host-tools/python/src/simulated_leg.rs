//! The class `SimulatedLeg`: its methods check their arguments and hand them to a [`Session`], without the interpreter's lock.

mod commands;
mod readings;
mod surroundings;

use crate::arguments::{self, time_s};
use crate::errors::leg_error;
use crate::interpreter::{self, Call};
use crate::session::{Session, SessionError};
use crate::{named, start, telemetry};
use leg_base::description;
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_sim::action::Action;
use pyo3::prelude::*;
use pyo3::types::PyList;
use std::sync::{Mutex, MutexGuard, TryLockError};

/// Most ticks of one step: a day.
const TICKS_MAX: u64 = 86_400 * TICK_HZ as u64;

/// Ticks in a time, to the nearest.
fn ticks(seconds: f64) -> u64 {
    (seconds * f64::from(TICK_HZ)).round() as u64
}

/// A leg without a board: the firmware's own code and the simulated mechanism, as `leg run --on sim` has them.
///
/// Time passes only in calls: in `step` and `run`, and in commands, which wait for their end unless `wait=False`. The
/// same calls on a leg with the same seed give the same bits. Other Python threads run meanwhile, so that many legs can be
/// stepped in as many threads; one leg belongs to one thread at a time.
///
/// It begins at rest, disarmed, its zero known and its load cells tared.
///
/// rig: a `Rig`, a rig file or the name of a ready rig (`READY_RIGS`); the paper's rig if left out.
/// seed: of the sensors' noise.
/// slack: hangs straight down with 3 mm of slack in each tendon and does not know its zero: `home` it first.
/// azimuth_deg, tilt_deg: where it leans, within 60° of tilt.
/// payload_kg: mass at its tip.
/// pretension_n: that its tendons have, N per tendon at the vertical pose; the rig's if left out.
///
/// Raises RigError for a rig file that is refused, at its place.
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
        Call::begin(py)?.detached(|| Ok(work(&mut *self.session()?)?))
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
                session.settle(session.move_s())
            } else {
                Ok(())
            }
        })
    }
}

/// Fails on Ctrl-C, and at the end of the interpreter.
fn interrupted() -> PyResult<()> {
    interpreter::interrupted().map_or(Ok(()), Err)
}

#[pymethods]
impl SimulatedLeg {
    #[new]
    #[pyo3(signature = (rig = None, *, seed = 0, slack = false, azimuth_deg = 0.0, tilt_deg = 0.0, payload_kg = 0.0, pretension_n = None))]
    #[allow(clippy::too_many_arguments, reason = "they have names in Python")]
    fn new(
        rig: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = named::seed)] seed: i128,
        #[pyo3(from_py_with = named::slack)] slack: bool,
        #[pyo3(from_py_with = named::azimuth_deg)] azimuth_deg: f64,
        #[pyo3(from_py_with = named::tilt_deg)] tilt_deg: f64,
        #[pyo3(from_py_with = named::payload_kg)] payload_kg: f64,
        #[pyo3(from_py_with = named::pretension_n)] pretension_n: Option<f64>,
    ) -> PyResult<Self> {
        let rig = arguments::rig_or_default(rig)?;
        let seed = arguments::whole("seed", seed, 0..=u64::MAX)?;
        let pose = [azimuth_deg, tilt_deg, payload_kg];
        let start = start::start(&rig, slack, pose, pretension_n)?;
        Ok(Self(Mutex::new(Session::new(
            &rig,
            start,
            seed,
            interrupted,
        )?)))
    }

    /// Time of the leg since its start, s.
    #[getter]
    fn time_s(&self) -> PyResult<f64> {
        Ok(self.session()?.leg().time_s())
    }

    /// The same in ticks.
    #[getter]
    fn ticks(&self) -> PyResult<u64> {
        Ok(self.session()?.leg().ticks())
    }

    /// What the leg may do: one of `STATES`.
    #[getter]
    fn state(&self) -> PyResult<&'static str> {
        Ok(description::state(self.session()?.leg().state()))
    }

    /// Whether a path is followed, the way to its start included.
    #[getter]
    fn following(&self) -> PyResult<bool> {
        Ok(self.session()?.following())
    }

    /// Faults that are latched or limit now: `code`, `name`, `cause`, `remedy`, `reaction` of each.
    #[getter]
    fn faults<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        telemetry::faults(py, self.session()?.reported())
    }

    /// Lets some ticks pass, 125 µs each: 1 ms if left out. A fault shows in `faults` and `state`, and raises nothing.
    #[pyo3(signature = (ticks = 8))]
    fn step(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::ticks)] ticks: i128,
    ) -> PyResult<()> {
        let count = arguments::whole("ticks", ticks, 0..=TICKS_MAX)?;
        self.work(py, |session| session.step(count))
    }

    /// Lets a time pass, to the nearest tick, s.
    fn run(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::seconds)] seconds: f64,
    ) -> PyResult<()> {
        let count = ticks(time_s("seconds", seconds)?);
        self.work(py, |session| session.step(count))
    }

    /// Lets time pass until the leg has rested for 0.3 s where it shall be, at the end of what it follows.
    ///
    /// Raises LegFault if a fault ends or limits that, LegTimeout after `timeout_s` of the leg's time.
    #[pyo3(signature = (timeout_s = 60.0))]
    fn wait(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::timeout_s)] timeout_s: f64,
    ) -> PyResult<()> {
        let timeout_s = time_s("timeout_s", timeout_s)?;
        self.work(py, |session| session.settle(timeout_s))
    }

    /// The same leg in the same state, to try something else with: both go on alike, bit for bit, where they are treated alike.
    fn clone(&self) -> PyResult<Self> {
        let session = self.session()?;
        Ok(Self(Mutex::new(Session::clone(&session))))
    }

    /// A clone.
    fn __copy__(&self) -> PyResult<Self> {
        self.clone()
    }

    /// A clone.
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
