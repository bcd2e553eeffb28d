//! What `leg map` prints.

use crate::failure::Failure;
use crate::paths::from_here;
use crate::rig_file::RigFile;
use crate::workspace_map::{Cell, Extreme, Quantity, WorkspaceMap};
use serde::Serialize;
use std::path::{Path, PathBuf};

const HEADING: &str = "\
quantity                     smallest at (azimuth, tilt)        largest at (azimuth, tilt)  unit
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
        let Some([smallest, largest]) = self.map.extremes(quantity) else {
            return format!("{:<26} at no feasible pose\n", quantity.words());
        };
        let place = |at: &Extreme| {
            let (azimuth, tilt) = (at.azimuth_deg, at.tilt_deg);
            format!(
                "{:>10.3} {:>16}",
                at.value,
                format!("({azimuth:.1}°, {tilt:.1}°)")
            )
        };
        let row = format!(
            "{:<26} {}      {}  {}",
            quantity.words(),
            place(&smallest),
            place(&largest),
            quantity.unit()
        );
        format!("{}\n", row.trim_end())
    }

    fn remarks(&self) -> String {
        let (feasible, all) = (self.map.feasible_count(), self.map.cells.len());
        let share = 100.0 * feasible as f64 / all as f64;
        let pictures: String = self
            .pictures
            .iter()
            .map(|path| format!("  {}\n", from_here(path).display()))
            .collect();
        let without = self.map.without_result();
        let without: String = without
            .iter()
            .map(|(reason, count)| format!("No result at {count} poses: {reason}\n"))
            .collect();
        let csv = self
            .csv
            .map(|path| format!("CSV: {}\n", from_here(path).display()));
        format!(
            "\nFeasible: {feasible} of {all} poses ({share:.1} %)\n{without}Pictures, each as .svg and .png:\n{pictures}{}",
            csv.unwrap_or_default()
        )
    }

    fn extremes(&self, quantity: Quantity) -> JsonExtremes {
        let [smallest, largest] = self
            .map
            .extremes(quantity)
            .map_or([None; 2], |e| e.map(Some));
        JsonExtremes {
            quantity,
            unit: quantity.unit(),
            smallest,
            largest,
        }
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
            extremes: Quantity::ALL.map(|quantity| self.extremes(quantity)),
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
    extremes: [JsonExtremes; Quantity::ALL.len()],
    pictures: &'a [PathBuf],
    poses: Vec<JsonPose<'a>>,
}

#[derive(Serialize)]
struct JsonExtremes {
    quantity: Quantity,
    unit: &'static str,
    smallest: Option<Extreme>,
    largest: Option<Extreme>,
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
