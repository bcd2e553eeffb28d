//! The model over the whole workspace.

mod quantity;

pub use quantity::Quantity;

use crate::rig_file::RigFile;
use leg_model::{Error, Evaluation, evaluate};
use rayon::prelude::*;
use serde::Serialize;

/// How finely the workspace is covered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Grid {
    /// Columns: azimuths evenly from 0°, the full turn not repeated. At least 3.
    pub azimuths: u32,
    /// Rows: tilts evenly from the vertical to the edge. At least 2.
    pub tilts: u32,
}

/// What the model says of a pose, for a map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Linear deviation at the rig's level, mm.
    pub deviation_mm: f64,
    /// Smallest bending stiffness, N·m/rad.
    pub stiffness_min_nm_per_rad: f64,
    /// Largest bending stiffness, N·m/rad.
    pub stiffness_max_nm_per_rad: f64,
    /// How far the tensions at the rig's level stay from their bounds, N; negative beyond them.
    pub margin_n: f64,
    /// Lowest level that keeps the bounds, N.
    pub level_min_n: f64,
    /// Highest level that keeps the bounds, N.
    pub level_max_n: f64,
    /// Whether any level keeps the bounds.
    pub feasible: bool,
}

/// A rig over its workspace with a payload.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkspaceMap {
    /// The poses.
    pub grid: Grid,
    /// The greatest tilt, degrees.
    pub tilt_max_deg: f64,
    /// One a pose, row by row from the vertical; what the model says where it has no result.
    pub cells: Vec<Result<Cell, Error>>,
}

impl WorkspaceMap {
    /// Evaluates every pose on all cores, and calls `done` after each row.
    #[must_use]
    pub fn compute(rig: &RigFile, payload_kg: f64, grid: Grid, done: impl Fn() + Sync) -> Self {
        let rows = (0..grid.tilts).into_par_iter().map(|row| {
            let cells = row_of(rig, payload_kg, grid, row).collect::<Vec<_>>();
            done();
            cells
        });
        Self {
            grid,
            tilt_max_deg: rig.tilt_deg,
            cells: rows.flatten().collect(),
        }
    }

    /// The same on one core: what a benchmark measures.
    #[must_use]
    pub fn on_one_core(rig: &RigFile, payload_kg: f64, grid: Grid) -> Self {
        let rows = (0..grid.tilts).flat_map(|row| row_of(rig, payload_kg, grid, row));
        Self {
            grid,
            tilt_max_deg: rig.tilt_deg,
            cells: rows.collect(),
        }
    }

    /// Azimuth and tilt of each cell, degrees, and the cell.
    pub fn poses(&self) -> impl Iterator<Item = (f64, f64, &Result<Cell, Error>)> {
        let grid = self.grid;
        let poses = (0..grid.tilts)
            .flat_map(move |row| (0..grid.azimuths).map(move |column| (row, column)));
        poses.zip(&self.cells).map(move |((row, column), cell)| {
            let tilt = tilt_deg(self.tilt_max_deg, grid, row);
            (azimuth_deg(grid, column), tilt, cell)
        })
    }

    /// Poses at which some level keeps the bounds.
    #[must_use]
    pub fn feasible_count(&self) -> usize {
        let cells = self.cells.iter().flatten();
        cells.filter(|cell| cell.feasible).count()
    }
}

fn row_of(
    rig: &RigFile,
    payload_kg: f64,
    grid: Grid,
    row: u32,
) -> impl Iterator<Item = Result<Cell, Error>> {
    // Once a row: a query carries three whole curves.
    let mut query = rig.query(0.0, tilt_deg(rig.tilt_deg, grid, row), payload_kg);
    (0..grid.azimuths).map(move |column| {
        query.azimuth_rad = azimuth_deg(grid, column).to_radians();
        let evaluation = evaluate(&rig.parameters, &query)?;
        Ok(Cell::of(&evaluation, rig))
    })
}

fn azimuth_deg(grid: Grid, column: u32) -> f64 {
    360.0 * f64::from(column) / f64::from(grid.azimuths)
}

fn tilt_deg(edge_deg: f64, grid: Grid, row: u32) -> f64 {
    edge_deg * f64::from(row) / f64::from(grid.tilts - 1)
}

impl Cell {
    fn of(evaluation: &Evaluation<f64>, rig: &RigFile) -> Self {
        let e = evaluation;
        let (floor, ceiling) = (rig.tension_floor_n, rig.tension_ceiling_n);
        let margins = e
            .tensions_n
            .map(|tension| (tension - floor).min(ceiling - tension));
        Self {
            deviation_mm: e.deviation_m * 1000.0,
            stiffness_min_nm_per_rad: e.bending_stiffness_nm_per_rad[0],
            stiffness_max_nm_per_rad: e.bending_stiffness_nm_per_rad[1],
            margin_n: margins.into_iter().fold(f64::INFINITY, f64::min),
            level_min_n: e.level_range_n[0],
            level_max_n: e.level_range_n[1],
            feasible: e.feasible,
        }
    }

    /// Largest by smallest bending stiffness.
    #[must_use]
    pub fn condition(&self) -> f64 {
        self.stiffness_max_nm_per_rad / self.stiffness_min_nm_per_rad
    }
}

#[cfg(test)]
mod tests;
