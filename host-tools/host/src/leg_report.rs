//! The leg in a user's units.

use leg_base::tick_time::seconds;
use leg_base::{angles, description, json_object};
use leg_firmware::supervisor::Fault;
use leg_firmware::telemetry::Telemetry;
use serde::Serialize;

/// Tilt below which an azimuth means nothing, degrees.
const UPRIGHT_DEG: f64 = 0.05;

/// The leg for machines.
pub fn json(telemetry: &Telemetry<f32>) -> impl Serialize + use<> {
    let [azimuth_deg, tilt_deg] = angles_deg(telemetry.pose);
    let [azimuth_commanded_deg, tilt_commanded_deg] = angles_deg(telemetry.commanded);
    let fault = |fault: Fault| {
        let entry = fault.entry();
        json_object! {
            code: fault.code(),
            fault: fault,
            // In words.
            name: entry.name,
            cause: entry.cause,
            remedy: entry.remedy,
        }
    };
    json_object! {
        // What it may do.
        state: description::state(telemetry.state),
        faults: telemetry.faults.faults().map(fault).collect::<Vec<_>>(),
        // Whether its zero is known.
        homed: telemetry.homed,
        // Where it was sent to lean, 0 to 360°; where it is led after a hold and before the first move.
        azimuth_commanded_deg: azimuth_commanded_deg,
        // How far.
        tilt_commanded_deg: tilt_commanded_deg,
        // Where it is estimated to lean, 0 to 360°.
        azimuth_deg: azimuth_deg,
        // How far.
        tilt_deg: tilt_deg,
        // Measured tensions, N.
        tensions_n: telemetry.tensions_n,
        // Commanded pretension, N; none where a stiffness was commanded.
        pretension_commanded_n: telemetry.pretension_commanded_n,
        // Commanded bending stiffness, N·m/rad; none where a pretension was commanded.
        stiffness_commanded_nm_per_rad: telemetry.stiffness_commanded_nm_per_rad,
        // Pretension of the last target, N; 0 before the first.
        pretension_n: telemetry.pretension_n,
        // Bending stiffness at that pretension, N·m/rad.
        stiffness_nm_per_rad: telemetry.stiffness_nm_per_rad,
        // Load beyond the leg's own weight, N·m.
        load_nm: telemetry.load_nm,
        // The payload that this load would be, kg.
        payload_kg: telemetry.payload_kg,
        // Time of the leg since its board started, s.
        time_s: seconds(telemetry.tick.into()),
    }
}

/// Azimuth (0 to 360) and tilt of a direction, degrees, to a ten-thousandth.
pub fn angles_deg([x, y]: [f32; 2]) -> [f64; 2] {
    angles::angles_deg([x, y].map(f64::from))
}

/// A direction in words.
pub fn pose_words(pose: [f32; 2]) -> String {
    let [azimuth_deg, tilt_deg] = angles_deg(pose);
    // What rounds to a whole turn is none.
    let azimuth_deg = if azimuth_deg >= 359.995 {
        0.0
    } else {
        azimuth_deg
    };
    if tilt_deg < UPRIGHT_DEG {
        "straight down".into()
    } else {
        format!("azimuth {azimuth_deg:.2}°, tilt {tilt_deg:.2}°")
    }
}

/// The leg's direction in words, if it is known.
pub fn known_pose_words(telemetry: &Telemetry<f32>) -> String {
    if telemetry.homed {
        pose_words(telemetry.pose)
    } else {
        "not known before homing".into()
    }
}

/// The leg for people, as the rows of a table.
pub fn text(telemetry: &Telemetry<f32>) -> String {
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
