//! Motors that differ: what `[actuator.2]` says beside `[actuator]` reaches the settings of the board, the simulated leg, what is
//! shown and what is written back, for that motor alone.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::rig::other_motors::work;
use leg_base::failure::Failure;
use leg_bench::moves::MoveCampaign;
use leg_firmware::settings::{CurrentOutput, Settings};
use leg_rig::control_settings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_rig::{rig_settings, rig_show, settings_text};

/// Motor 2 has half more friction than the others and 0.8 times their torque constant.
const OWN: &str = "[actuator.2]\nfriction_nm = 1.35e-3\ntorque_constant_nm_per_a = 0.01872\n";

fn rig(more: &str) -> RigFile {
    RigFile::parse("own motors", &[READY_RIGS[0].text, more].concat()).unwrap()
}

fn settings(rig: &RigFile) -> Settings {
    control_settings::settings(rig, &rig.gains, None)
}

#[test]
fn a_motors_own_data_reach_its_servo_alone() {
    let [usual, ..] = settings(&rig("")).servos;
    let [first, second, third] = settings(&rig(OWN)).servos;
    assert_eq!([first, third], [usual; 2]);
    for (found, default, ratio) in [
        (second.friction_a, first.friction_a, 1.5 / 0.8),
        (second.pull_a_per_n, first.pull_a_per_n, 1.0 / 0.8),
        (second.back_emf_v_s_per_m, first.back_emf_v_s_per_m, 0.8),
        (
            second.speed_gain_v_s_per_m,
            first.speed_gain_v_s_per_m,
            1.0 / 0.8,
        ),
        (second.resistance_ohm, first.resistance_ohm, 1.0),
    ] {
        // Derived numbers have two digits.
        assert!((found / default / ratio - 1.0).abs() < 0.06, "{second:?}");
    }
}

/// What the leg has once is what the weakest motor allows, and what the strongest one asks.
#[test]
fn what_all_motors_have_together_serves_each() {
    let (one, all) = (
        settings(&rig(OWN)),
        settings(&rig(
            "[actuator]\nfriction_nm = 1.35e-3\ntorque_constant_nm_per_a = 0.01872\n",
        )),
    );
    let [own, usual] = [&all, &settings(&rig(""))];
    let limits = |settings: &Settings| settings.limits.disagreement_a;
    assert_eq!(limits(&one), limits(own).max(limits(usual)));
    let speed = |settings: &Settings| settings.motion.speed_rad_per_s;
    assert_eq!(speed(&one), speed(own).min(speed(usual)));
    assert_ne!(limits(own), limits(usual));
}

#[test]
fn own_gains_and_own_sensors_are_the_motors_alone() {
    let found = settings(&rig(
        "[actuator]\ncounts_per_turn = 4096\n[actuator.3]\ncounts_per_turn = 1024\ncurrent_range_a = 20\n\
         cell_range_n = [-40, 460]\n[control.servo]\nduty_max = 0.9\n[control.servo.1]\nduty_max = 0.8\n",
    ));
    assert_eq!(found.servos.map(|servo| servo.duty_max), [0.8, 0.9, 0.9]);
    let [first, second, third] = found.axes;
    assert_eq!(first, second);
    for (own, other, ratio) in [
        (third.m_per_count, first.m_per_count, 4.0),
        (
            third.current_a_per_code,
            first.current_a_per_code,
            20.0 / 12.0,
        ),
        (third.cell_n_per_code, first.cell_n_per_code, 2.0),
    ] {
        assert!((own / other / ratio - 1.0).abs() < 1e-6, "{third:?}");
    }
}

#[test]
fn what_differs_is_shown_by_motor_and_what_is_common_once() {
    let file = rig(OWN);
    let words = rig_show::words(&file);
    println!("{words}");
    for line in [
        "actuator.2             friction_nm = 0.00135 instead of 9e-4",
        "actuator.2             torque_constant_nm_per_a = 0.01872 instead of 0.0234",
        "control.servo.resistance_ohm ",
        "control.servo.1.friction_a ",
        "control.servo.2.friction_a ",
        "control.servo.3.friction_a ",
        "; the greatest of the three motors",
        "; the least of the three motors",
    ] {
        assert!(words.contains(line), "{line}");
    }
    assert!(!rig_show::words(&rig("")).contains("three motors"));
    let all = rig_settings::actuator(&file);
    let sections = |key: &str| -> Vec<String> {
        let found = all.iter().filter(|setting| setting.key == key);
        found.map(|setting| setting.section.clone()).collect()
    };
    assert_eq!(sections("gear_ratio"), ["actuator"]);
    assert_eq!(
        sections("friction_nm"),
        ["actuator.1", "actuator.2", "actuator.3"]
    );
}

/// A board's settings as a file give the same bits again.
#[test]
fn what_is_written_back_is_the_same() {
    for more in [OWN, "[control.servo.3]\nplay_m = 1e-5\n"] {
        let before = settings(&rig(more));
        let text = settings_text::rig_file(&before);
        let again = RigFile::parse("again", &text).unwrap();
        assert_eq!(settings(&again), before, "{text}");
    }
}

/// The leg homes, moves and holds with motors that differ by their data sheets, and the tip keeps to the bars of moves.
#[test]
fn a_leg_whose_motors_differ_moves_within_the_bars() {
    let file = rig(OWN);
    work("own motors", &file).unwrap();
    let campaign = MoveCampaign {
        seed: 7,
        rigs: vec![("own motors".into(), file)],
        payload_kg: None,
    };
    let made = campaign.run(0..14, || ());
    assert_eq!(made.len(), 14);
    for moved in made {
        println!("{:.3} mm off, {:.3} mm swing", moved.off_mm, moved.swing_mm);
        assert!(moved.passes(), "{moved:?}");
    }
}

/// Motors of three kinds on one leg.
#[test]
fn a_leg_with_three_kinds_of_motors_works() {
    let more = "[actuator.1]\ngear_ratio = 14\ncounts_per_turn = 512\n[actuator.2]\nfriction_nm = 3.6e-3\ngear_efficiency = 0.7\n\
                [actuator.3]\ninertia_kg_m2 = 6e-6\nbacklash_rad = 0.03\n";
    work("three kinds", &rig(more)).unwrap();
}

/// What a file is refused for: the words, and what stands at the place.
#[test]
fn what_a_motor_cannot_have_is_refused_at_its_own_key() {
    for (more, words, place) in [
        (
            "[actuator.2]\nsupply_v = 48\n",
            "unknown key `supply_v`",
            "supply_v",
        ),
        ("[actuator.4]\ngear_ratio = 3\n", "unknown key `4`", "4"),
        (
            "[actuator.2]\ngear_ratio = 0\n",
            "`gear_ratio` is outside",
            "0",
        ),
        (
            "[actuator.2]\ncurrent_range_a = 2\n",
            "motor 2: `control.servo.current_a` (0.9) cannot pull the maximum tension",
            "2\n",
        ),
        (
            "[actuator.2]\ncurrent_range_a = 4\n",
            "has to be below `control.limits.current_a` (3.6)",
            "4\n",
        ),
        (
            "[control.servo.3]\ncurrent_a = 0.6\n",
            "motor 3: `control.servo.current_a` (0.6) cannot pull",
            "0.6",
        ),
    ] {
        let file = [READY_RIGS[0].text, more].concat();
        let error = RigFile::parse("refused", &file).unwrap_err();
        let shown = error.render(false);
        assert!(shown.contains(words), "{more}{shown}");
        let (Failure::Refused(message) | Failure::Failed(message)) = error;
        let at = &file[message.place.unwrap().span.start..];
        assert!(at.starts_with(place), "{more}{at}");
    }
}

/// What the outputs show of the currents reaches the board motor by motor, and what is written back is the same.
#[test]
fn each_motor_may_have_its_own_current_output() {
    let file = rig("[actuator]\ncurrent_output = \"magnitude\"\n\
                    [actuator.2]\ncurrent_output = \"magnitude_when_driven\"\n\
                    [actuator.3]\ncurrent_output = \"bidirectional\"\n");
    let found = settings(&file);
    let outputs = [
        CurrentOutput::Magnitude,
        CurrentOutput::MagnitudeWhenDriven,
        CurrentOutput::Bidirectional,
    ];
    assert_eq!(found.current_outputs.each(), outputs);
    // The whole range of the converter is that of the magnitude.
    let [first, second, third] = found.axes.map(|axis| axis.current_a_per_code);
    assert_eq!([first, first + second], [second, third]);
    let words = "current outputs        magnitude, magnitude_when_driven, bidirectional";
    assert!(rig_show::words(&file).contains(words));
    assert!(!rig_show::words(&rig("")).contains("current outputs"));
    let again = RigFile::parse("again", &settings_text::rig_file(&found)).unwrap();
    assert_eq!(settings(&again), found);
    let more = "[actuator.2]\ncurrent_output = \"unipolar\"\n";
    let refused = RigFile::parse("refused", &[READY_RIGS[0].text, more].concat()).unwrap_err();
    let shown = refused.render(false);
    for words in [
        "`current_output` cannot be `unipolar`",
        "\"magnitude_when_driven\"",
    ] {
        assert!(shown.contains(words), "{shown}");
    }
}
