//! What was reported, by the signals of a recording.

use crate::hosted_leg::Comparison;
use leg_base::description;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use serde::Deserialize;

/// The signals of a report that are not made of others.
#[derive(Deserialize)]
struct Reported {
    tick: u32,
    state: String,
    faults: Vec<String>,
    homed: bool,
    failed_tendon: u8,
    moving: bool,
    direction_reference: [f32; 2],
    direction: [f32; 2],
    residual_m: f32,
    tensions_n: [f32; 3],
    target_tensions_n: [f32; 3],
    pulled_m: [f32; 3],
    reference_m: [f32; 3],
    pretension_n: f32,
    stiffness_nm_per_rad: f32,
    load_nm: [f32; 2],
    payload_kg: f32,
    unstretched_at_zero_m: [f32; 3],
}

/// The telemetry of a report, exactly as it was.
///
/// # Errors
/// What is missing or has no meaning, in words.
pub fn telemetry(json: &[u8]) -> Result<Telemetry<f32>, String> {
    let reported: Reported = serde_json::from_slice(json).map_err(|error| error.to_string())?;
    let mut states = State::ALL.into_iter();
    let state = states.find(|state| description::state(*state) == reported.state);
    let mut faults = FaultSet::NONE;
    for name in &reported.faults {
        let mut known = Fault::ALL.into_iter();
        let fault = known.find(|fault| fault.entry().name == name);
        faults.add(
            fault.ok_or_else(|| format!("no fault is called {name:?}"))?,
            true,
        );
    }
    Ok(Telemetry {
        tick: reported.tick,
        state: state.ok_or_else(|| format!("no state is called {:?}", reported.state))?,
        faults,
        homed: reported.homed,
        failed_tendon: reported.failed_tendon,
        moving: reported.moving,
        target: reported.direction_reference,
        pose: reported.direction,
        residual_m: reported.residual_m,
        tensions_n: reported.tensions_n,
        target_tensions_n: reported.target_tensions_n,
        pulled_m: reported.pulled_m,
        reference_m: reported.reference_m,
        pretension_n: reported.pretension_n,
        stiffness_nm_per_rad: reported.stiffness_nm_per_rad,
        load_nm: reported.load_nm,
        payload_kg: reported.payload_kg,
        unstretched_at_zero_m: reported.unstretched_at_zero_m,
    })
}

/// The signals of which a comparison is made.
#[derive(Deserialize)]
struct Tips {
    tip_reference_mm: [f64; 3],
    tip_estimated_mm: [f64; 3],
}

#[derive(Deserialize)]
struct Truths {
    tip_commanded_mm: [f64; 3],
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
        tip_commanded_mm: truths.tip_commanded_mm,
        tip_reference_mm: tips.tip_reference_mm,
        tip_estimated_mm: tips.tip_estimated_mm,
        tip_true_mm: truths.tip_true_mm,
        tensions_true_n: truths.tensions_true_n,
        payload_true_kg: truths.payload_true_kg,
        path_error_mm: truths.path_error_mm,
    })
}
