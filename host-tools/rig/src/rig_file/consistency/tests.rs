#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::ready_rigs::READY_RIGS;
use crate::rig_file::RigFile;

/// Each is refused with both values, at one that is given; what is just good enough is taken.
#[test]
fn limits_that_contradict_each_other_are_refused() {
    for (section, key, bad, good, words) in [
        (
            "control.limits",
            "supply_min_v",
            "24",
            "23.9",
            "`control.limits.supply_min_v` (24) has to be below `actuator.supply_v` (24)",
        ),
        (
            "control.limits",
            "supply_max_v",
            "24",
            "24.1",
            "`actuator.supply_v` (24) has to be below `control.limits.supply_max_v` (24)",
        ),
        (
            "control.limits",
            "temperature_c",
            "160",
            "159",
            "`control.limits.temperature_c` (160) has to be below",
        ),
        (
            "control.limits",
            "slack_n",
            "8",
            "7.9",
            "`control.limits.slack_n` (8) has to be below `tendon.f_min_n` (8)",
        ),
        (
            "control.homing",
            "touch_n",
            "15",
            "14.9",
            "`control.homing.touch_n` (15) has to be below `control.homing.f_max_n` (15)",
        ),
        (
            "control.homing",
            "f_max_n",
            "151",
            "150",
            "`control.homing.f_max_n` (151) has to be at most `tendon.f_max_n` (150)",
        ),
        (
            "control.homing",
            "speed_m_per_s",
            "0.031",
            "0.03",
            "`control.homing.speed_m_per_s` (0.031) has to be at most `control.servo.speed_m_per_s` (0.03)",
        ),
        (
            "control.limits",
            "ramp_m_per_s",
            "0.031",
            "0.03",
            "`control.limits.ramp_m_per_s` (0.031) has to be at most `control.servo.speed_m_per_s` (0.03)",
        ),
    ] {
        let text = |value| format!("{}\n[{section}]\n{key} = {value}\n", READY_RIGS[0].text);
        let Err(error) = RigFile::parse("a.toml", &text(bad)) else {
            panic!("{key} = {bad} is accepted");
        };
        let shown = error.render(false);
        let given = format!("{key} = {bad}");
        let found = |at: &&str| shown.contains(at);
        let places = ["f_min_n = ", "f_max_n = 150", &given];
        assert!(shown.contains(words), "{shown}");
        assert!(places.iter().any(found), "{shown}");
        RigFile::parse("a.toml", &text(good)).unwrap();
    }
}

/// The paper's rig with a key of a section.
fn with(section: &str, key: &str, value: &str) -> String {
    format!("{}\n[{section}]\n{key} = {value}\n", READY_RIGS[0].text)
}

/// Settings with which each value is in its range, and no leg works or no monitor finds what it looks for; what is just good enough is taken.
#[test]
fn settings_that_cannot_work_are_refused() {
    let mut wrong = Vec::new();
    for (section, key, bad, good, words) in [
        (
            "actuator",
            "cell_range_n",
            "[-20, 164]",
            "[-20, 166]",
            "is saturated above 160 N, before its tension is found too high: `tendon.f_max_n` (150)",
        ),
        (
            "actuator",
            "cell_range_n",
            "[-2, 230]",
            "[-3, 230]",
            "is saturated below -1.8 N, and so is a slack one",
        ),
        (
            "calibration",
            "cell_n_per_code",
            "[3.9e-4, 3.9e-4, 3.9e-4]",
            "[3.9e-3, 3.9e-3, 3.9e-3]",
            "is saturated above 23 N",
        ),
        (
            "actuator",
            "cell_range_n",
            "[-2000, 23000]",
            "[-150, 1800]",
            "a step of load cell 1 (`actuator.cell_range_n`, `calibration`) is 6.1 N, too coarse for `control.homing.touch_n` (2)",
        ),
        (
            "simulation",
            "cell_noise_n",
            "0",
            "0.002",
            "the codes of the simulated load cells do not change",
        ),
        (
            "control.homing",
            "release_m",
            "0.05",
            "0.012",
            "`control.homing.release_m` (0.05) has to be below `control.homing.travel_m` (0.05)",
        ),
        (
            "control.limits",
            "relax_travel_m",
            "0.0024",
            "0.0026",
            "and `control.limits.relax_travel_m` (0.0024) does not make it slack",
        ),
        (
            "control.limits",
            "taut_time_s",
            "1",
            "1.1",
            "does not take up 0.005 m of slack",
        ),
        (
            "control.limits",
            "driven_part",
            "0.96",
            "0.9",
            "is jammed, or counts the wrong way, is not found",
        ),
        (
            "control.limits",
            "following_m",
            "0.00011",
            "0.00012",
            "`control.limits.following_m` (1.1e-4) is less than what a sound motor stays behind",
        ),
        (
            "control.servo",
            "dead_band_m",
            "0.0006",
            "0.0005",
            "is less than what a sound motor stays behind, at rest in `control.servo.dead_band_m` (6e-4)",
        ),
        (
            "control.limits",
            "disagreement_a",
            "3.9",
            "3.8",
            "no current differs by `control.limits.disagreement_a` (3.9)",
        ),
        (
            "control.limits",
            "residual_m",
            "1e-6",
            "5e-5",
            "is less than what counts and load cells resolve",
        ),
        (
            "control.limits",
            "residual_change_m",
            "9e-5",
            "8e-5",
            "comes first, and a load cell that is off is not found",
        ),
    ] {
        let refused = RigFile::parse("a.toml", &with(section, key, bad));
        let shown = refused
            .err()
            .map_or_else(String::new, |error| error.render(false));
        let given = format!("{key} = {bad}");
        if !shown.contains(words) || !shown.contains(&given) {
            wrong.push(format!("{given}: {shown}"));
        }
        if let Err(error) = RigFile::parse("a.toml", &with(section, key, good)) {
            wrong.push(format!("{key} = {good}: {}", error.render(false)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Tendons that stretch more are paid out farther, and given as much more time.
#[test]
fn softer_tendons_are_relaxed_as_far_as_they_stretch() {
    let (mechanism, rest) = READY_RIGS[0].text.split_once("[tendon.curve]").unwrap();
    let (_, workspace) = rest.split_once("[workspace]").unwrap();
    let soft = mechanism.replace("stiffness_at = \"pretension\"", "stiffness_n_per_m = 9945");
    let rig = RigFile::parse("a.toml", &format!("{soft}[workspace]{workspace}")).unwrap();
    let limits = &rig.gains.limits;
    assert_eq!((limits.relax_travel_m, limits.taut_time_s), (0.023, 5.5));
}
