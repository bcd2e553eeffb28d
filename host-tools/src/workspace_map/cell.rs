//! What the model says of a pose: all that a map asks of it.

use crate::rig_file::RigFile;
use leg_model::{Error, Query, Rig, Survey, survey};
use serde::Serialize;

/// What the model says of a pose, for a map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Linear deviation at the rig's level, mm.
    pub deviation_mm: f64,
    /// Smallest bending stiffness, N·m/rad.
    pub stiffness_min_nm_per_rad: f64,
    /// Largest bending stiffness, N·m/rad.
    pub stiffness_max_nm_per_rad: f64,
    /// Largest by smallest bending stiffness.
    pub condition: f64,
    /// How far the tensions at the rig's level stay from their bounds, N; negative beyond them.
    pub margin_n: f64,
    /// Lowest level that keeps the bounds, N.
    pub level_min_n: f64,
    /// Highest level that keeps the bounds, N.
    pub level_max_n: f64,
    /// Whether any level keeps the bounds.
    pub feasible: bool,
}

/// A rig and its load, validated once for all poses.
pub(super) struct Prepared {
    rig: Rig<f64, 3>,
    /// At no pose yet.
    query: Query<f64>,
}

impl Prepared {
    pub fn new(rig: &RigFile, payload_kg: f64) -> Result<Self, Error> {
        Ok(Self {
            rig: Rig::new(&rig.parameters)?,
            query: rig.query(0.0, 0.0, payload_kg),
        })
    }

    /// All poses of one tilt.
    pub fn row(&self, tilt_deg: f64) -> Row<'_> {
        let tilt_rad = tilt_deg.to_radians();
        let query = Query {
            tilt_rad,
            ..self.query
        };
        Row {
            rig: &self.rig,
            query,
        }
    }
}

/// The poses of one tilt. It keeps a query of its own, which carries three whole curves: not to be made for each pose.
pub(super) struct Row<'a> {
    rig: &'a Rig<f64, 3>,
    query: Query<f64>,
}

impl Row<'_> {
    pub fn cell(&mut self, azimuth_deg: f64) -> Result<Cell, Error> {
        self.query.azimuth_rad = azimuth_deg.to_radians();
        survey(self.rig, &self.query).map(|found| Cell::of(&found, &self.query))
    }
}

impl Cell {
    fn of(found: &Survey<f64>, query: &Query<f64>) -> Self {
        let (floor, ceiling) = (query.tension_floor_n, query.tension_ceiling_n);
        let margins = found
            .tensions_n
            .map(|tension| (tension - floor).min(ceiling - tension));
        let [softest, stiffest] = found.bending_stiffness_nm_per_rad;
        let [lowest, highest] = found.level_range_n;
        Self {
            deviation_mm: found.deviation_m * 1000.0,
            stiffness_min_nm_per_rad: softest,
            stiffness_max_nm_per_rad: stiffest,
            condition: stiffest / softest,
            margin_n: margins.into_iter().fold(f64::INFINITY, f64::min),
            level_min_n: lowest,
            level_max_n: highest,
            feasible: lowest <= highest,
        }
    }
}
