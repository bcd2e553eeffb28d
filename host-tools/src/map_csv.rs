//! A map as a table: one pose a row.

use crate::atomic_file;
use crate::failure::Failure;
use crate::workspace_map::{Cell, WorkspaceMap};
use std::path::Path;

const COLUMNS: [&str; 10] = [
    "azimuth_deg",
    "tilt_deg",
    "feasible",
    "deviation_mm",
    "stiffness_min_nm_per_rad",
    "stiffness_max_nm_per_rad",
    "condition",
    "margin_n",
    "level_min_n",
    "level_max_n",
];

/// Writes the map, whole or not at all. A pose without a result has empty fields.
///
/// # Errors
/// A [`Failure`] if the file cannot be written.
pub fn save(map: &WorkspaceMap, file: &Path) -> Result<(), Failure> {
    atomic_file::replace(file, |new| write(map, new)).map_err(|error| {
        let sentence = format!("cannot write {}: {error}", file.display());
        Failure::refused(
            sentence,
            "name a file in a folder that may be written with --csv",
        )
    })
}

fn write(map: &WorkspaceMap, new: &Path) -> Result<(), std::io::Error> {
    let mut writer = csv::Writer::from_path(new)?;
    writer.write_record(COLUMNS)?;
    for (azimuth, tilt, cell) in map.poses() {
        let mut record = vec![azimuth.to_string(), tilt.to_string()];
        record.extend(
            cell.as_ref()
                .map_or_else(|_| vec![String::new(); 8], fields),
        );
        writer.write_record(record)?;
    }
    writer.flush()
}

fn fields(cell: &Cell) -> Vec<String> {
    let numbers = [
        cell.deviation_mm,
        cell.stiffness_min_nm_per_rad,
        cell.stiffness_max_nm_per_rad,
        cell.condition,
        cell.margin_n,
        cell.level_min_n,
        cell.level_max_n,
    ];
    let numbers = numbers.iter().map(ToString::to_string);
    [cell.feasible.to_string()]
        .into_iter()
        .chain(numbers)
        .collect()
}
