//! What was reported, by the signals of a recording.

use super::Signal;
use crate::hosted_leg::Comparison;
use leg_base::description;
use leg_base::recorder_rows::RecorderRow;
use leg_firmware::recorder::RecordedFault;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::RecordedSignal;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::iter::{repeat, repeat_n};

/// The signals of a report that are not made of others.
#[derive(Deserialize)]
struct Reported {
    tick: u32,
    state: String,
    faults: Vec<String>,
    homed: bool,
    failed_tendon: u8,
    moving: bool,
    direction_commanded: [f32; 2],
    direction_reference: [f32; 2],
    direction: [f32; 2],
    residual_m: f32,
    tensions_n: [f32; 3],
    target_tensions_n: [f32; 3],
    pulled_m: [f32; 3],
    reference_m: [f32; 3],
    motor_currents_a: [f32; 3],
    supply_v: f32,
    temperature_c: f32,
    pretension_commanded_n: Option<f32>,
    stiffness_commanded_nm_per_rad: Option<f32>,
    pretension_n: f32,
    stiffness_nm_per_rad: f32,
    load_nm: [f32; 2],
    payload_kg: f32,
    unstretched_at_zero_m: [f32; 3],
    elongation_factor: f32,
}

/// The telemetry of a report, exactly as it was.
///
/// # Errors
/// What is missing or has no meaning, in words.
pub fn telemetry(json: &[u8]) -> Result<Telemetry<f32>, String> {
    let reported: Reported = serde_json::from_slice(json).map_err(|error| error.to_string())?;
    let mut states = State::ALL.into_iter();
    let state = states.find(|state| description::state(*state) == reported.state);
    Ok(Telemetry {
        tick: reported.tick,
        state: state.ok_or_else(|| format!("no state is called {:?}", reported.state))?,
        faults: fault_set(&reported.faults)?,
        homed: reported.homed,
        failed_tendon: reported.failed_tendon,
        moving: reported.moving,
        commanded: reported.direction_commanded,
        target: reported.direction_reference,
        pose: reported.direction,
        residual_m: reported.residual_m,
        tensions_n: reported.tensions_n,
        target_tensions_n: reported.target_tensions_n,
        pulled_m: reported.pulled_m,
        reference_m: reported.reference_m,
        motor_currents_a: reported.motor_currents_a,
        supply_v: reported.supply_v,
        temperature_c: reported.temperature_c,
        pretension_commanded_n: reported.pretension_commanded_n,
        stiffness_commanded_nm_per_rad: reported.stiffness_commanded_nm_per_rad,
        pretension_n: reported.pretension_n,
        stiffness_nm_per_rad: reported.stiffness_nm_per_rad,
        load_nm: reported.load_nm,
        payload_kg: reported.payload_kg,
        unstretched_at_zero_m: reported.unstretched_at_zero_m,
        elongation_factor: reported.elongation_factor,
    })
}

fn fault_set(names: &[String]) -> Result<FaultSet, String> {
    let mut faults = FaultSet::NONE;
    for name in names {
        let mut known = Fault::ALL.into_iter();
        let fault = known.find(|fault| fault.entry().name == name);
        let fault = fault.ok_or_else(|| format!("no fault is called {name:?}"))?;
        faults.add(fault, true);
    }
    Ok(faults)
}

/// The numbers of signals in the JSON object of them, as [`Signal::numbers`] gives them: not a number where there is none.
pub fn numbers<S>(signals: &[Signal<S>], json: &Map<String, Value>, out: &mut Vec<f64>) {
    for signal in signals {
        let Some(width) = signal.width() else {
            continue;
        };
        let value = json.get(signal.name).unwrap_or(&Value::Null);
        match value {
            Value::Array(values) => {
                let values = values.iter().map(number).chain(repeat(f64::NAN));
                out.extend(values.take(width));
            }
            value => out.extend(repeat_n(number(value), width)),
        }
    }
}

fn number(value: &Value) -> f64 {
    match value {
        Value::Bool(flag) => f64::from(u8::from(*flag)),
        value => value.as_f64().unwrap_or(f64::NAN),
    }
}

/// The signals of which a comparison is made.
#[derive(Deserialize)]
struct Tips {
    tip_commanded_mm: [f64; 3],
    tip_reference_mm: [f64; 3],
    tip_estimated_mm: [f64; 3],
}

#[derive(Deserialize)]
struct Truths {
    tip_true_mm: [f64; 3],
    tensions_true_n: [f64; 3],
    payload_true_kg: f64,
    path_error_mm: Option<f64>,
}

/// A simulated leg beside what it reports, by a report and by what is true in the same tick.
///
/// # Errors
/// What is missing, in words.
pub fn comparison(report: &[u8], simulated: &[u8]) -> Result<Comparison, String> {
    let tips: Tips = serde_json::from_slice(report).map_err(|error| error.to_string())?;
    let truths: Truths = serde_json::from_slice(simulated).map_err(|error| error.to_string())?;
    Ok(Comparison {
        tip_commanded_mm: tips.tip_commanded_mm,
        tip_reference_mm: tips.tip_reference_mm,
        tip_estimated_mm: tips.tip_estimated_mm,
        tip_true_mm: truths.tip_true_mm,
        tensions_true_n: truths.tensions_true_n,
        payload_true_kg: truths.payload_true_kg,
        path_error_mm: truths.path_error_mm,
    })
}

/// The signals of which a row of the recorder is made.
#[derive(Deserialize)]
struct RecordedRow {
    tick: u32,
    since_fault_s: Option<f64>,
    fault_names: Vec<String>,
    state_index: Option<u8>,
    tensions_n: [Option<f64>; 3],
    target_tensions_n: [Option<f64>; 3],
    pulled_m: [Option<f64>; 3],
    reference_m: [Option<f64>; 3],
    motor_currents_a: [Option<f64>; 3],
    duties: [Option<f64>; 3],
    direction: [Option<f64>; 2],
    residual_m: Option<f64>,
    supply_v: Option<f64>,
    temperature_c: Option<f64>,
}

/// A row of a board's recorder.
///
/// # Errors
/// What is missing, in words.
pub fn recorder_row(json: &[u8]) -> Result<RecorderRow, String> {
    let row: RecordedRow = serde_json::from_slice(json).map_err(|error| error.to_string())?;
    let faults = fault_set(&row.fault_names)?;
    let fault = row.since_fault_s.map(|since_s| {
        let ticks = (since_s * f64::from(TICK_HZ)).round() as i32;
        RecordedFault {
            tick: row.tick.wrapping_sub(ticks as u32),
            faults,
        }
    });
    let [x, y] = row.direction;
    Ok(RecorderRow::new(row.tick, fault, |signal| {
        let [a, b, c] = match signal {
            RecordedSignal::Tensions => row.tensions_n,
            RecordedSignal::TargetTensions => row.target_tensions_n,
            RecordedSignal::Pulled => row.pulled_m,
            RecordedSignal::References => row.reference_m,
            RecordedSignal::Currents => row.motor_currents_a,
            RecordedSignal::Duties => row.duties,
            RecordedSignal::Pose => [x, y, row.residual_m],
            RecordedSignal::Board => [
                row.supply_v,
                row.temperature_c,
                row.state_index.map(f64::from),
            ],
        };
        Some([a?, b?, c?])
    }))
}
