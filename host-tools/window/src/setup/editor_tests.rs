#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::Editor;
use leg_rig::ready_rigs::{READY_RIGS, ReadyRig};
use leg_rig::rig_file::{RigFile, RigText};

fn source(rig: &ReadyRig) -> RigText {
    RigText {
        name: "mine.toml".into(),
        text: rig.text.into(),
    }
}

fn editor() -> Editor {
    Editor::new(&source(&READY_RIGS[0])).unwrap()
}

fn value(editor: &Editor, section: &str, key: &str) -> String {
    let row = editor.rows().iter().find(|row| row.is(section, key));
    row.unwrap().value.clone()
}

#[test]
fn what_is_saved_reads_back_as_it_was_edited() {
    for rig in READY_RIGS {
        let mut editor = Editor::new(&source(&rig)).unwrap();
        assert!(editor.changes().is_empty());
        assert!(editor.set("control.limits", "jump_n", "31.5"));
        assert!(editor.set("geometry", "leg_mm", "180"));
        let read = RigFile::parse("saved", &editor.text()).unwrap();
        assert_eq!(read.gains.limits.jump_n, 31.5);
        assert_eq!(read.parameters.leg_length_m, 0.18);
        assert_eq!(editor.settings().limits.jump_n, 31.5);
    }
}

#[test]
fn a_value_is_refused_by_its_key_with_the_remedy_and_nothing_changes() {
    let mut editor = editor();
    for (section, key, typed, expected) in [
        (
            "control.limits",
            "jump_n",
            "1e9",
            "`jump_n` is outside 0.1 to 10000",
        ),
        ("control.limits", "jump_n", "fast", "write a number"),
        (
            "control.limits",
            "jump_n",
            "\"30\"",
            "has to be a decimal number",
        ),
        ("tendon", "pretension_n", "200", "give at"),
        (
            "geometry",
            "base_anchors_mm",
            "[[24, 0]]",
            "give three anchors",
        ),
        ("support", "kind", "rubber", "write one of"),
        ("calibration", "counts_sign", "[1, 0, 1]", "write 1 or -1"),
    ] {
        assert!(!editor.set(section, key, typed), "{key} {typed}");
        let refused = editor.refused().unwrap();
        assert_eq!([&*refused.section, &*refused.key], [section, key]);
        assert!(refused.words.contains(expected), "{}", refused.words);
    }
    assert_eq!(editor.text(), READY_RIGS[0].text);
    assert_eq!(editor.steps(), [false, false]);
    assert!(editor.set("support", "kind", "spherical"));
    assert_eq!(editor.refused(), None);
}

#[test]
fn changes_are_taken_back_and_made_again() {
    let mut editor = editor();
    let key = ("control.motion", "speed_rad_per_s");
    for typed in ["0.7", "0.6"] {
        assert!(editor.set(key.0, key.1, typed));
    }
    // The same once more is no change.
    assert!(editor.set(key.0, key.1, "0.6"));
    editor.undo();
    assert_eq!(value(&editor, key.0, key.1), "0.7");
    editor.undo();
    editor.undo();
    assert_eq!(editor.text(), READY_RIGS[0].text);
    editor.redo();
    assert_eq!(value(&editor, key.0, key.1), "0.7");
    assert!(editor.set(key.0, key.1, "0.5"));
    assert_eq!(editor.steps(), [true, false]);
    for number in 0..300 {
        assert!(editor.set(key.0, key.1, &format!("0.6{number:03}")));
    }
    let mut taken_back = 0;
    while editor.steps()[0] {
        editor.undo();
        taken_back += 1;
    }
    assert_eq!(taken_back, super::UNDO_MAX);
}

#[test]
fn a_setting_goes_back_to_the_file_or_to_its_default() {
    let text = [READY_RIGS[0].text, "[control.limits]\njump_n = 30\n"].concat();
    let mut editor = Editor::new(&RigText {
        name: "mine".into(),
        text: text.clone(),
    })
    .unwrap();
    let key = ("control.limits", "jump_n");
    assert!(editor.set(key.0, key.1, "40"));
    assert!(editor.reset_to_default(key.0, key.1));
    assert_eq!(value(&editor, key.0, key.1), "25");
    let [change] = &editor.changes()[..] else {
        panic!()
    };
    assert_eq!(
        (change.was.as_deref(), change.now.as_deref()),
        (Some("30 N"), Some("25 N"))
    );
    assert!(editor.reset_to_file(key.0, key.1));
    assert!(editor.changes().is_empty());
    assert!(editor.set("control.motion", "speed_rad_per_s", "0.7"));
    editor.all_to_file();
    assert_eq!(editor.text(), text);
    editor.undo();
    assert_eq!(value(&editor, "control.motion", "speed_rad_per_s"), "0.7");
    // What the file has to give cannot be taken out.
    assert!(!editor.reset_to_default("geometry", "leg_mm"));
    assert!(
        editor
            .refused()
            .unwrap()
            .words
            .contains("missing key `leg_mm`")
    );
}

#[test]
fn what_follows_from_a_change_is_told_apart() {
    let mut editor = editor();
    assert!(editor.set("actuator", "gear_ratio", "8"));
    let changes = editor.changes();
    let find = |name: &str| changes.iter().find(|change| change.name == name).unwrap();
    assert!(!find("actuator.gear_ratio").follows);
    assert!(find("control.servo.back_emf_v_s_per_m").follows);
}
