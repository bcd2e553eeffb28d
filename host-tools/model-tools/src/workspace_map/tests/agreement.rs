//! Maps against the evaluation of single poses.

use super::GRID;
use crate::nonlinear::deviation_m;
use crate::workspace_map::{Grid, MapQuantity, WorkspaceMap};
use fastrand::Rng;
use leg_model::evaluate;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

/// Values, refusals and what is derived from them. The evaluation itself is judged by closed forms and an independent
/// program, in the tests of the workspace.
#[test]
fn every_support_maps_what_the_whole_evaluation_says() {
    let mut rng = Rng::with_seed(9);
    for ready in READY_RIGS {
        let mut rig = RigFile::parse(ready.name, ready.text).unwrap();
        for _ in 0..6 {
            // From slack, where ball joints have no result, to beyond the maximum tension.
            rig.pretension_n = rng.f64().mul_add(200.0, -30.0);
            let payload_kg = 4.0 * rng.f64();
            agrees_with_evaluation(ready.name, &rig, payload_kg);
        }
    }
}

fn agrees_with_evaluation(name: &str, rig: &RigFile, payload_kg: f64) {
    let map = WorkspaceMap::compute_on_one_core(rig, payload_kg, GRID);
    for (azimuth, tilt, cell) in map.poses() {
        let place = format!(
            "{name}, {payload_kg} kg, {} N, {azimuth}°, {tilt}°",
            rig.pretension_n
        );
        let query = rig.query(azimuth, tilt, payload_kg);
        let evaluation = evaluate(&rig.parameters, &query);
        let at_pretension = cell.and_then(|cell| cell.at_pretension);
        let (Ok(cell), Ok(at_pretension), Ok(e)) = (cell, at_pretension, evaluation) else {
            assert_eq!(at_pretension.err(), evaluation.err(), "{place}");
            continue;
        };
        let [softest, stiffest] = e.bending_stiffness_nm_per_rad;
        let inside = e
            .tensions_n
            .iter()
            .all(|tension| (rig.f_min_n..=rig.f_max_n).contains(tension));
        assert_eq!(
            at_pretension.deviation_mm,
            e.deviation_m * 1000.0,
            "{place}"
        );
        assert_eq!(at_pretension.stiffness_min_nm_per_rad, softest, "{place}");
        assert_eq!(at_pretension.stiffness_max_nm_per_rad, stiffest, "{place}");
        assert_eq!(at_pretension.condition, stiffest / softest, "{place}");
        assert_eq!(
            [cell.pretension_min_n, cell.pretension_max_n],
            e.pretension_range_n,
            "{place}"
        );
        assert_eq!(cell.feasible, e.feasible, "{place}");
        assert_eq!(cell.margin_n.unwrap() >= 0.0, inside, "{place}");
        // A pretension that keeps the bounds is in the range, and no other is.
        assert_eq!(inside, cell.pretension_keeps_bounds, "{place}");
    }
}

/// Near a bound the slopes of the tendons' curves differ from that at the pretension, which the linear deviation takes.
#[test]
fn linear_and_nonlinear_deviation_are_of_one_size() {
    for ready in READY_RIGS {
        let rig = RigFile::parse(ready.name, ready.text).unwrap();
        let grid = Grid {
            azimuths: 12,
            tilts: 4,
        };
        let map = WorkspaceMap::compute(&rig, 0.5, grid, true, || ());
        assert_eq!(map.reasons_for_no_nonlinear(), [], "{}", ready.name);
        let (azimuth, tilt, cell) = map.poses().last().unwrap();
        let query = rig.query(azimuth, tilt, 0.5);
        let expected = deviation_m(&rig.parameters, &query).unwrap().unwrap() * 1000.0;
        let found = MapQuantity::DeviationNonlinear.value(&cell.unwrap());
        assert_eq!(found, Some(expected), "{}", ready.name);
        let [least, most] = map.extremes(MapQuantity::LinearOverNonlinear).unwrap();
        let (least, most) = (least.value, most.value);
        let close = 90.0 < least && most < 160.0;
        assert!(close, "{}: {least} to {most} %", ready.name);
    }
}
