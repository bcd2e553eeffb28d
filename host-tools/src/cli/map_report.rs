//! What `leg map` prints.

use crate::failure::Failure;
use crate::paths::from_here;
use crate::rig_file::RigFile;
use crate::workspace_map::{Cell, Quantity, WorkspaceMap};
use serde::Serialize;
use std::path::{Path, PathBuf};

const HEADING: &str = "\
quantity                     smallest       largest  unit      largest at
";

/// Everything that `leg map` found.
pub(super) struct Report<'a> {
    pub(super) rig: &'a RigFile,
    pub(super) payload_kg: f64,
    pub(super) map: &'a WorkspaceMap,
    pub(super) pictures: &'a [PathBuf],
    pub(super) csv: Option<&'a Path>,
}

impl Report<'_> {
    /// A table for people.
    pub(super) fn table(&self) -> String {
        let rig = self.rig;
        let title = format!(
            "Workspace to {}° with {} kg, level {} N, support {}\n\n",
            rig.tilt_deg,
            self.payload_kg,
            rig.level_n,
            rig.support_name.word()
        );
        let rows = Quantity::ALL.map(|quantity| self.row(quantity)).concat();
        title + HEADING + &rows + &self.remarks()
    }

    fn row(&self, quantity: Quantity) -> String {
        let poses = self.map.poses().filter_map(|(azimuth, tilt, cell)| {
            let value = quantity.of(cell.as_ref().ok()?)?;
            Some((value, azimuth, tilt))
        });
        let poses: Vec<_> = poses.collect();
        let smallest = poses
            .iter()
            .map(|(value, ..)| *value)
            .fold(f64::INFINITY, f64::min);
        let most = poses
            .iter()
            .map(|(value, ..)| *value)
            .fold(f64::NEG_INFINITY, f64::max);
        // Of those that are equal but for rounding the first: all azimuths are one pose at the vertical.
        let (largest, azimuth, tilt) = poses
            .into_iter()
            .find(|(value, ..)| most - value <= 1e-9 * most.abs())
            .unwrap_or((f64::NAN, 0.0, 0.0));
        format!(
            "{:<26} {smallest:>10.3}    {largest:>10.3}  {:<8}  azimuth {azimuth:.1}°, tilt {tilt:.1}°\n",
            quantity.words(),
            quantity.unit(),
        )
    }

    fn remarks(&self) -> String {
        let (feasible, all) = (self.map.feasible_count(), self.map.cells.len());
        let share = 100.0 * feasible as f64 / all as f64;
        let pictures: String = self
            .pictures
            .iter()
            .map(|path| format!("  {}\n", from_here(path).display()))
            .collect();
        let csv = self
            .csv
            .map(|path| format!("CSV: {}\n", from_here(path).display()));
        format!(
            "\nFeasible: {feasible} of {all} poses ({share:.1} %)\nPictures, each as .svg and .png:\n{pictures}{}",
            csv.unwrap_or_default()
        )
    }

    /// One line of JSON for machines.
    pub(super) fn json(&self) -> Result<String, Failure> {
        let poses = self
            .map
            .poses()
            .map(|(azimuth_deg, tilt_deg, cell)| JsonPose {
                azimuth_deg,
                tilt_deg,
                cell: cell.as_ref().ok(),
                error: cell.as_ref().err().map(ToString::to_string),
            });
        let report = JsonReport {
            support: self.rig.support_name.word(),
            payload_kg: self.payload_kg,
            level_n: self.rig.level_n,
            feasible: self.map.feasible_count(),
            pictures: self.pictures,
            poses: poses.collect(),
        };
        match serde_json::to_string(&report) {
            Ok(json) => Ok(json + "\n"),
            Err(error) => Err(Failure::from_error(&error)),
        }
    }
}

#[derive(Serialize)]
struct JsonReport<'a> {
    support: &'static str,
    payload_kg: f64,
    level_n: f64,
    feasible: usize,
    pictures: &'a [PathBuf],
    poses: Vec<JsonPose<'a>>,
}

#[derive(Serialize)]
struct JsonPose<'a> {
    azimuth_deg: f64,
    tilt_deg: f64,
    #[serde(flatten)]
    cell: Option<&'a Cell>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}
