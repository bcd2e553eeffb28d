//! What a map costs, without a clock.

use super::{GRID, POSES};
use crate::workspace_map::WorkspaceMap;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use std::cell::Cell;

thread_local! {
    static EVALUATIONS: Cell<usize> = const { Cell::new(0) };
}

/// Called once an evaluation.
pub(in crate::workspace_map) fn count_evaluation() {
    EVALUATIONS.set(EVALUATIONS.get() + 1);
}

/// One evaluation a pose, which the benchmark measures, and nothing nonlinear.
#[test]
fn a_plain_map_evaluates_every_pose_once() {
    for ready in READY_RIGS {
        let rig = RigFile::parse(ready.name, ready.text).unwrap();
        EVALUATIONS.set(0);
        let map = WorkspaceMap::compute_on_one_core(&rig, 1.0, GRID);
        assert_eq!(EVALUATIONS.get(), POSES, "{}", ready.name);
        let mut cells = map.cells.iter().flatten();
        assert!(cells.all(|cell| cell.deviation_nonlinear_mm.is_none()));
    }
}
