//! The leg in a user's units.

use leg_base::description;
use leg_base::tick_time::seconds;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use serde::Serialize;

/// Tilt below which an azimuth means nothing, degrees.
const UPRIGHT_DEG: f64 = 0.05;

/// The leg in a user's units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LegReport {
    /// What it may do.
    pub state: State,
    /// What is wrong with it.
    pub faults: Vec<FaultReport>,
    /// Whether its zero is known.
    pub homed: bool,
    /// Where it is estimated to lean, 0 to 360°.
    pub azimuth_deg: f64,
    /// How far.
    pub tilt_deg: f64,
    /// Measured tensions, N.
    pub tensions_n: [f32; 3],
    /// Pretension of the last target, N; 0 before the first.
    pub pretension_n: f32,
    /// Bending stiffness at that pretension, N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Load beyond the leg's own weight, N·m.
    pub load_nm: [f32; 2],
    /// The payload that this would be, kg.
    pub payload_kg: f32,
    /// Time of the leg since its board started, s.
    pub time_s: f64,
}

/// A fault with what to do about it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultReport {
    /// Its code.
    pub code: u8,
    /// The fault.
    pub fault: Fault,
    /// Its name in words.
    pub name: &'static str,
    /// What raises it.
    pub cause: &'static str,
    /// What to do about it.
    pub remedy: &'static str,
}

/// Every fault of a set.
#[must_use]
pub fn fault_reports(faults: FaultSet) -> Vec<FaultReport> {
    let report = |fault: Fault| {
        let entry = fault.entry();
        FaultReport {
            code: fault.code(),
            fault,
            name: entry.name,
            cause: entry.cause,
            remedy: entry.remedy,
        }
    };
    faults.faults().map(report).collect()
}

impl LegReport {
    /// Converts telemetry.
    #[must_use]
    pub fn new(telemetry: &Telemetry<f32>) -> Self {
        let [azimuth_deg, tilt_deg] = angles_deg(telemetry.pose);
        Self {
            state: telemetry.state,
            faults: fault_reports(telemetry.faults),
            homed: telemetry.homed,
            azimuth_deg,
            tilt_deg,
            tensions_n: telemetry.tensions_n,
            pretension_n: telemetry.pretension_n,
            stiffness_nm_per_rad: telemetry.stiffness_nm_per_rad,
            load_nm: telemetry.load_nm,
            payload_kg: telemetry.payload_kg,
            time_s: seconds(telemetry.tick.into()),
        }
    }
}

/// Azimuth (0 to 360) and tilt of a direction, degrees, to a ten-thousandth.
#[must_use]
pub fn angles_deg([x, y]: [f32; 2]) -> [f64; 2] {
    let (x, y) = (f64::from(x), f64::from(y));
    let tilt_deg = x.hypot(y).min(1.0).asin().to_degrees();
    // Beyond that, machines differ.
    [y.atan2(x).to_degrees().rem_euclid(360.0), tilt_deg].map(|deg| (deg * 1e4).round() / 1e4)
}

/// A direction in words.
#[must_use]
pub fn pose_words(pose: [f32; 2]) -> String {
    let [azimuth_deg, tilt_deg] = angles_deg(pose);
    if tilt_deg < UPRIGHT_DEG {
        "straight down".into()
    } else {
        format!("azimuth {azimuth_deg:.2}°, tilt {tilt_deg:.2}°")
    }
}

/// The leg's direction in words, if it is known.
#[must_use]
pub fn known_pose_words(telemetry: &Telemetry<f32>) -> String {
    if telemetry.homed {
        pose_words(telemetry.pose)
    } else {
        "not known before homing".into()
    }
}

/// The rows of a table for people.
#[must_use]
pub fn rows(telemetry: &Telemetry<f32>) -> String {
    let [a, b, c] = telemetry.tensions_n;
    let pose = known_pose_words(telemetry);
    let mut rows = format!(
        "state      {}\npose       {pose}\ntensions   {a:.1}  {b:.1}  {c:.1} N\n",
        description::state(telemetry.state)
    );
    if telemetry.pretension_n > 0.0 {
        rows += &format!(
            "pretension {:.1} N\nstiffness  {:.2} N·m/rad\npayload    {:.2} kg\n",
            telemetry.pretension_n, telemetry.stiffness_nm_per_rad, telemetry.payload_kg
        );
    }
    rows + &format!("faults     {}\n", description::faults(telemetry.faults))
}
