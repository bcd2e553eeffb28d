#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Grid, Quantity, WorkspaceMap};
use crate::ready_rigs::READY_RIGS;
use crate::rig_file::RigFile;
use fastrand::Rng;
use leg_model::{Error, evaluate};

const GRID: Grid = Grid {
    azimuths: 72,
    tilts: 7,
};

fn table_1() -> RigFile {
    RigFile::load(None).unwrap()
}

#[test]
fn all_cores_and_one_core_give_the_same_map() {
    let rig = table_1();
    let map = WorkspaceMap::compute(&rig, 1.0, GRID, || ());
    assert_eq!(map, WorkspaceMap::on_one_core(&rig, 1.0, GRID));
    assert_eq!(map.cells.len(), 72 * 7);
    let (azimuth, tilt, _) = map.poses().last().unwrap();
    assert_eq!((azimuth, tilt), (355.0, 30.0));
}

#[test]
fn the_map_of_a_symmetric_rig_repeats_every_120_degrees() {
    let map = WorkspaceMap::on_one_core(&table_1(), 2.0, GRID);
    for cells in map.cells.chunks(72) {
        for (column, cell) in cells.iter().enumerate() {
            let (cell, other) = (cell.unwrap(), cells[(column + 24) % 72].unwrap());
            for quantity in Quantity::ALL {
                let (a, b) = (quantity.of(&cell).unwrap(), quantity.of(&other).unwrap());
                assert!(
                    (a - b).abs() < 1e-9 * a.abs().max(1.0),
                    "{quantity:?}: {a} {b}"
                );
            }
        }
    }
}

/// The levels that serve every pose of the workspace, for 0, 0.5, 1 and 2 kg.
#[test]
fn the_levels_that_serve_every_pose_are_known() {
    let expected = [
        (0.0, 21.4, 140.3),
        (0.5, 33.3, 138.6),
        (1.0, 45.1, 116.0),
        (2.0, 68.8, 70.7),
    ];
    for (payload_kg, lowest, highest) in expected {
        let map = WorkspaceMap::on_one_core(&table_1(), payload_kg, GRID);
        let cells: Vec<_> = map.cells.iter().map(|cell| cell.unwrap()).collect();
        let least = cells
            .iter()
            .map(|cell| cell.level_min_n)
            .fold(f64::MIN, f64::max);
        let most = cells
            .iter()
            .map(|cell| cell.level_max_n)
            .fold(f64::MAX, f64::min);
        assert!((least - lowest).abs() < 0.06, "{payload_kg} kg: {least}");
        assert!((most - highest).abs() < 0.06, "{payload_kg} kg: {most}");
        assert_eq!(map.feasible_count(), cells.len());
    }
}

#[test]
fn every_support_has_a_map_and_too_heavy_a_payload_an_empty_one() {
    for ready in READY_RIGS {
        let rig = RigFile::parse(ready.name, ready.text).unwrap();
        let count = WorkspaceMap::on_one_core(&rig, 0.5, GRID).feasible_count();
        assert!(count > 400, "{}: {count}", ready.name);
    }
    // Straight down the joint alone carries it.
    let heavy = WorkspaceMap::on_one_core(&table_1(), 100.0, GRID);
    assert_eq!(heavy.feasible_count(), 72);
}

/// Values, refusals and what is derived from them. The evaluation itself is judged by closed forms and an independent
/// program, in the tests of the workspace.
#[test]
fn every_support_maps_what_the_whole_evaluation_says() {
    let mut rng = Rng::with_seed(9);
    for ready in READY_RIGS {
        let mut rig = RigFile::parse(ready.name, ready.text).unwrap();
        for _ in 0..6 {
            // From slack, where ball joints have no result, to beyond the ceiling.
            rig.level_n = rng.f64().mul_add(200.0, -30.0);
            let payload_kg = 4.0 * rng.f64();
            agrees_with_evaluation(ready.name, &rig, payload_kg);
        }
    }
}

fn agrees_with_evaluation(name: &str, rig: &RigFile, payload_kg: f64) {
    let map = WorkspaceMap::on_one_core(rig, payload_kg, GRID);
    for (azimuth, tilt, cell) in map.poses() {
        let place = format!(
            "{name}, {payload_kg} kg, {} N, {azimuth}°, {tilt}°",
            rig.level_n
        );
        let query = rig.query(azimuth, tilt, payload_kg);
        let (cell, e) = match (cell, evaluate(&rig.parameters, &query)) {
            (Ok(cell), Ok(evaluation)) => (cell, evaluation),
            (cell, evaluation) => {
                assert_eq!(cell.err(), evaluation.err(), "{place}");
                continue;
            }
        };
        let [softest, stiffest] = e.bending_stiffness_nm_per_rad;
        let inside = e
            .tensions_n
            .iter()
            .all(|tension| (rig.tension_floor_n..=rig.tension_ceiling_n).contains(tension));
        assert_eq!(cell.deviation_mm, e.deviation_m * 1000.0, "{place}");
        assert_eq!(cell.stiffness_min_nm_per_rad, softest, "{place}");
        assert_eq!(cell.stiffness_max_nm_per_rad, stiffest, "{place}");
        assert_eq!(cell.condition, stiffest / softest, "{place}");
        assert_eq!(
            [cell.level_min_n, cell.level_max_n],
            e.level_range_n,
            "{place}"
        );
        assert_eq!(cell.feasible, e.feasible, "{place}");
        assert_eq!(cell.margin_n >= 0.0, inside, "{place}");
        // A level that keeps the bounds is in the range, and no other is.
        let in_range = (cell.level_min_n..=cell.level_max_n).contains(&rig.level_n);
        assert_eq!(inside, in_range, "{place}");
    }
}

#[test]
fn poses_without_a_result_are_counted_by_reason() {
    let ball = READY_RIGS
        .iter()
        .find(|ready| ready.name == "spherical")
        .unwrap();
    let mut rig = RigFile::parse(ball.name, ball.text).unwrap();
    rig.level_n = 0.0;
    // Straight down nothing pulls, so nothing holds the twist.
    let map = WorkspaceMap::on_one_core(&rig, 1.0, GRID);
    assert_eq!(map.without_result(), [(Error::Unstable, 72)]);
    assert_eq!(map.feasible_count(), 72 * 6);
}

#[test]
fn extremes_are_at_the_first_pose_that_has_them() {
    let map = WorkspaceMap::on_one_core(&table_1(), 1.0, GRID);
    let [worst, best] = map.extremes(Quantity::Margin).unwrap();
    assert_eq!((best.azimuth_deg, best.tilt_deg), (0.0, 0.0));
    assert!((best.value - 62.0).abs() < 1e-9);
    assert_eq!((worst.azimuth_deg, worst.tilt_deg), (60.0, 30.0));
    let [least, most] = map.extremes(Quantity::Deviation).unwrap();
    assert_eq!((least.azimuth_deg, least.tilt_deg), (0.0, 0.0));
    assert_eq!((most.azimuth_deg, most.tilt_deg), (0.0, 30.0));
}
