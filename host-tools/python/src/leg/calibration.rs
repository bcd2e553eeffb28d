//! Calibration of a leg by hand: load cells by weights, encoders by turns; one motor turned slowly.

use super::{Leg, settings};
use crate::arguments::{self, bounded, callable, place};
use crate::errors::leg_failure;
use crate::operator_thread::LegFailure;
use leg_base::failure::Failure;
use leg_firmware::jog::{JogDemand, JogDrive, JogEnd};
use leg_host::calibration::{
    CellFit, KnownWeight, fit, mean_code, require_drivers_off, too_few_weights,
};
use leg_host::jog_report;
use leg_host::operator::{Operator, OperatorError};
use leg_rig::motor_turn::{self, MotorTurn};
use leg_rig::rig_file::RigFile;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;

/// What is done with what was found.
#[derive(Clone, Copy)]
pub(super) struct Keep {
    /// The leg is set to it.
    pub set: bool,
    /// It keeps it over a reset.
    pub save: bool,
}

/// An encoder's turn, for Python.
#[derive(Serialize)]
struct Turn {
    motor: usize,
    counts: i16,
    expected_counts: f64,
    counts_sign: i8,
    passed: bool,
    verdict: String,
}

impl From<MotorTurn> for Turn {
    fn from(turn: MotorTurn) -> Self {
        Self {
            motor: turn.motor,
            counts: turn.counts,
            expected_counts: turn.expected,
            counts_sign: turn.sign,
            passed: turn.passed,
            verdict: turn.verdict(),
        }
    }
}

fn refused(failure: Failure) -> PyErr {
    leg_failure(LegFailure::Refused(failure))
}

fn require_off(leg: &Leg, py: Python<'_>, asked: &'static str) -> PyResult<()> {
    let off = leg.ask(py, move |operator| Ok(require_drivers_off(operator, asked)))?;
    off.map_err(refused)
}

/// Finds zero and gain of a load cell by weights that `hang` hangs on it.
pub(super) fn cell(
    leg: &Leg,
    py: Python<'_>,
    cell: i128,
    weights_kg: &Bound<'_, PyAny>,
    hang: &Bound<'_, PyAny>,
    keep: Keep,
) -> PyResult<CellFit> {
    let axis = place("cell", cell)?;
    callable("hang", hang)?;
    if keep.save && !keep.set {
        return Err(PyValueError::new_err("save is given without set"));
    }
    let weights_kg = arguments::list("weights_kg", weights_kg)?;
    for kg in &weights_kg {
        bounded("weights_kg", *kg, 0.0, 1e3)?;
    }
    if weights_kg.iter().all(|kg| Some(kg) == weights_kg.first()) {
        return Err(refused(too_few_weights()));
    }
    require_off(leg, py, "let weights be hung on its cells")?;
    let gravity = f64::from(leg.ask(py, Operator::settings)?.rig.gravity_m_per_s2);
    let mut weighings = Vec::new();
    for kg in weights_kg {
        hang.call1((kg,))?;
        let newtons = kg * gravity;
        let code = leg.ask(py, move |operator| mean_code(operator, axis))?;
        weighings.push(KnownWeight { newtons, code });
    }
    let fit = fit(&weighings).map_err(refused)?;
    fit.require_straight(axis as u8 + 1, &weighings)
        .map_err(refused)?;
    if keep.set {
        // Another host may have set something else meanwhile: that stays.
        let mut found = leg.ask(py, Operator::settings)?;
        found.axes[axis].cell_n_per_code = fit.n_per_code as f32;
        found.axes[axis].cell_zero_code = fit.zero_code as f32;
        let found = found.unhomed();
        leg.ask(py, move |operator| {
            settings::set(operator, &found, keep.save)
        })?;
    }
    Ok(fit)
}

/// Checks direction and counts of each encoder: `turn` turns every motor once.
pub(super) fn motors(
    leg: &Leg,
    py: Python<'_>,
    turn: &Bound<'_, PyAny>,
    rig: &RigFile,
) -> PyResult<impl Serialize + use<>> {
    callable("turn", turn)?;
    let counts_per_turn = rig.actuators.map(|actuator| actuator.counts_per_turn);
    let mut counts = counts_per_turn.into_iter();
    counts
        .try_for_each(motor_turn::require_countable)
        .map_err(refused)?;
    require_off(leg, py, "let itself be turned by hand")?;
    let axes = leg.ask(py, Operator::settings)?.axes;
    let mut turns: Vec<Turn> = Vec::new();
    for (motor, axis) in axes.iter().enumerate() {
        let before = leg.ask(py, Operator::sensors)?.codes.encoder_counts[motor];
        turn.call1((motor + 1,))?;
        let after = leg.ask(py, Operator::sensors)?.codes.encoder_counts[motor];
        turns.push(MotorTurn::new(motor, [before, after], counts_per_turn[motor], axis).into());
    }
    Ok(turns)
}

/// Turns one motor slowly, and says what does not fit.
pub(super) fn jog(
    leg: &Leg,
    py: Python<'_>,
    motor: i128,
    travel_mm: f64,
    volts: Option<f64>,
) -> PyResult<impl Serialize + use<>> {
    let motor = place("motor", motor)? as u8 + 1;
    let travel_mm = bounded("travel_mm", travel_mm, -1e3, 1e3)?;
    let volts = volts.map(|volts| bounded("volts", volts, 0.0, 1e3));
    let volts = volts.transpose()?;
    leg.ask(py, move |operator| {
        let settings = operator.settings()?;
        let given = volts.map(|volts| volts as f32);
        let demand = JogDemand {
            motor,
            travel_m: (travel_mm / 1000.0) as f32,
            drive: JogDrive::Voltage(
                given.unwrap_or_else(|| jog_report::slow_voltage_v(motor, &settings)),
            ),
        };
        let (report, telemetry) = operator.jog(&demand)?;
        let asked = "jog a motor";
        if telemetry.faults.stopping().any() {
            return Err(OperatorError::Failed(asked, Box::new(telemetry)));
        }
        if report.end == JogEnd::CutOff {
            return Err(OperatorError::StoppedByOtherHost(asked, telemetry.state));
        }
        let findings = jog_report::findings(&report, &settings);
        Ok(jog_report::json(&report, &findings))
    })
}
