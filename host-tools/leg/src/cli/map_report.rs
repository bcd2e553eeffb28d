//! What `leg map` prints.

use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::paths::from_here;
use leg_model::Error;
use leg_model_tools::workspace_map::{AtPretension, Cell, Counts, Extreme, Quantity, WorkspaceMap};
use leg_rig::rig_file::RigFile;
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
            "Workspace to {}° with {} kg, pretension {} N, support {}\n\n",
            rig.tilt_deg,
            self.payload_kg,
            rig.pretension_n,
            rig.support_name.word()
        );
        let rows = self.map.quantities().iter();
        let rows: String = rows.map(|quantity| self.row(*quantity)).collect();
        title + HEADING + &rows + &self.counts() + &self.remarks()
    }

    fn row(&self, quantity: Quantity) -> String {
        let Some([smallest, largest]) = self.map.extremes(quantity) else {
            return format!("{:<26} at no pose\n", quantity.words());
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

    fn counts(&self) -> String {
        let counts = self.map.counts();
        let share = 100.0 * counts.feasible as f64 / counts.poses as f64;
        let pretension_n = self.rig.pretension_n;
        format!(
            "\nFeasible: {} of {} poses ({share:.1} %), {} at pretension {pretension_n} N and {} only at another\n",
            counts.feasible,
            counts.poses,
            counts.pretension_keeps_bounds,
            counts.only_another_pretension
        )
    }

    fn remarks(&self) -> String {
        let pretension_n = self.rig.pretension_n;
        let at_pretension = format!("No result at pretension {pretension_n} N");
        let missing = [
            ("No result", self.map.without_result()),
            (at_pretension.as_str(), self.map.without_pretension()),
            ("No nonlinear deviation", self.map.without_nonlinear()),
        ];
        let lines = |(what, reasons): (&str, Vec<(Error, usize)>)| -> String {
            let line = |(reason, count)| format!("{what} at {count} of the poses: {reason}\n");
            reasons.into_iter().map(line).collect()
        };
        let missing = missing.map(lines).concat();
        let picture = |path: &PathBuf| format!("  {}\n", from_here(path).display());
        let pictures: String = self.pictures.iter().map(picture).collect();
        let csv = |path| format!("CSV: {}\n", from_here(path).display());
        let csv = self.csv.map(csv).unwrap_or_default();
        format!("{missing}Pictures, each as .svg and .png:\n{pictures}{csv}")
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
                at_pretension: cell.as_ref().ok().and_then(|cell| cell.at_pretension.ok()),
                deviation_nonlinear_mm: cell
                    .as_ref()
                    .ok()
                    .and_then(|cell| Quantity::DeviationNonlinear.value(cell)),
                error: cell
                    .and_then(|cell| cell.at_pretension)
                    .err()
                    .map(|error| error.to_string()),
            });
        let quantities = self.map.quantities().iter();
        let report = JsonReport {
            support: self.rig.support_name.word(),
            payload_kg: self.payload_kg,
            pretension_n: self.rig.pretension_n,
            counts: self.map.counts(),
            extremes: quantities
                .map(|quantity| self.extremes(*quantity))
                .collect(),
            pictures: self.pictures,
            poses: poses.collect(),
        };
        to_line(&report)
    }
}

#[derive(Serialize)]
struct JsonReport<'a> {
    support: &'static str,
    payload_kg: f64,
    pretension_n: f64,
    #[serde(flatten)]
    counts: Counts,
    extremes: Vec<JsonExtremes>,
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
    #[serde(flatten)]
    at_pretension: Option<AtPretension>,
    #[serde(skip_serializing_if = "Option::is_none")]
    deviation_nonlinear_mm: Option<f64>,
    /// Why there is nothing at the rig's pretension or nothing at all.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}
