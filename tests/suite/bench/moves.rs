//! A sample of `leg moves`, on a leg as it is and on legs that are not as the firmware takes them to be.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::moves::{Campaign, Moved};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

fn rig(name: &str) -> (String, RigFile) {
    (name.into(), RigFile::load(Some(name.as_ref())).unwrap())
}

fn require_passed(moved: &[Moved]) {
    let failed: Vec<_> = moved.iter().filter(|moved| !moved.passes()).collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

/// The tip stays on its trajectory and does not swing after it, whatever payload is hung on the leg.
#[test]
fn the_tip_stays_on_its_trajectory() {
    let campaign = Campaign {
        seed: 7,
        rigs: vec![rig("table1")],
    };
    require_passed(&campaign.run(30, || ()));
}

#[test]
fn the_tip_of_every_rig_stays_on_its_trajectory() {
    let campaign = Campaign {
        seed: 9,
        rigs: READY_RIGS.iter().map(|ready| rig(ready.name)).collect(),
    };
    require_passed(&campaign.run(14, || ()));
}
