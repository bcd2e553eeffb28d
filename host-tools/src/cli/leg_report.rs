//! What a command tells of the leg when it ends.

use super::print;
use crate::failure::Failure;
use crate::operator::Operator;
use crate::words;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use serde::Serialize;

/// Tilt below which an azimuth means nothing, degrees.
const UPRIGHT_DEG: f64 = 0.05;

/// The leg in a user's units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct LegReport {
    state: State,
    faults: Vec<FaultReport>,
    homed: bool,
    azimuth_deg: f64,
    tilt_deg: f64,
    tensions_n: [f32; 3],
    level_n: f32,
    stiffness_nm_per_rad: f32,
    load_nm: [f32; 2],
    payload_kg: f32,
    /// Time of the leg since its board started, s.
    time_s: f64,
}

/// A fault with what to do about it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct FaultReport {
    code: u8,
    fault: Fault,
    name: &'static str,
    cause: &'static str,
    cure: &'static str,
}

/// Every fault of a set.
pub(super) fn fault_reports(faults: FaultSet) -> Vec<FaultReport> {
    let report = |fault: Fault| {
        let entry = fault.entry();
        FaultReport {
            code: fault.code(),
            fault,
            name: entry.name,
            cause: entry.cause,
            cure: entry.cure,
        }
    };
    faults.faults().map(report).collect()
}

impl LegReport {
    pub(super) fn of(telemetry: &Telemetry<f32>) -> Self {
        let [azimuth_deg, tilt_deg] = angles_deg(telemetry.pose);
        Self {
            state: telemetry.state,
            faults: fault_reports(telemetry.faults),
            homed: telemetry.homed,
            azimuth_deg,
            tilt_deg,
            tensions_n: telemetry.tensions_n,
            level_n: telemetry.level_n,
            stiffness_nm_per_rad: telemetry.stiffness_nm_per_rad,
            load_nm: telemetry.load_nm,
            payload_kg: telemetry.payload_kg,
            time_s: f64::from(telemetry.tick) * crate::simulation::tick_s(),
        }
    }
}

/// Azimuth (0 to 360) and tilt of a direction, degrees.
pub(super) fn angles_deg([x, y]: [f32; 2]) -> [f64; 2] {
    let (x, y) = (f64::from(x), f64::from(y));
    let tilt_deg = x.hypot(y).min(1.0).asin().to_degrees();
    [y.atan2(x).to_degrees().rem_euclid(360.0), tilt_deg]
}

/// A direction in words.
pub(super) fn pose_words(pose: [f32; 2]) -> String {
    let [azimuth_deg, tilt_deg] = angles_deg(pose);
    if tilt_deg < UPRIGHT_DEG {
        "straight down".into()
    } else {
        format!("azimuth {azimuth_deg:.2}°, tilt {tilt_deg:.2}°")
    }
}

/// The rows of a table for people.
pub(super) fn rows(telemetry: &Telemetry<f32>) -> String {
    let [a, b, c] = telemetry.tensions_n;
    let pose = if telemetry.homed {
        pose_words(telemetry.pose)
    } else {
        "not known before homing".into()
    };
    let mut rows = format!(
        "state      {}\npose       {pose}\ntensions   {a:.1}  {b:.1}  {c:.1} N\n",
        words::state(telemetry.state)
    );
    if telemetry.level_n > 0.0 {
        rows += &format!(
            "level      {:.1} N\nstiffness  {:.2} N·m/rad\npayload    {:.2} kg\n",
            telemetry.level_n, telemetry.stiffness_nm_per_rad, telemetry.payload_kg
        );
    }
    rows + &format!("faults     {}\n", words::faults(telemetry.faults))
}

/// Asks the leg what it is doing and prints it, with `extra` rows at the end.
pub(super) fn tell(operator: &mut Operator, json: bool, extra: &str) -> Result<(), Failure> {
    let telemetry = operator.telemetry()?.telemetry;
    print(&if json {
        to_line(&LegReport::of(&telemetry))?
    } else {
        rows(&telemetry) + extra
    })
}

/// One line of JSON.
pub(super) fn to_line<T: Serialize>(value: &T) -> Result<String, Failure> {
    match serde_json::to_string(value) {
        Ok(json) => Ok(json + "\n"),
        Err(error) => Err(Failure::from_error(&error)),
    }
}
