//! The model over the whole workspace.

mod cell;
mod quantity;
mod statistics;

pub use cell::{Cell, PretensionedPose};
pub use quantity::MapQuantity;
pub use statistics::{Counts, Extreme};

use cell::PreparedMap;
use leg_model::Error;
use leg_rig::rig_file::RigFile;
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

/// A rig over its workspace with a payload.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkspaceMap {
    /// The poses.
    pub grid: Grid,
    /// The greatest tilt, degrees.
    pub tilt_max_deg: f64,
    /// Whether the nonlinear deviation was computed.
    pub with_nonlinear: bool,
    /// One a pose: the vertical, which is the same at every azimuth, then row by row; why there is no result.
    pub cells: Vec<Result<Cell, Error>>,
}

impl WorkspaceMap {
    /// Evaluates every pose on all cores, and calls `done` after each row. The nonlinear deviation, if it is asked for,
    /// takes far longer than all the rest.
    #[must_use]
    pub fn compute(
        rig: &RigFile,
        payload_kg: f64,
        grid: Grid,
        with_nonlinear: bool,
        done: impl Fn() + Sync,
    ) -> Self {
        let prepared = PreparedMap::new(rig, payload_kg, with_nonlinear);
        let rows = (0..grid.tilts).into_par_iter().map(|row| {
            let cells = row_of(&prepared, rig.tilt_deg, grid, row);
            done();
            cells
        });
        Self {
            grid,
            tilt_max_deg: rig.tilt_deg,
            with_nonlinear,
            cells: rows.flatten().collect(),
        }
    }

    /// [`compute`](Self::compute) on one core: what a benchmark measures.
    #[must_use]
    pub fn compute_on_one_core(rig: &RigFile, payload_kg: f64, grid: Grid) -> Self {
        let prepared = PreparedMap::new(rig, payload_kg, false);
        let rows = (0..grid.tilts).flat_map(|row| row_of(&prepared, rig.tilt_deg, grid, row));
        Self {
            grid,
            tilt_max_deg: rig.tilt_deg,
            with_nonlinear: false,
            cells: rows.collect(),
        }
    }

    /// Azimuth and tilt of each pose, degrees, and its cell. The vertical comes once, at azimuth 0°.
    pub fn poses(&self) -> impl Iterator<Item = (f64, f64, &Result<Cell, Error>)> {
        let grid = self.grid;
        let poses = (0..grid.tilts)
            .flat_map(move |row| columns(grid, row).map(move |column| (row, column)));
        poses
            .zip(&self.cells)
            .map(move |((row, column), cell)| (azimuth_deg(grid, column), self.tilt_deg(row), cell))
    }

    /// The tilt of a row, degrees.
    #[must_use]
    pub fn tilt_deg(&self, row: u32) -> f64 {
        tilt_deg(self.tilt_max_deg, self.grid, row)
    }
}

fn row_of(
    prepared: &Result<PreparedMap, Error>,
    edge_deg: f64,
    grid: Grid,
    row: u32,
) -> Vec<Result<Cell, Error>> {
    let azimuths_deg = move || columns(grid, row).map(move |column| azimuth_deg(grid, column));
    let tilt_deg = tilt_deg(edge_deg, grid, row);
    match prepared {
        Ok(prepared) => prepared.row(tilt_deg, azimuths_deg()).collect(),
        Err(error) => azimuths_deg().map(|_| Err(*error)).collect(),
    }
}

/// The poses of a row: the vertical is one.
fn columns(grid: Grid, row: u32) -> std::ops::Range<u32> {
    0..if row == 0 { 1 } else { grid.azimuths }
}

fn azimuth_deg(grid: Grid, column: u32) -> f64 {
    360.0 * f64::from(column) / f64::from(grid.azimuths)
}

fn tilt_deg(edge_deg: f64, grid: Grid, row: u32) -> f64 {
    edge_deg * f64::from(row) / f64::from(grid.tilts - 1)
}

#[cfg(test)]
mod tests;
