//! Tendons that are cut wherever the leg is, and whatever it does.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::strikes::{Activity, StrikeCampaign};
use leg_firmware::supervisor::{FAULT_TABLE, Reaction};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

/// At rest, held, on its way and just armed, on every rig, with any payload and pretension.
#[test]
fn a_cut_tendon_is_named_within_half_a_second() {
    const COUNT: u64 = 70;
    const WITHIN_S: f64 = 0.5;
    let load = |name: &str| (name.into(), RigFile::load(Some(name.as_ref())).unwrap());
    let campaign = StrikeCampaign {
        seed: 3,
        rigs: READY_RIGS.iter().map(|rig| load(rig.name)).collect(),
        activities: vec![
            Activity::Following,
            Activity::Held,
            Activity::Moving,
            Activity::Arming,
            Activity::Rearmed,
        ],
        faults: vec!["tendon_cut".into()],
    };
    let struck = campaign.run(COUNT, || ());
    assert_eq!(struck.len() as u64, COUNT);
    let mut latest_s = 0.0_f64;
    for one in struck {
        assert!(one.passes(), "#{}: {:?}", one.index, one.failures);
        let named_s = one.named_s.unwrap();
        latest_s = latest_s.max(named_s);
        assert!(named_s < WITHIN_S, "{}: {named_s} s", one.case);
        let named = FAULT_TABLE.iter().find(|row| Some(row.name) == one.named);
        assert_eq!(named.unwrap().reaction, Reaction::Hold, "{}", one.case);
    }
    println!("{latest_s} s");
}
