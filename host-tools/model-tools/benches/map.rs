//! What the f64 model costs on the host: one pose, and a map of 360 × 31 poses on one core.

#![allow(missing_docs, reason = "criterion makes the functions")]
#![allow(clippy::expect_used, reason = "a benchmark may panic")]

use criterion::{Criterion, criterion_group, criterion_main};
use leg_model_tools::workspace_map::{Grid, WorkspaceMap};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use std::hint::black_box;

const GRID: Grid = Grid {
    azimuths: 360,
    tilts: 31,
};

fn benches(criterion: &mut Criterion) {
    for ready in READY_RIGS {
        let rig = RigFile::parse(ready.name, ready.text).expect("a ready rig is a rig file");
        let query = rig.query(30.0, 30.0, 1.0);
        criterion.bench_function(&format!("one pose, {}", ready.name), |bencher| {
            bencher.iter(|| leg_model::evaluate(black_box(&rig.parameters), black_box(&query)));
        });
        let name = format!("360 × 31 poses on one core, {}", ready.name);
        criterion.bench_function(&name, |bencher| {
            bencher.iter(|| WorkspaceMap::on_one_core(black_box(&rig), 1.0, GRID));
        });
    }
}

criterion_group!(map, benches);
criterion_main!(map);
