//! What `leg map` prints.

use leg_base::json_object;
use leg_base::paths::relative_path;
use leg_model::Error;
use leg_model_tools::workspace_map::{Cell, Extreme, MapQuantity, WorkspaceMap};
use leg_rig::rig_file::RigFile;
use serde::{Serialize, Serializer};
use std::path::{Path, PathBuf};

const HEADING: &str = "\
quantity                      smallest at (azimuth, tilt)        largest at (azimuth, tilt)  unit
";

/// Everything that `leg map` found.
pub(super) struct MapReport<'a> {
    pub(super) rig: &'a RigFile,
    pub(super) payload_kg: f64,
    pub(super) map: &'a WorkspaceMap,
    pub(super) pictures: &'a [PathBuf],
    /// Those of every quantity of the map.
    pub(super) extremes: Vec<QuantityExtremes>,
}

/// Where a quantity is smallest and largest.
#[derive(Serialize)]
pub(super) struct QuantityExtremes {
    quantity: MapQuantity,
    unit: &'static str,
    smallest: Option<Extreme>,
    largest: Option<Extreme>,
}

impl QuantityExtremes {
    /// Those of every quantity that the map has.
    pub(super) fn all(map: &WorkspaceMap) -> Vec<Self> {
        let quantities = map.quantities().iter();
        quantities.map(|one| Self::new(map, *one)).collect()
    }

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

fn pose_json(azimuth_deg: f64, tilt_deg: f64, found: &Result<Cell, Error>) -> impl Serialize {
    let cell = found.as_ref().ok();
    let error = found.as_ref().map_or_else(
        |error| Some(*error),
        |cell| cell.at_pretension.as_ref().err().copied(),
    );
    json_object! {
        azimuth_deg: azimuth_deg,
        tilt_deg: tilt_deg,
        #[serde(flatten)]
        cell: cell,
        #[serde(flatten)]
        at_pretension: cell.and_then(|cell| cell.at_pretension.ok()),
        #[serde(flatten)]
        nonlinear: cell
            .and_then(|cell| MapQuantity::DeviationNonlinear.value(cell))
            .map(|mm| json_object! { deviation_nonlinear_mm: mm }),
        // Why there is nothing at the rig's pretension or nothing at all.
        #[serde(flatten)]
        error: error.map(|error| json_object! { error: error.to_string() }),
    }
}

/// Serialised one pose after the other: a map can have ten million.
struct MapPoses<'a>(&'a WorkspaceMap);

impl Serialize for MapPoses<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let poses = self.0.poses();
        serializer.collect_seq(poses.map(|(azimuth, tilt, cell)| pose_json(azimuth, tilt, cell)))
    }
}

impl MapReport<'_> {
    pub(super) fn json(&self) -> impl Serialize {
        json_object! {
            support: self.rig.support_name.word(),
            payload_kg: self.payload_kg,
            pretension_n: self.rig.pretension_n,
            #[serde(flatten)]
            counts: self.map.counts(),
            extremes: &self.extremes,
            pictures: self.pictures,
            poses: MapPoses(self.map),
        }
    }

    /// A table for people.
    pub(super) fn table(&self, csv: Option<&Path>) -> String {
        let title = format!(
            "Workspace to {}° with {} kg, pretension {} N, support {}\n\n",
            self.map.tilt_max_deg,
            self.payload_kg,
            self.rig.pretension_n,
            self.rig.support_name.word()
        );
        let rows: String = self.extremes.iter().map(QuantityExtremes::row).collect();
        title + HEADING + &rows + &self.counts() + &self.missing() + &self.files(csv)
    }

    fn counts(&self) -> String {
        let counts = self.map.counts();
        let share = 100.0 * counts.feasible as f64 / counts.poses as f64;
        format!(
            "\nFeasible: {} of {} poses ({share:.1} %), {} at pretension {} N and {} only at another\n",
            counts.feasible,
            counts.poses,
            counts.pretension_keeps_bounds,
            self.rig.pretension_n,
            counts.only_another_pretension
        )
    }

    fn missing(&self) -> String {
        let at_pretension = format!("No result at pretension {} N", self.rig.pretension_n);
        let missing = [
            ("No result", self.map.reasons_for_no_result()),
            (at_pretension.as_str(), self.map.reasons_for_no_pretension()),
            (
                "No nonlinear deviation",
                self.map.reasons_for_no_nonlinear(),
            ),
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
        let heading = "Pictures, each as .svg, .png and .pdf:\n";
        let heading = if pictures.is_empty() { "" } else { heading };
        let csv = csv.map(|path| format!("CSV: {}\n", relative_path(path).display()));
        let csv = csv.unwrap_or_default();
        format!("{heading}{pictures}{csv}")
    }
}
