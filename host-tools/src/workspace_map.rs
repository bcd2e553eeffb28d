//! The model over the whole workspace.

mod cell;
mod quantity;

pub use cell::Cell;
pub use quantity::Quantity;

use crate::rig_file::RigFile;
use cell::Prepared;
use leg_model::Error;
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
    /// One a pose, row by row from the vertical; what the model says where it has no result.
    pub cells: Vec<Result<Cell, Error>>,
}

impl WorkspaceMap {
    /// Evaluates every pose on all cores, and calls `done` after each row.
    #[must_use]
    pub fn compute(rig: &RigFile, payload_kg: f64, grid: Grid, done: impl Fn() + Sync) -> Self {
        let prepared = Prepared::new(rig, payload_kg);
        let rows = (0..grid.tilts).into_par_iter().map(|row| {
            let cells = row_of(&prepared, rig.tilt_deg, grid, row).collect::<Vec<_>>();
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
        let prepared = Prepared::new(rig, payload_kg);
        let rows = (0..grid.tilts).flat_map(|row| row_of(&prepared, rig.tilt_deg, grid, row));
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

    /// The reasons for which poses have no result, each with how many those are, the most frequent first.
    #[must_use]
    pub fn without_result(&self) -> Vec<(Error, usize)> {
        let mut reasons: Vec<(Error, usize)> = Vec::new();
        for error in self.cells.iter().filter_map(|cell| cell.as_ref().err()) {
            match reasons.iter_mut().find(|(reason, _)| reason == error) {
                Some((_, count)) => *count += 1,
                None => reasons.push((*error, 1)),
            }
        }
        reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        reasons
    }

    /// Where a quantity is smallest and largest; none if it counts at no pose.
    #[must_use]
    pub fn extremes(&self, quantity: Quantity) -> Option<[Extreme; 2]> {
        let extreme = |(azimuth_deg, tilt_deg, cell): (_, _, &Result<Cell, Error>)| {
            let value = quantity.of(cell.as_ref().ok()?)?;
            Some(Extreme {
                value,
                azimuth_deg,
                tilt_deg,
            })
        };
        let mut poses = self.poses().filter_map(extreme);
        let first = poses.next()?;
        Some(poses.fold([first; 2], |[smallest, largest], pose| {
            // Of those that are equal but for rounding the first: all azimuths are one pose at the vertical.
            let rounding = 1e-9 * pose.value.abs().max(1e-3);
            [
                if pose.value < smallest.value - rounding {
                    pose
                } else {
                    smallest
                },
                if pose.value > largest.value + rounding {
                    pose
                } else {
                    largest
                },
            ]
        }))
    }
}

/// An extreme value and the first pose that has it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extreme {
    /// In the quantity's unit.
    pub value: f64,
    /// Azimuth of the pose, degrees.
    pub azimuth_deg: f64,
    /// Its tilt, degrees.
    pub tilt_deg: f64,
}

fn row_of(
    prepared: &Result<Prepared, Error>,
    edge_deg: f64,
    grid: Grid,
    row: u32,
) -> impl Iterator<Item = Result<Cell, Error>> {
    let tilt_deg = tilt_deg(edge_deg, grid, row);
    let mut row = prepared.as_ref().map(|prepared| prepared.row(tilt_deg));
    (0..grid.azimuths).map(move |column| match &mut row {
        Ok(row) => row.cell(azimuth_deg(grid, column)),
        Err(error) => Err(**error),
    })
}

fn azimuth_deg(grid: Grid, column: u32) -> f64 {
    360.0 * f64::from(column) / f64::from(grid.azimuths)
}

fn tilt_deg(edge_deg: f64, grid: Grid, row: u32) -> f64 {
    edge_deg * f64::from(row) / f64::from(grid.tilts - 1)
}

#[cfg(test)]
mod tests;
