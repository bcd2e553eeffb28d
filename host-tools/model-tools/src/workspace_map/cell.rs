//! What the model says of a pose: all that a map asks of it.

use crate::nonlinear;
use leg_model::{Error, MapEvaluation, Query, Rig, RigParameters, evaluate_for_map};
use leg_rig::rig_file::RigFile;
use serde::Serialize;

/// What the model says of a pose, for a map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Whether any pretension keeps the bounds.
    pub feasible: bool,
    /// Whether the rig's pretension does.
    pub pretension_keeps_bounds: bool,
    /// Lowest pretension that keeps the bounds, N; above the highest where none does.
    pub pretension_min_n: f64,
    /// Highest pretension that keeps the bounds, N.
    pub pretension_max_n: f64,
    /// How far the rig's pretension is inside that range, N; negative outside.
    #[serde(skip)]
    pub pretension_room_n: f64,
    /// How far the tensions at the rig's pretension stay from their bounds, N; negative beyond them. None where nothing
    /// holds the leg at that pretension.
    pub margin_n: Option<f64>,
    /// What the leg does at the rig's pretension, whether or not that keeps the bounds; why that is not known.
    #[serde(skip)]
    pub at_pretension: Result<PretensionedPose, Error>,
    /// Nonlinear deviation at the rig's pretension, mm, or why there is none. Not there if it was not asked for, if there is
    /// no linear one, or if the pretension would have a tendon push before the weights come.
    #[serde(skip)]
    pub deviation_nonlinear_mm: Option<Result<f64, Error>>,
}

/// What the leg does at the rig's pretension.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PretensionedPose {
    /// Linear deviation, mm.
    pub deviation_mm: f64,
    /// Smallest bending stiffness, N·m/rad.
    pub stiffness_min_nm_per_rad: f64,
    /// Largest bending stiffness, N·m/rad.
    pub stiffness_max_nm_per_rad: f64,
    /// Largest by smallest bending stiffness.
    pub condition: f64,
}

/// A rig and its load, validated once for all poses.
pub(super) struct PreparedMap {
    parameters: RigParameters<f64, 3>,
    rig: Rig<f64, 3>,
    /// At no pose yet.
    query: Query<f64>,
    with_nonlinear: bool,
}

impl PreparedMap {
    pub fn new(rig: &RigFile, payload_kg: f64, with_nonlinear: bool) -> Result<Self, Error> {
        Ok(Self {
            parameters: rig.parameters,
            rig: Rig::new(&rig.parameters)?,
            query: rig.query(0.0, 0.0, payload_kg),
            with_nonlinear,
        })
    }

    /// The cells of one tilt.
    pub fn row(
        &self,
        tilt_deg: f64,
        azimuths_deg: impl Iterator<Item = f64>,
    ) -> impl Iterator<Item = Result<Cell, Error>> {
        // It carries three whole curves: not to be made for each pose.
        let mut query = self.query;
        query.tilt_rad = tilt_deg.to_radians();
        azimuths_deg.map(move |azimuth_deg| {
            query.azimuth_rad = azimuth_deg.to_radians();
            self.cell(&query)
        })
    }

    fn cell(&self, query: &Query<f64>) -> Result<Cell, Error> {
        #[cfg(test)]
        super::tests::count_evaluation();
        let found = evaluate_for_map(&self.rig, query)?;
        let mut cell = Cell::new(&found, query);
        if self.with_nonlinear && cell.at_pretension.is_ok() {
            let deviation_m = nonlinear::deviation_m(&self.parameters, query);
            let deviation_m = deviation_m.transpose();
            cell.deviation_nonlinear_mm = deviation_m.map(|found| found.map(|m| m * 1000.0));
        }
        Ok(cell)
    }
}

impl Cell {
    fn new(found: &MapEvaluation<f64>, query: &Query<f64>) -> Self {
        let (f_min_n, f_max_n) = (query.f_min_n, query.f_max_n);
        let margin = |tensions: [f64; 3]| {
            let margins = tensions.map(|tension| (tension - f_min_n).min(f_max_n - tension));
            margins.into_iter().fold(f64::INFINITY, f64::min)
        };
        let [lowest, highest] = found.pretension_range_n;
        let pretension_room_n = (query.pretension_n - lowest).min(highest - query.pretension_n);
        Self {
            feasible: lowest <= highest,
            pretension_keeps_bounds: pretension_room_n >= 0.0 && found.tensions_n.is_ok(),
            pretension_min_n: lowest,
            pretension_max_n: highest,
            pretension_room_n,
            margin_n: found.tensions_n.ok().map(margin),
            at_pretension: PretensionedPose::new(found),
            deviation_nonlinear_mm: None,
        }
    }
}

impl PretensionedPose {
    fn new(found: &MapEvaluation<f64>) -> Result<Self, Error> {
        let [softest, stiffest] = found.bending_stiffness_nm_per_rad?;
        Ok(Self {
            deviation_mm: found.deviation_m? * 1000.0,
            stiffness_min_nm_per_rad: softest,
            stiffness_max_nm_per_rad: stiffest,
            condition: stiffest / softest,
        })
    }
}
