//! Strikes of legs that are braked while a motor may not obey, and of legs that are cut off on their way.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::strikes::{campaign, require_within};
use leg_bench::strikes::StrikeCampaign;

/// A strike that failed once: motors pulled for 0.15 s against the hand that held the tip, to 309.6 N.
#[test]
fn a_leg_that_is_held_by_a_hand_is_braked_for_a_short_time() {
    require_within(7302, &[(811, "leg_grasped", 1.0)]);
}

/// Strikes that failed once, by 171 to 189 N: a leg whose current disagrees was braked in 0.06 s whether its motors obeyed or not, in half a
/// period of its swing. The last one's motor does not obey, but is hardly led: the others need not wait for it.
#[test]
fn a_leg_whose_current_disagrees_swings_no_more_than_any_other() {
    require_within(
        1_281_128,
        &[(299, "current_zero", 1.5), (289, "screw_dry", 1.5)],
    );
    require_within(291_130, &[(6312, "current_zero", 1.0)]);
    require_within(881, &[(291, "half_bridge_open", 3.0)]);
    // Motors that do not obey, and are led at 0.15 to 0.25 of the speed of the fastest: the others wait.
    require_within(
        31_337,
        &[
            (9901, "half_bridge_open_outwards", 1.8),
            (26_535, "half_bridge_open_outwards", 1.0),
        ],
    );
}

/// A strike that failed once: bursts of counts were named 0.17 s after they began, while the leg came to move faster. It was judged by one
/// that was cut off when they began.
#[test]
fn a_leg_that_is_cut_off_later_is_judged_by_its_speed_then() {
    require_within(1_281_128, &[(3881, "encoder_jumps", 1.0)]);
}

/// A leg that is cut off on its way is judged by what it does by itself, where that is beyond the bars of every leg, and by nothing else.
#[test]
fn a_leg_that_is_cut_off_does_no_more_than_it_does_by_itself() {
    for (seed, index, tension_n, tip_mm) in [
        // Swings that are wide.
        (12_001, 3234, 165.0, 7.8),
        (501, 19_617, 165.0, 7.2),
        // One that is narrow, at 199.4 N.
        (12_001, 2222, 200.0, 3.0),
        // Jammed motors that paid out, and a driver that pulls in one direction alone.
        (271_129, 10_795, 230.0, 3.0),
        (271_129, 206, 220.0, 10.0),
        (281_120, 174, 220.0, 3.0),
        (271_129, 12_713, 230.0, 35.0),
        // A step of a gain that comes to show the maximum tension.
        (271_129, 11_565, 187.5, 7.0),
        (271_129, 14_881, 187.5, 7.0),
    ] {
        let campaign = StrikeCampaign {
            seed,
            ..campaign("none")
        };
        let (struck, _) = campaign.repeat(index, 0.1);
        assert!(struck.passes(), "{struck:?}");
        let bars = struck.bars.unwrap();
        assert!(struck.tension_n <= tension_n && struck.tip_mm <= tip_mm);
        assert!(bars.tension_n < tension_n.max(1.15 * struck.tension_n) + 1e-9);
        assert!(bars.tip_mm < tip_mm.max(1.15 * struck.tip_mm + 0.5) + 1e-9);
    }
}

/// A motor that jams by itself is compared with one that jams and is cut off at once, however late it is named: 2.37 mm, a tenth and 0.5 mm.
#[test]
fn a_strike_is_not_compared_with_itself() {
    let campaign = StrikeCampaign {
        seed: 271_129,
        ..campaign("none")
    };
    let (struck, _) = campaign.repeat(10_795, 0.1);
    assert_eq!(struck.fault, "motor_jammed");
    let bar_mm = struck.bars.unwrap().tip_mm;
    assert!((bar_mm - (1.1 * 2.374 + 0.5)).abs() < 0.01, "{bar_mm} mm");
}
