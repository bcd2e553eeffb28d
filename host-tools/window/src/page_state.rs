//! What the window shows, as data: for tests, and for those who hear the page.

use crate::places::Places;
use crate::simulation::Simulation;
use leg_base::angles;
use leg_base::description;
use serde::Serialize;
use std::collections::BTreeMap;

/// The window at a time.
#[derive(Debug, Serialize)]
pub struct PageState {
    /// The leg; none if there is none.
    leg: Option<LegState>,
    /// Left, top, right and bottom of each control, points.
    places: BTreeMap<&'static str, [f32; 4]>,
    /// Frames since the start.
    frames: u64,
    /// Time that the processor took for the last one, ms.
    frame_ms: Option<f32>,
    /// What a reader of the screen says.
    spoken: String,
}

#[derive(Debug, Serialize)]
struct LegState {
    time_s: f64,
    /// Time of the clock that was left out, s.
    left_out_s: f64,
    state: &'static str,
    faults: Vec<&'static str>,
    refusal: Option<String>,
    compensated: bool,
    payload_kg: f64,
    error_mm: f64,
    azimuth_deg: f64,
    tilt_deg: f64,
    tensions_n: [f64; 3],
    failure: Option<String>,
}

impl PageState {
    /// Of a window.
    #[must_use]
    pub fn new(
        simulation: Option<&Simulation>,
        places: &Places,
        frames: u64,
        frame_s: Option<f32>,
    ) -> Self {
        let places = places.iter().map(|(name, rect)| {
            let edges = [rect.left(), rect.top(), rect.right(), rect.bottom()];
            (*name, edges)
        });
        let leg = simulation.map(LegState::new);
        let spoken = leg
            .as_ref()
            .map_or_else(|| "There is no leg.".into(), LegState::spoken);
        Self {
            leg,
            places: places.collect(),
            frames,
            frame_ms: frame_s.map(|time_s| 1000.0 * time_s),
            spoken,
        }
    }
}

impl LegState {
    fn new(simulation: &Simulation) -> Self {
        let leg = simulation.leg();
        let along = leg.truth().direction.vector();
        let [azimuth_deg, tilt_deg] = angles::angles_deg([along.x, along.y]);
        let faults = simulation.faults().faults();
        Self {
            time_s: leg.time_s(),
            left_out_s: simulation.pace.left_out_s(),
            state: description::state(simulation.state()),
            faults: faults.map(|fault| fault.entry().name).collect(),
            refusal: simulation.refusal().map(Into::into),
            compensated: simulation.compensated(),
            payload_kg: leg.truth().payload_kg,
            error_mm: leg.comparison().commanded_error_mm(),
            azimuth_deg,
            tilt_deg,
            tensions_n: leg.truth().tensions_n,
            failure: simulation.failure().map(ToString::to_string),
        }
    }

    fn spoken(&self) -> String {
        let faults = if self.faults.is_empty() {
            "none".into()
        } else {
            self.faults.join(", ")
        };
        format!("The leg is {}. Faults: {faults}.", self.state)
    }
}
