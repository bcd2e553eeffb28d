//! The pages say the bars.

use super::*;
use crate::strikes::cut_off::{CUT_OFF_BEYOND, CUT_OFF_MM, MORE, MORE_MM};
use crate::strikes::naming::{DRIFTS_S, NAMED_S, WANDERS_S};

#[test]
fn the_page_says_the_bars() {
    let page = include_str!("../../../../docs/scenarios.md");
    for words in [
        format!("the maximum tension and {:.0} %", 100.0 * BEYOND),
        format!("{:.0} % where a tendon of a moving leg", 100.0 * CUT_BEYOND),
        format!("{:.0} % where two load cells", 100.0 * SWAPPED_BEYOND),
        format!("{:.0} % where a driver pulls", 100.0 * STUCK_BEYOND),
        format!(
            "{:.0} % where the play of a gear grows on the way; {:.0} % where a motor obeys or is counted in parts there",
            100.0 * PLAY_BEYOND,
            100.0 * IN_PARTS_BEYOND
        ),
        format!("{:.0} % where a hand holds", 100.0 * GRASPED_BEYOND),
        format!("{:.0} % where a driver switches", 100.0 * RUNAWAY_BEYOND),
        format!("{:.0} % where a tendon slips", 100.0 * SLIP_BEYOND),
        format!(
            "{:.0} % where a moving leg leaves its load out, or one at rest gives way by a cell that comes to show the maximum tension, {:.0} % on its way",
            100.0 * LEFT_OUT_BEYOND.max(AT_MAX_BEYOND),
            100.0 * AT_MAX_WAY_BEYOND
        ),
        format!("{HOMING_N} N while homing"),
        format!("{REST_MM} mm; {REARMED_MM} mm where it is armed again"),
        format!("{GAIN_MM} mm where a gain is 20 % off, or a cell wanders or drifts"),
        format!("{GAIN_DOWN_MM} mm where it drifts down by that"),
        format!(
            "{GAIN_AT_MAX_MM} mm where a cell that grows, steps by 10 N, drifts or wanders comes to show the maximum tension"
        ),
        format!("{SWAPPED_MM} mm where two sensors"),
        format!("{:.0} % and {MORE_MM} mm in tip", 100.0 * MORE),
        format!(
            "never more than {:.0} % above the maximum tension and {CUT_OFF_MM} mm",
            100.0 * CUT_OFF_BEYOND
        ),
        format!("{WAY_MM} mm; {ASIDE_MM} mm while it is paid out, {LIFTED_MM} mm while homing"),
        format!("{HOMING_STOPS_MM} mm where the supply dips then or half of a bridge is open"),
        format!(
            "{CUT_MM} mm where a tendon is cut, {SLIP_MM} mm where it slips, {SLIP_AGAIN_MM} mm where it is armed again with it"
        ),
        format!("{CREEP_MM} mm where it creeps, {RUNAWAY_MM} mm where a driver"),
        format!("{RUNAWAY_AGAIN_MM} mm where it is armed again with that"),
        format!(
            "{UNCOUNTED_MM} mm where a motor turns without being counted, {IN_PARTS_MM} mm on the way where one obeys or is counted in parts"
        ),
        format!("{GRASPED_MM} mm where a hand holds the tip"),
        format!(
            "{NAMED_S} s where something shows it; a cell that wanders when it has been {WANDERS_BY_N} N off for {WANDERS_S} s, drifts {DRIFTS_S} s"
        ),
    ] {
        assert!(page.contains(&words), "{words}");
    }
}

#[test]
fn the_page_on_safety_says_how_far_beyond_the_maximum_tension() {
    let page = include_str!("../../../../../firmware/SAFETY.md");
    let page: Vec<_> = page.split_whitespace().collect();
    let page = page.join(" ");
    let percent = |part: f64| format!("{:.0} %", 100.0 * part);
    for words in [
        format!(
            "the tension is at most {} above that leg's, and at most {} above the maximum tension",
            percent(MORE),
            percent(CUT_OFF_BEYOND)
        ),
        format!(
            "up to {HOMING_N} N where a load cell fails, {HOMING_RUNAWAY_N} N where a driver switches on fully"
        ),
        format!("until its motor draws too much: {HOMING_N} N, tip {LIFTED_MM} mm"),
        format!("catch it: up to {} more", percent(CUT_BEYOND)),
        format!("by it: up to {} above the maximum", percent(SWAPPED_BEYOND)),
        format!(
            "switches on fully by itself: up to {} more",
            percent(RUNAWAY_BEYOND)
        ),
        format!(
            "{} where it is armed again with it",
            percent(RUNAWAY_AGAIN_BEYOND)
        ),
        format!(
            "catches the falling leg: up to {} more",
            percent(SLIP_BEYOND)
        ),
        format!(
            "the play of a gear grows at once on the way: up to {} more; a motor obeys or is counted in parts there: up to {} more",
            percent(PLAY_BEYOND),
            percent(IN_PARTS_BEYOND)
        ),
        format!(
            "up to {} and {} more",
            percent(STUCK_BEYOND),
            percent(GRASPED_BEYOND)
        ),
        format!("up to {HOMING_N} N where a load cell fails"),
        format!("switches it off (tip {RUNAWAY_MM} mm)"),
        format!("armed again with it ({RUNAWAY_AGAIN_MM} mm)"),
        format!(
            "a load cell that comes to show the maximum tension: up to {} more, {} on its way",
            percent(AT_MAX_BEYOND),
            percent(AT_MAX_WAY_BEYOND)
        ),
        format!(
            "leaves its load out: up to {} more",
            percent(LEFT_OUT_BEYOND)
        ),
        format!(
            "At other poses it is up to {} mm, and {GAIN_AT_MAX_MM} mm where the cell comes to show the maximum tension",
            GAIN_MM.max(GAIN_DOWN_MM)
        ),
    ] {
        assert!(page.contains(&words), "{words}");
    }
}

#[test]
fn the_readme_says_how_far_a_load_cell_moves_a_leg_at_rest() {
    let page = include_str!("../../../../../README.md");
    let page: Vec<_> = page.split_whitespace().collect();
    let words = format!(
        "up to {REST_MM} mm, {} mm where its gain is off or it drifts, {GAIN_AT_MAX_MM} mm where it drifts, steps or wanders to the maximum tension, {SWAPPED_MM} mm where two cells change their places",
        GAIN_MM.max(GAIN_DOWN_MM)
    );
    assert!(page.join(" ").contains(&words), "{words}");
}
