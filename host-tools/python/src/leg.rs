//! The class `Leg`: a leg on a serial port, or emulated in this process, commanded as by the command line.

mod access;
mod calibration;
mod settings;

use crate::arguments::{self, TensionArguments, bounded, tensioning};
use crate::errors::leg_error;
use crate::interpreter::Call;
use crate::named;
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

/// A leg on a serial port, commanded as by `leg home`, `leg move` and so on; or the same emulated in this process.
///
/// Each call returns at its end, with telemetry. After `move`, `stiffness` and `follow` the leg keeps station; after `home`
/// and `hold` it is in hold, as is one that was driven after `stop`, Ctrl-C and an error. One that homes or follows commands, and hears no
/// more of this program, is held by itself.
/// Raises LegFault, Refused, LegTimeout, or LegError where the connection fails.
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
        let _call = Call::begin(py)?;
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

/// The address of a leg on a bus.
fn address(name: &str, leg: i128) -> PyResult<LegAddress> {
    let address = u8::try_from(leg).ok().and_then(LegAddress::new);
    address.ok_or_else(|| PyValueError::new_err(format!("{name} = {leg} is none of 1 to 6")))
}

/// The time of the day, s since 1970; not a number beside a leg whose time is emulated.
fn wall_time_s(operator: &Operator) -> f64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    let known = since.ok().filter(|_| !operator.clock_is_emulated());
    known.map_or(f64::NAN, |since| since.as_secs_f64())
}

#[pymethods]
impl Leg {
    /// The leg on a serial port, such as `/dev/ttyACM0`; on the port of the board's ST-LINK if left out.
    ///
    /// What `leg emulate` prints is a port, too: with `--on chip` the board's own image on an emulated chip, with `--tcp`
    /// `tcp://HOST:PORT`.
    #[staticmethod]
    #[pyo3(signature = (port = None))]
    fn open(
        py: Python<'_>,
        #[pyo3(from_py_with = named::port)] port: Option<String>,
    ) -> PyResult<Self> {
        Self::opened(py, Place::Port(port))
    }

    /// The leg with an address, 1 to 6, on a CAN FD bus: its interface, such as `can0`. Linux only.
    #[staticmethod]
    #[pyo3(signature = (interface, leg = 1))]
    fn can(
        py: Python<'_>,
        #[pyo3(from_py_with = named::interface)] interface: String,
        #[pyo3(from_py_with = named::leg)] leg: i128,
    ) -> PyResult<Self> {
        Self::opened(py, Place::Can(interface, address("leg", leg)?))
    }

    /// A leg in this process, whose time goes on only in calls: homed, or slack and not homed. For programs to be tried on.
    ///
    /// can: its address, 1 to 6, on an emulated CAN FD bus, on which the same frames go as with `Leg.can`; no bus if left out.
    #[staticmethod]
    #[pyo3(signature = (rig = None, *, slack = false, can = None))]
    fn emulated(
        py: Python<'_>,
        rig: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = named::slack)] slack: bool,
        #[pyo3(from_py_with = named::can)] can: Option<i128>,
    ) -> PyResult<Self> {
        let rig = arguments::rig_or_default(rig)?;
        let initial = if slack {
            InitialState::Slack
        } else {
            InitialState::Homed
        };
        let can = can.map(|leg| address("can", leg)).transpose()?;
        Self::opened(py, Place::Emulated(Box::new(rig), initial, can))
    }

    /// Finds the zero. The leg must hang free, without a payload.
    fn home<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.report(py, Operator::home)
    }

    /// Leans the leg, degrees, with a pretension or a bending stiffness if one is given. A leg with a zero is armed first.
    #[pyo3(name = "move", signature = (azimuth_deg, tilt_deg, *, pretension_n = None, stiffness_nm_per_rad = None, towards_deg = None))]
    fn move_to<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::azimuth_deg)] azimuth_deg: f64,
        #[pyo3(from_py_with = named::tilt_deg)] tilt_deg: f64,
        #[pyo3(from_py_with = named::pretension_n)] pretension_n: Option<f64>,
        #[pyo3(from_py_with = named::stiffness_nm_per_rad)] stiffness_nm_per_rad: Option<f64>,
        #[pyo3(from_py_with = named::towards_deg)] towards_deg: Option<f64>,
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

    /// Changes the bending stiffness where the leg is: of the softest tilt, or against a push towards an azimuth.
    #[pyo3(signature = (nm_per_rad, towards_deg = None))]
    fn stiffness<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::nm_per_rad)] nm_per_rad: f64,
        #[pyo3(from_py_with = named::towards_deg)] towards_deg: Option<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let nm_per_rad = bounded("nm_per_rad", nm_per_rad, 0.0, 1e9)?;
        let goal = Goal {
            tensioning: tensioning(None, Some(nm_per_rad), towards_deg)?,
            direction: None,
        };
        self.reach(py, goal)
    }

    /// Streams a path: rows of time in s, azimuth and tilt in degrees. It is checked as a whole before the leg moves.
    ///
    /// pretension_n, stiffness_nm_per_rad: what the tendons are tensioned for on the way to each row, or to all; one of them. What is
    /// out of reach is held at its bound; the last one stays, and raises LegFault where it is out of reach at the end.
    /// lead_s: how long a point may be on its way to the leg, s.
    #[pyo3(signature = (points, *, pretension_n = None, stiffness_nm_per_rad = None, lead_s = 0.2))]
    fn follow<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'_, PyAny>,
        pretension_n: Option<&Bound<'_, PyAny>>,
        stiffness_nm_per_rad: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = named::lead_s)] lead_s: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let tensions = TensionArguments {
            pretension_n,
            stiffness_nm_per_rad,
        };
        let path = arguments::path("points", points, tensions)?;
        let lead = Duration::from_secs_f64(bounded("lead_s", lead_s, 0.0, 10.0)?);
        self.report(py, move |operator| operator.follow_whole(&path, lead))
    }

    /// Brings the leg to the state held, on its screws.
    fn hold<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.reach(py, Goal::default())
    }

    /// Stops the leg, and returns once its motors stand: it is in hold then. One that jogs is disarmed, one that is disarmed or off stays so,
    /// one that ramps down goes on.
    ///
    /// From another thread it ends the call that uses the leg, which raises LegError.
    fn stop(&self, py: Python<'_>) -> PyResult<()> {
        self.ask_at_once(py, Operator::stop_to_rest).map(|_| ())
    }

    /// Leads the leg straight down, pays its tendons out and switches the drivers off.
    fn disarm(&self, py: Python<'_>) -> PyResult<()> {
        self.ask(py, Operator::disarm)
    }

    /// Clears the faults whose cause is gone. The leg is in hold then, keeps station as before, or is disarmed; one that was held
    /// without a zero pays its tendons out first.
    fn clear(&self, py: Python<'_>) -> PyResult<()> {
        self.ask(py, Operator::clear)
    }

    /// What the leg reports, by the names of `SimulatedLeg.telemetry`.
    fn telemetry<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.report(py, |operator| Ok(operator.telemetry()?.telemetry))
    }

    /// What the board's recorder holds, each tick of the last 0.2 s by the default settings: up to a fault that stops the leg and
    /// a quarter beyond, or else up to now. Only what the settings' `recorded` chooses is there, each signal as an array;
    /// `since_fault_s` and `fault_names`, those that stopped the leg, only after a fault, until that is cleared.
    fn scope<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let scope = self.ask(py, Operator::scope)?;
        scope::arrays(py, &scope)
    }

    /// What the sensors read now, as codes and in SI units: `axes` has one dictionary for each tendon.
    fn sensors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let both = self.ask(py, |operator| {
            Ok((operator.sensors()?, operator.settings()?))
        })?;
        arguments::from_json(py, &sensor_report::json(&both.0, &both.1))
    }

    /// Lets a time pass; an emulated leg's passes in no other way but in calls.
    fn wait(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::seconds)] seconds: f64,
    ) -> PyResult<()> {
        let time = Duration::from_secs_f64(arguments::time_s("seconds", seconds)?);
        self.ask(py, move |operator| operator.pause(time))
    }

    /// Does something to an emulated leg: `{"payload": {"kg": 2}}` and all else that `leg emulate --help` lists.
    fn disturb(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::action)] action: Bound<'_, PyDict>,
    ) -> PyResult<()> {
        let text = arguments::to_json("action", &action)?;
        let action = Action::parse(&text).map_err(|error| {
            let list = "`leg emulate --help` lists the disturbances";
            PyValueError::new_err(format!("action = {text}: {error}; {list}"))
        })?;
        self.call(py, |call| call.disturb(action))
    }

    /// The settings in use, as a rig that gives the same bits again.
    fn settings(&self, py: Python<'_>) -> PyResult<Rig> {
        let settings = self.ask(py, Operator::settings)?;
        Rig::read_text(
            "the leg's settings".into(),
            settings_text::rig_file(&settings),
        )
    }

    /// Every setting that a rig has differently: `name`, its value of the `rig` and of the `leg`.
    fn settings_differences<'py>(
        &self,
        py: Python<'py>,
        rig: &Bound<'_, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = settings::from_rig(rig)?;
        let found = setting_differences(&given, &self.ask(py, Operator::settings)?);
        let rows = found.iter().map(|difference| {
            json!({ "name": difference.name, "rig": difference.ours, "leg": difference.theirs })
        });
        arguments::from_json(py, &rows.collect::<Vec<_>>())
    }

    /// Replaces the settings by a rig's, and reads them back. The leg must be disarmed, and homed afterwards.
    ///
    /// save: whether the board keeps them over a reset.
    #[pyo3(signature = (rig, *, save = false))]
    fn set_settings(
        &self,
        py: Python<'_>,
        rig: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = named::save)] save: bool,
    ) -> PyResult<()> {
        let settings = settings::from_rig(rig)?;
        self.ask(py, move |operator| settings::set(operator, &settings, save))
    }

    /// Finds `n_per_code`, `zero_code` and `residual_n` of a load cell, 1 to 3, by known weights, drivers off.
    ///
    /// weights_kg: at least two different ones; 0 is the empty hook.
    /// hang: is called with each weight, and returns when it hangs on the cell in the place of the tendon.
    /// set: whether the leg is set to the result; it must be homed afterwards. save: whether it keeps it over a reset.
    ///
    /// Raises LegError, and sets nothing, where no straight line explains the weights.
    #[pyo3(signature = (cell, weights_kg, hang, *, set = false, save = false))]
    fn calibrate_cell<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::cell)] cell: i128,
        weights_kg: &Bound<'_, PyAny>,
        hang: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = named::set)] set: bool,
        #[pyo3(from_py_with = named::save)] save: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let keep = Keep { set, save };
        let fit = calibration::cell(self, py, cell, weights_kg, hang, keep)?;
        arguments::from_json(py, &fit)
    }

    /// Checks direction and counts of each encoder, drivers off: a dictionary for each motor.
    ///
    /// turn: is called with each motor, 1 to 3, and returns when it has been turned once, so that it reels its tendon in.
    /// rig: says how many counts a turn has; the paper's if left out.
    ///
    /// Each has `motor`, `counts`, `expected_counts`, whether it `passed`, and in words the `verdict`; `counts_sign` is what the rig
    /// file has to say, 0 where nothing was counted.
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

    /// Turns one motor, 1 to 3, slowly, to see whether its wires are right. The leg must be disarmed, not homed.
    ///
    /// travel_mm: how far its tendon is pulled in, at most 10 mm; below zero it is paid out.
    /// volts: the voltage at the motor; one that turns it at 2 mm/s if left out.
    ///
    /// `findings` lists what does not fit, as swapped wires: each with `what` and `remedy`. The rest is what was seen. The motor is off in the end.
    #[pyo3(signature = (motor, travel_mm, *, volts = None))]
    fn jog<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::motor)] motor: i128,
        #[pyo3(from_py_with = named::travel_mm)] travel_mm: f64,
        #[pyo3(from_py_with = named::volts)] volts: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let seen = calibration::jog(self, py, motor, travel_mm, volts)?;
        arguments::from_json(py, &seen)
    }

    /// Closes the connection. The end of a `with` does, too.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        Call::begin(py)?.detached(|| {
            if let Some(thread) = self.owned()?.take() {
                thread.close();
            }
            Ok(())
        })
    }

    /// The leg itself.
    fn __enter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// Closes the connection.
    #[pyo3(signature = (*_exception))]
    fn __exit__(&self, py: Python<'_>, _exception: &Bound<'_, PyAny>) -> PyResult<()> {
        self.close(py)
    }
}
