//! A map as a table: one pose a row.

use crate::workspace_map::{Cell, MapQuantity, WorkspaceMap};
use leg_base::atomic_file;
use leg_base::disk::help_for;
use leg_base::failure::Failure;
use std::io;
use std::path::Path;

const POSE_COLUMNS: [&str; 4] = [
    "azimuth_deg",
    "tilt_deg",
    "feasible",
    "pretension_keeps_bounds",
];

/// The name of a quantity with its unit.
fn column(quantity: MapQuantity) -> String {
    let unit = match quantity.unit() {
        "" => "",
        "N" => "_n",
        "%" => "_percent",
        "mm" => "_mm",
        _ => "_nm_per_rad",
    };
    format!("{}{unit}", quantity.name())
}

/// Writes the map, whole or not at all, around other work: its directory is tried before that work, and the file is put
/// in its place only if the work succeeds. What is not known of a pose is an empty field. The vertical is one pose and
/// has one row.
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
        work().map_err(SaveError::Work)
    });
    written.map_err(|stopped| match stopped {
        SaveError::Work(failure) => failure,
        SaveError::File(error) => Failure::refused(
            format!("cannot write {}: {error}", file.display()),
            help_for(
                &error,
                "name a file in a directory that may be written with --csv",
            ),
        ),
    })
}

/// Why the file is not in its place.
enum SaveError {
    File(io::Error),
    Work(Failure),
}

impl From<io::Error> for SaveError {
    fn from(error: io::Error) -> Self {
        Self::File(error)
    }
}

fn write(map: &WorkspaceMap, new: &Path) -> io::Result<()> {
    let quantities = map.quantities();
    let mut writer = csv::Writer::from_path(new)?;
    let columns = quantities.iter().map(|quantity| column(*quantity));
    writer.write_record(POSE_COLUMNS.map(String::from).into_iter().chain(columns))?;
    for (azimuth, tilt, cell) in map.poses() {
        let place = [azimuth.to_string(), tilt.to_string()];
        let fields = cell.as_ref().map_or_else(
            |_| vec![String::new(); quantities.len() + 2],
            |cell| fields(cell, quantities),
        );
        writer.write_record(place.into_iter().chain(fields))?;
    }
    writer.flush()
}

fn fields(cell: &Cell, quantities: &[MapQuantity]) -> Vec<String> {
    let values = quantities.iter().map(|quantity| quantity.value(cell));
    let values = values.map(|value| value.map_or_else(String::new, |value| value.to_string()));
    [cell.feasible, cell.pretension_keeps_bounds]
        .map(|is| is.to_string())
        .into_iter()
        .chain(values)
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::save_around;
    use crate::workspace_map::{Grid, WorkspaceMap};
    use leg_base::failure::Failure;
    use leg_rig::rig_file::RigFile;

    const GRID: Grid = Grid {
        azimuths: 3,
        tilts: 2,
    };

    fn ball_joint(pretension_n: f64) -> RigFile {
        let mut rig = RigFile::load(Some("spherical".as_ref())).unwrap();
        rig.pretension_n = pretension_n;
        rig
    }

    fn map(pretension_n: f64) -> WorkspaceMap {
        WorkspaceMap::compute_on_one_core(&ball_joint(pretension_n), 1.0, GRID)
    }

    /// The lines of the file.
    fn saved(map: &WorkspaceMap) -> Vec<Vec<String>> {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("map.csv");
        save_around(map, &file, || Ok(())).unwrap();
        let text = std::fs::read_to_string(&file).unwrap();
        let fields = |line: &str| line.split(',').map(String::from).collect();
        text.lines().map(fields).collect()
    }

    #[test]
    fn what_is_not_known_of_a_pose_is_an_empty_field() {
        let lines = saved(&map(0.0));
        assert_eq!(lines.len(), 1 + 1 + 3);
        assert_eq!(lines[0].len(), 11);
        // Straight down a ball joint that nothing pulls cannot hold its twist, but at another pretension it would.
        assert_eq!(lines[1][..4], ["0", "0", "true", "false"]);
        assert!(lines[1][4..9].iter().all(String::is_empty));
        assert_eq!(lines[3][..2], ["120", "30"]);
        let numbers = |line: &[String]| line.iter().all(|s| s.parse::<f64>().unwrap().is_finite());
        assert!(numbers(&lines[1][9..]) && numbers(&lines[3][4..]));
    }

    #[test]
    fn the_nonlinear_deviation_has_columns_where_it_was_asked_for() {
        let map = WorkspaceMap::compute(&ball_joint(70.0), 1.0, GRID, true, || ());
        let lines = saved(&map);
        assert_eq!(
            lines[0][11..],
            ["deviation_nonlinear_mm", "linear_over_nonlinear_percent"]
        );
        let percent: f64 = lines[2][12].parse().unwrap();
        assert!((50.0..150.0).contains(&percent), "{percent}");
    }

    #[test]
    fn table_and_work_are_done_both_or_neither() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("map.csv");
        let failure = Failure::failed("no pictures", "");
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
