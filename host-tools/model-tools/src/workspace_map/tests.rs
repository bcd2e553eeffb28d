#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod agreement;
mod pretension;
mod work;

pub(super) use work::count_evaluation;

use super::{Grid, MapQuantity, WorkspaceMap};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

const GRID: Grid = Grid {
    azimuths: 72,
    tilts: 7,
};

/// The vertical is one pose.
const POSES: usize = 72 * 6 + 1;

fn table_1() -> RigFile {
    RigFile::load(None).unwrap()
}

#[test]
fn all_cores_and_one_core_give_the_same_map() {
    let rig = table_1();
    let map = WorkspaceMap::compute(&rig, 1.0, GRID, false, || ());
    assert_eq!(map, WorkspaceMap::compute_on_one_core(&rig, 1.0, GRID));
    assert_eq!(map.cells.len(), POSES);
    let (azimuth, tilt, _) = map.poses().last().unwrap();
    assert_eq!((azimuth, tilt), (355.0, 30.0));
}

#[test]
fn the_map_of_a_symmetric_rig_repeats_every_120_degrees() {
    let map = WorkspaceMap::compute_on_one_core(&table_1(), 2.0, GRID);
    for cells in map.cells[1..].chunks(72) {
        for (column, cell) in cells.iter().enumerate() {
            let (cell, other) = (cell.unwrap(), cells[(column + 24) % 72].unwrap());
            for &quantity in MapQuantity::plain() {
                let (a, b) = (
                    quantity.counted_value(&cell).unwrap(),
                    quantity.counted_value(&other).unwrap(),
                );
                assert!(
                    (a - b).abs() < 1e-9 * a.abs().max(1.0),
                    "{quantity:?}: {a} {b}"
                );
            }
        }
    }
}

/// The pretensions that serve every pose of the workspace, for 0, 0.5, 1 and 2 kg.
#[test]
fn the_pretensions_that_serve_every_pose_are_known() {
    let expected = [
        (0.0, 21.4, 140.3),
        (0.5, 33.3, 138.6),
        (1.0, 45.1, 116.0),
        (2.0, 68.8, 70.7),
    ];
    for (payload_kg, lowest, highest) in expected {
        let map = WorkspaceMap::compute_on_one_core(&table_1(), payload_kg, GRID);
        let cells: Vec<_> = map.cells.iter().map(|cell| cell.unwrap()).collect();
        let least = cells.iter().map(|cell| cell.pretension_min_n);
        let least = least.fold(f64::MIN, f64::max);
        let most = cells.iter().map(|cell| cell.pretension_max_n);
        let most = most.fold(f64::MAX, f64::min);
        assert!((least - lowest).abs() < 0.06, "{payload_kg} kg: {least}");
        assert!((most - highest).abs() < 0.06, "{payload_kg} kg: {most}");
        assert_eq!(map.counts().feasible, POSES);
    }
}

#[test]
fn every_support_has_a_map_and_too_heavy_a_payload_an_empty_one() {
    for ready in READY_RIGS {
        let rig = RigFile::parse(ready.name, ready.text).unwrap();
        let count = WorkspaceMap::compute_on_one_core(&rig, 0.5, GRID)
            .counts()
            .feasible;
        assert!(count > 400, "{}: {count}", ready.name);
    }
    // Straight down the joint alone carries it.
    let heavy = WorkspaceMap::compute_on_one_core(&table_1(), 100.0, GRID);
    assert_eq!(heavy.counts().feasible, 1);
}

fn ready(name: &str) -> RigFile {
    RigFile::load(Some(name.as_ref())).unwrap()
}

#[test]
fn extremes_are_at_the_first_pose_that_has_them() {
    let map = WorkspaceMap::compute_on_one_core(&table_1(), 1.0, GRID);
    let [worst, best] = map.extremes(MapQuantity::Margin).unwrap();
    assert_eq!((best.azimuth_deg, best.tilt_deg), (0.0, 0.0));
    assert!((best.value - 62.0).abs() < 1e-9);
    assert_eq!((worst.azimuth_deg, worst.tilt_deg), (60.0, 30.0));
    let [least, most] = map.extremes(MapQuantity::Deviation).unwrap();
    assert_eq!((least.azimuth_deg, least.tilt_deg), (0.0, 0.0));
    assert_eq!((most.azimuth_deg, most.tilt_deg), (0.0, 30.0));
}
