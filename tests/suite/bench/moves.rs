//! A sample of `leg moves`, and that its bars can fail.

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
        payload_kg: None,
    };
    require_passed(&campaign.run(0..30, || ()));
}

#[test]
fn the_tip_of_every_rig_stays_on_its_trajectory() {
    let campaign = Campaign {
        seed: 9,
        rigs: READY_RIGS.iter().map(|ready| rig(ready.name)).collect(),
        payload_kg: None,
    };
    require_passed(&campaign.run(0..14, || ()));
}

/// Without the brake heavy legs swing for longer than the bars allow.
#[test]
fn a_leg_whose_swing_is_not_braked_fails() {
    let text = [READY_RIGS[0].text, "[control.motion]\ndamping_ratio = 0\n"].concat();
    let campaign = Campaign {
        seed: 7,
        rigs: vec![(
            "undamped".into(),
            RigFile::parse("undamped", &text).unwrap(),
        )],
        payload_kg: None,
    };
    let moved = campaign.run(0..20, || ());
    assert!(moved.iter().any(|moved| !moved.passes()));
}
