//! What the f64 model costs on the host: one pose, and a map of 360 × 31 poses on one core.

#![allow(clippy::expect_used, reason = "a benchmark may panic")]

use leg_model_tools::workspace_map::{Grid, WorkspaceMap};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use std::hint::black_box;
use std::time::{Duration, Instant};

const GRID: Grid = Grid {
    azimuths: 360,
    tilts: 31,
};

/// Times that each is measured; the shortest counts, for nothing but other work on the machine makes one longer.
const REPETITIONS: u32 = 50;

/// Poses to a measurement: one alone is shorter than the clock's step.
const POSES: u32 = 1000;

fn shortest<T>(mut run: impl FnMut() -> T) -> Duration {
    let times = (0..REPETITIONS).map(|_| {
        let start = Instant::now();
        black_box(run());
        start.elapsed()
    });
    times.min().expect("there are repetitions")
}

fn main() {
    for ready in READY_RIGS {
        let rig = RigFile::parse(ready.name, ready.text).expect("a ready rig is a rig file");
        let query = rig.query(30.0, 30.0, 1.0);
        let poses = shortest(|| {
            for _ in 0..POSES {
                let found = leg_model::evaluate(black_box(&rig.parameters), black_box(&query));
                black_box(found).expect("the pose can be served");
            }
        });
        let map = shortest(|| WorkspaceMap::compute_on_one_core(black_box(&rig), 1.0, GRID));
        println!(
            "{}: one pose {:.0?}, 360 × 31 poses on one core {map:.2?}",
            ready.name,
            poses / POSES
        );
    }
}
