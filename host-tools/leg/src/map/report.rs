//! What `leg map` prints.

use leg_base::paths::relative_path;
use leg_model::Error;
use leg_model_tools::workspace_map::{
    AtPretension, Cell, Counts, Extreme, MapQuantity, WorkspaceMap,
};
use leg_rig::rig_file::RigFile;
use serde::{Serialize, Serializer};
use std::path::{Path, PathBuf};

const HEADING: &str = "\
quantity                      smallest at (azimuth, tilt)        largest at (azimuth, tilt)  unit
";

/// Everything that `leg map` found.
#[derive(Serialize)]
pub(super) struct MapReport<'a> {
    support: &'static str,
    payload_kg: f64,
    pretension_n: f64,
    #[serde(flatten)]
    counts: Counts,
    extremes: Vec<QuantityExtremes>,
    pictures: &'a [PathBuf],
    #[serde(rename = "poses", serialize_with = "serialize_poses")]
    map: &'a WorkspaceMap,
}

#[derive(Serialize)]
struct QuantityExtremes {
    quantity: MapQuantity,
    unit: &'static str,
    smallest: Option<Extreme>,
    largest: Option<Extreme>,
}

#[derive(Serialize)]
struct MapPose<'a> {
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

impl QuantityExtremes {
    fn new(map: &WorkspaceMap, quantity: MapQuantity) -> Self {
        let [smallest, largest] = map.extremes(quantity).map_or([None; 2], |e| e.map(Some));
        Self {
            quantity,
            unit: quantity.unit(),
            smallest,
            largest,
        }
    }

    fn row(&self) -> String {
        let (Some(smallest), Some(largest)) = (&self.smallest, &self.largest) else {
            return format!("{:<27} at no pose\n", self.quantity.words());
        };
        let place = |at: &Extreme| {
            let (azimuth, tilt) = (at.azimuth_deg, at.tilt_deg);
            let pose = format!("({azimuth:.1}°, {tilt:.1}°)");
            format!("{:>10.3} {pose:>16}", at.value)
        };
        let row = format!(
            "{:<27} {}      {}  {}",
            self.quantity.words(),
            place(smallest),
            place(largest),
            self.unit
        );
        format!("{}\n", row.trim_end())
    }
}

impl<'a> MapPose<'a> {
    fn new(azimuth_deg: f64, tilt_deg: f64, found: &'a Result<Cell, Error>) -> Self {
        let cell = found.as_ref().ok();
        let error = found.as_ref().map_or_else(
            |error| Some(*error),
            |cell| cell.at_pretension.as_ref().err().copied(),
        );
        Self {
            azimuth_deg,
            tilt_deg,
            cell,
            at_pretension: cell.and_then(|cell| cell.at_pretension.ok()),
            deviation_nonlinear_mm: cell
                .and_then(|cell| MapQuantity::DeviationNonlinear.value(cell)),
            error: error.map(|error| error.to_string()),
        }
    }
}

/// One pose after the other: a map can have ten million.
fn serialize_poses<S: Serializer>(map: &WorkspaceMap, serializer: S) -> Result<S::Ok, S::Error> {
    let poses = map.poses();
    serializer.collect_seq(poses.map(|(azimuth, tilt, cell)| MapPose::new(azimuth, tilt, cell)))
}

impl<'a> MapReport<'a> {
    pub(super) fn new(
        rig: &RigFile,
        payload_kg: f64,
        map: &'a WorkspaceMap,
        pictures: &'a [PathBuf],
    ) -> Self {
        let quantities = map.quantities().iter();
        Self {
            support: rig.support_name.word(),
            payload_kg,
            pretension_n: rig.pretension_n,
            counts: map.counts(),
            extremes: quantities
                .map(|one| QuantityExtremes::new(map, *one))
                .collect(),
            pictures,
            map,
        }
    }

    /// A table for people.
    pub(super) fn table(&self, csv: Option<&Path>) -> String {
        let title = format!(
            "Workspace to {}° with {} kg, pretension {} N, support {}\n\n",
            self.map.tilt_max_deg, self.payload_kg, self.pretension_n, self.support
        );
        let rows: String = self.extremes.iter().map(QuantityExtremes::row).collect();
        title + HEADING + &rows + &self.counts() + &self.missing() + &self.files(csv)
    }

    fn counts(&self) -> String {
        let counts = &self.counts;
        let share = 100.0 * counts.feasible as f64 / counts.poses as f64;
        format!(
            "\nFeasible: {} of {} poses ({share:.1} %), {} at pretension {} N and {} only at another\n",
            counts.feasible,
            counts.poses,
            counts.pretension_keeps_bounds,
            self.pretension_n,
            counts.only_another_pretension
        )
    }

    fn missing(&self) -> String {
        let at_pretension = format!("No result at pretension {} N", self.pretension_n);
        let missing = [
            ("No result", self.map.without_result()),
            (at_pretension.as_str(), self.map.without_pretension()),
            ("No nonlinear deviation", self.map.without_nonlinear()),
        ];
        let lines = |(what, reasons): (&str, Vec<(Error, usize)>)| -> String {
            let line = |(reason, count)| format!("{what} at {count} of the poses: {reason}\n");
            reasons.into_iter().map(line).collect()
        };
        missing.map(lines).concat()
    }

    fn files(&self, csv: Option<&Path>) -> String {
        let picture = |path: &PathBuf| format!("  {}\n", relative_path(path).display());
        let pictures: String = self.pictures.iter().map(picture).collect();
        let csv = csv.map(|path| format!("CSV: {}\n", relative_path(path).display()));
        let csv = csv.unwrap_or_default();
        format!("Pictures, each as .svg and .png:\n{pictures}{csv}")
    }
}
