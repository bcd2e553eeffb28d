//! A map as a table: one pose a row.

use crate::atomic_file;
use crate::failure::Failure;
use crate::workspace_map::{Cell, WorkspaceMap};
use std::io;
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

/// Writes the map, whole or not at all, around other work: its folder is tried before that work, and the file is put
/// in its place only if the work succeeds. A pose without a result has empty fields.
///
/// # Errors
/// A [`Failure`] if the file cannot be written; that of the work.
pub fn save_around<T>(
    map: &WorkspaceMap,
    file: &Path,
    work: impl FnOnce() -> Result<T, Failure>,
) -> Result<T, Failure> {
    let written = atomic_file::replace(file, |new| {
        write(map, new)?;
        work().map_err(Stopped::Work)
    });
    written.map_err(|stopped| match stopped {
        Stopped::Work(failure) => failure,
        Stopped::File(error) => Failure::refused(
            format!("cannot write {}: {error}", file.display()),
            "name a file in a folder that may be written with --csv",
        ),
    })
}

/// Why the file is not in its place.
enum Stopped {
    File(io::Error),
    Work(Failure),
}

impl From<io::Error> for Stopped {
    fn from(error: io::Error) -> Self {
        Self::File(error)
    }
}

fn write(map: &WorkspaceMap, new: &Path) -> io::Result<()> {
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{COLUMNS, save_around};
    use crate::failure::Failure;
    use crate::rig_file::RigFile;
    use crate::workspace_map::{Grid, WorkspaceMap};

    fn map(level_n: f64) -> WorkspaceMap {
        let mut rig = RigFile::load(Some("spherical".as_ref())).unwrap();
        rig.level_n = level_n;
        let grid = Grid {
            azimuths: 3,
            tilts: 2,
        };
        WorkspaceMap::on_one_core(&rig, 1.0, grid)
    }

    #[test]
    fn a_pose_without_a_result_has_empty_fields() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("map.csv");
        save_around(&map(0.0), &file, || Ok(())).unwrap();
        let mut reader = csv::Reader::from_path(&file).unwrap();
        assert_eq!(reader.headers().unwrap(), &COLUMNS[..]);
        let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 6);
        // Straight down a ball joint that nothing pulls cannot hold its twist.
        assert!(rows[1].iter().skip(2).all(str::is_empty));
        assert_eq!(rows[1].get(0), Some("120"));
        let numbers = rows[4].iter().skip(3).map(str::parse::<f64>);
        assert!(numbers.map(Result::unwrap).all(f64::is_finite));
    }

    #[test]
    fn table_and_work_are_done_both_or_neither() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("map.csv");
        let failure = Failure::missed("no pictures", "");
        let failed = save_around(&map(60.0), &file, || Err::<(), _>(failure.clone()));
        assert_eq!(failed, Err(failure));
        assert!(!file.exists());
        std::fs::write(&file, "").unwrap();
        let mut worked = false;
        let below_a_file = file.join("map.csv");
        let failed = save_around(&map(60.0), &below_a_file, || {
            worked = true;
            Ok(())
        });
        assert!(matches!(failed, Err(Failure::Refused(_))));
        assert!(!worked);
    }
}
