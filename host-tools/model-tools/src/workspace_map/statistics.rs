//! Statistics of a map: how many poses are feasible, and where a quantity is smallest and largest.

use super::{Cell, MapQuantity, WorkspaceMap};
use clap::ValueEnum;
use leg_model::Error;
use serde::Serialize;

/// How many poses keep the bounds. The vertical is one pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// All poses.
    #[serde(skip)]
    pub poses: usize,
    /// Those at which some pretension keeps the bounds.
    pub feasible: usize,
    /// Those at which the rig's pretension does.
    pub pretension_keeps_bounds: usize,
    /// Those at which only another pretension does.
    pub only_another_pretension: usize,
}

impl WorkspaceMap {
    /// How many poses keep the bounds.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let count = |counts: fn(&Cell) -> bool| {
            let cells = self.cells.iter().flatten();
            cells.filter(|cell| counts(cell)).count()
        };
        Counts {
            poses: self.cells.len(),
            feasible: count(|cell| cell.feasible),
            pretension_keeps_bounds: count(|cell| cell.pretension_keeps_bounds),
            only_another_pretension: count(|cell| cell.feasible && !cell.pretension_keeps_bounds),
        }
    }

    /// The quantities that it has.
    #[must_use]
    pub fn quantities(&self) -> &'static [MapQuantity] {
        if self.with_nonlinear {
            MapQuantity::value_variants()
        } else {
            MapQuantity::plain()
        }
    }

    /// The reasons for which poses have no result at any pretension, each with how many those are, the most frequent first.
    #[must_use]
    pub fn reasons_for_no_result(&self) -> Vec<(Error, usize)> {
        count_reasons(self.cells.iter().filter_map(|cell| cell.err()))
    }

    /// The same of poses that have none at the rig's pretension alone.
    #[must_use]
    pub fn reasons_for_no_pretension(&self) -> Vec<(Error, usize)> {
        let cells = self.cells.iter().flatten();
        count_reasons(cells.filter_map(|cell| cell.at_pretension.err()))
    }

    /// The same of poses that have no nonlinear deviation although it was asked for.
    #[must_use]
    pub fn reasons_for_no_nonlinear(&self) -> Vec<(Error, usize)> {
        let cells = self.cells.iter().flatten();
        count_reasons(cells.filter_map(|cell| cell.deviation_nonlinear_mm?.err()))
    }

    /// Where a quantity is smallest and largest; none if it counts at no pose.
    #[must_use]
    pub fn extremes(&self, quantity: MapQuantity) -> Option<[Extreme; 2]> {
        let extreme = |(azimuth_deg, tilt_deg, cell): (_, _, &Result<Cell, Error>)| {
            let value = quantity.counted_value(cell.as_ref().ok()?)?;
            Some(Extreme {
                value,
                azimuth_deg,
                tilt_deg,
            })
        };
        let mut poses = self.poses().filter_map(extreme);
        let first = poses.next()?;
        Some(poses.fold([first; 2], |[smallest, largest], pose| {
            // Of those that are equal but for rounding the first: a symmetric rig has several.
            let rounding = 1e-9 * pose.value.abs().max(1e-3);
            let smaller = pose.value < smallest.value - rounding;
            let larger = pose.value > largest.value + rounding;
            [
                if smaller { pose } else { smallest },
                if larger { pose } else { largest },
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

fn count_reasons(errors: impl Iterator<Item = Error>) -> Vec<(Error, usize)> {
    let mut reasons: Vec<(Error, usize)> = Vec::new();
    for error in errors {
        match reasons.iter_mut().find(|(reason, _)| *reason == error) {
            Some((_, count)) => *count += 1,
            None => reasons.push((error, 1)),
        }
    }
    reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    reasons
}
