//! How a simulated leg starts, by the arguments of its constructor.

use crate::arguments;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

/// Slack of a leg that has to be homed, mm: that of `leg emulate --slack`.
const SLACK_MM: f64 = 3.0;

/// A slack leg, or one that leans: azimuth and tilt, degrees, with a payload, kg. The pretension, N, is the rig's if none is given.
pub fn start(
    rig: &RigFile,
    slack: bool,
    [azimuth_deg, tilt_deg, payload_kg]: [f64; 3],
    pretension_n: Option<f64>,
) -> PyResult<Start> {
    if slack {
        let given = [azimuth_deg, tilt_deg, payload_kg]
            .iter()
            .any(|value| *value != 0.0);
        if given || pretension_n.is_some() {
            return Err(PyValueError::new_err(
                "slack is given: such a leg hangs straight down, without payload and pretension",
            ));
        }
        return Ok(Start::Slack { slack_mm: SLACK_MM });
    }
    let pretension_n = pretension_n.unwrap_or(rig.pretension_n);
    let start = json!({ "held": {
        "azimuth_deg": arguments::finite("azimuth_deg", azimuth_deg)?,
        "tilt_deg": arguments::finite("tilt_deg", tilt_deg)?,
        "pretension_n": arguments::finite("pretension_n", pretension_n)?,
        "payload_kg": arguments::finite("payload_kg", payload_kg)?,
    }});
    arguments::read(&start)
}
