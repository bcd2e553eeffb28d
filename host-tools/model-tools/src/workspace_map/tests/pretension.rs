//! What depends on the rig's pretension and what does not.

use super::{GRID, POSES, ready};
use crate::workspace_map::{Cell, MapQuantity, WorkspaceMap};
use leg_model::{Error, Reason};
use leg_rig::rig_file::RigFile;

#[test]
fn a_pretension_that_does_not_hold_a_pose_leaves_its_range() {
    let rig = RigFile {
        pretension_n: 0.0,
        ..ready("spherical")
    };
    // Straight down nothing pulls, so nothing holds the twist.
    let map = WorkspaceMap::compute_on_one_core(&rig, 1.0, GRID);
    assert_eq!(map.reasons_for_no_result(), []);
    assert_eq!(map.reasons_for_no_pretension(), [(Error::Unstable, 1)]);
    let vertical = map.cells[0].unwrap();
    assert!(vertical.feasible && !vertical.pretension_keeps_bounds);
    assert_eq!(vertical.margin_n, None);
}

/// The ball joint too, although its twist, on which the range depends a little, is that of the pretension.
#[test]
fn feasibility_does_not_depend_on_the_pretension() {
    for name in ["table1", "notch_universal", "spherical"] {
        let map = |pretension_n| {
            let rig = RigFile {
                pretension_n,
                ..ready(name)
            };
            WorkspaceMap::compute_on_one_core(&rig, 2.0, GRID)
        };
        let feasible = map(70.0).counts().feasible;
        for pretension_n in [0.0, 20.0, 140.0, 180.0, 199.0] {
            let map = map(pretension_n);
            let counts = map.counts();
            assert_eq!(counts.feasible, feasible, "{name}, {pretension_n} N");
            let elsewhere = counts.feasible - counts.pretension_keeps_bounds;
            assert_eq!(
                counts.only_another_pretension, elsewhere,
                "{name}, {pretension_n} N"
            );
        }
        let beyond = map(199.0).reasons_for_no_pretension();
        assert!(
            matches!(
                beyond[..],
                [(
                    Error::Refused {
                        reason: Reason::BeyondCurve,
                        ..
                    },
                    _
                )]
            ),
            "{name}: {beyond:?}"
        );
    }
}

#[test]
fn extremes_at_the_pretension_are_of_poses_where_it_keeps_the_bounds() {
    let rig = ready("leaf_spring_universal");
    let map = WorkspaceMap::compute_on_one_core(&rig, 2.0, GRID);
    let counts = map.counts();
    assert!(counts.only_another_pretension > 0 && counts.feasible < POSES);
    let [_, most] = map.extremes(MapQuantity::Deviation).unwrap();
    let deviation = |cell: &Cell| cell.at_pretension.unwrap().deviation_mm;
    let all = map.cells.iter().flatten();
    let inside = all.clone().filter(|cell| cell.pretension_keeps_bounds);
    let largest = inside.map(deviation).fold(0.0, f64::max);
    assert!((most.value - largest).abs() < 1e-9);
    assert!(all.map(deviation).fold(0.0, f64::max) > largest);
    // The margin says how far the pretension is from keeping them.
    let [worst, _] = map.extremes(MapQuantity::Margin).unwrap();
    assert!(worst.value < 0.0);
}
