//! Commands, as a host gives them.

use super::SimulatedLeg;
use crate::arguments::{self, TensionArguments, bounded};
use crate::named;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::State;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

#[pymethods]
impl SimulatedLeg {
    /// Lets the leg follow commands from now on, its tendons taut.
    ///
    /// Raises Refused with the firmware's words, LegFault if a fault is latched. So do all commands.
    #[pyo3(signature = (*, wait = true))]
    fn arm(&self, py: Python<'_>, #[pyo3(from_py_with = named::wait)] wait: bool) -> PyResult<()> {
        self.settled(py, Command::Arm, wait)
    }

    /// Finds the zero of a slack leg; it is armed then and hangs straight down.
    #[pyo3(signature = (*, wait = true))]
    fn home(&self, py: Python<'_>, #[pyo3(from_py_with = named::wait)] wait: bool) -> PyResult<()> {
        self.work(py, |session| {
            session.command(&Command::Home)?;
            if wait {
                session.reach(State::Active, "find its zero", session.homing_s())?;
                session.settle(session.move_s())?;
            }
            Ok(())
        })
    }

    /// Leans the leg: towards an azimuth, degrees, by a tilt, degrees. A negative tilt is the opposite azimuth.
    #[pyo3(name = "move", signature = (azimuth_deg, tilt_deg, *, wait = true))]
    fn move_to(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::azimuth_deg)] azimuth_deg: f64,
        #[pyo3(from_py_with = named::tilt_deg)] tilt_deg: f64,
        #[pyo3(from_py_with = named::wait)] wait: bool,
    ) -> PyResult<()> {
        let numbers = [("azimuth_deg", azimuth_deg), ("tilt_deg", tilt_deg)];
        let command = arguments::command("move", &numbers)?.command();
        self.settled(py, command, wait)
    }

    /// Streams a path to the leg as set-points: rows of time in s, azimuth and tilt in degrees, in the order of their times.
    ///
    /// The leg is led to a run-up first, and comes to rest at the end. With `wait=False` later ticks send the points.
    /// Refused, before the leg moves, where a point is beyond a limit of the motion; the message has its time.
    ///
    /// pretension_n, stiffness_nm_per_rad: what the tendons are tensioned for on the way to each row, or to all; one of them. What is
    /// out of reach is held at its bound, and is told by `faults`.
    #[pyo3(signature = (points, *, pretension_n = None, stiffness_nm_per_rad = None, wait = true))]
    fn follow(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        pretension_n: Option<&Bound<'_, PyAny>>,
        stiffness_nm_per_rad: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = named::wait)] wait: bool,
    ) -> PyResult<()> {
        let tensions = TensionArguments {
            pretension_n,
            stiffness_nm_per_rad,
        };
        let path = arguments::path("points", points, tensions)?;
        let lasts_s = path.points().last().map_or(0.0, |last| last.time_s);
        self.work(py, |session| {
            session.follow(path)?;
            if wait {
                session.settle(lasts_s + 2.0 * session.move_s())
            } else {
                Ok(())
            }
        })
    }

    /// Demands a bending stiffness, N·m/rad: of the softest tilt, or against a push towards an azimuth, degrees.
    ///
    /// LegFault (`stiffness out of reach`) where the tension bounds stop the pretension short of it.
    #[pyo3(signature = (nm_per_rad, towards_deg = None, *, wait = true))]
    fn stiffness(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::nm_per_rad)] nm_per_rad: f64,
        #[pyo3(from_py_with = named::towards_deg)] towards_deg: Option<f64>,
        #[pyo3(from_py_with = named::wait)] wait: bool,
    ) -> PyResult<()> {
        let mut numbers = vec![("nm_per_rad", nm_per_rad)];
        numbers.extend(towards_deg.map(|deg| ("towards_deg", deg)));
        let command = arguments::command("stiffness", &numbers)?.command();
        self.settled(py, command, wait)
    }

    /// Sets the pretension, N per tendon at the vertical pose.
    #[pyo3(signature = (newtons, *, wait = true))]
    fn pretension(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::newtons)] newtons: f64,
        #[pyo3(from_py_with = named::wait)] wait: bool,
    ) -> PyResult<()> {
        let newtons = bounded("newtons", newtons, -1e9, 1e9)?;
        self.settled(py, Command::Pretension(newtons as f32), wait)
    }

    /// Chooses the load that the tendons hold: `"off"`, `"estimated"` (from the tensions) or `"frozen"` (as it is now).
    fn compensation(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::load)] load: String,
    ) -> PyResult<()> {
        let load: Compensation = arguments::read(&json!(load)).map_err(|_| {
            let sentence =
                format!("load = {load:?} is none of \"off\", \"estimated\" and \"frozen\"");
            PyValueError::new_err(sentence)
        })?;
        self.work(py, |session| session.command(&Command::Compensation(load)))
    }

    /// Comes to rest on the way and stays active, following commands. It does not come to the state held, as by `Leg.hold`:
    /// `stop` does that.
    #[pyo3(signature = (*, wait = true))]
    fn hold(&self, py: Python<'_>, #[pyo3(from_py_with = named::wait)] wait: bool) -> PyResult<()> {
        self.work(py, |session| {
            session.leave_path();
            session.command(&Command::Hold)?;
            if wait {
                session.settle(session.move_s())
            } else {
                Ok(())
            }
        })
    }

    /// Stays where it is, at once, until `clear`.
    fn stop(&self, py: Python<'_>) -> PyResult<()> {
        self.work(py, |session| {
            session.leave_path();
            session.command(&Command::Stop)
        })
    }

    /// Leads the leg straight down, pays its tendons out and switches the drivers off.
    #[pyo3(signature = (*, wait = true))]
    fn disarm(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::wait)] wait: bool,
    ) -> PyResult<()> {
        self.work(py, |session| {
            session.leave_path();
            session.command(&Command::Disarm)?;
            if wait {
                session.reach(State::Disarmed, "relax its tendons", session.disarm_s())?;
            }
            Ok(())
        })
    }

    /// Clears the faults whose cause is gone, and ends a stop.
    fn clear(&self, py: Python<'_>) -> PyResult<()> {
        self.work(py, |session| session.command(&Command::Clear))
    }

    /// Leaves a leg that rests: it compensates its load slowly where it is, and needs no host.
    fn keep_station(&self, py: Python<'_>) -> PyResult<()> {
        self.work(py, |session| session.command(&Command::KeepStation))
    }
}
