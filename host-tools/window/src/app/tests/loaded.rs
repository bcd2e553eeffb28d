//! What a payload would spoil says so, and takes it off.

use super::Window;
use leg_firmware::supervisor::State;

/// A disarmed leg with 2 kg, at a guide of its calibrations.
fn loaded(guide: &str) -> Window {
    let mut window = Window::new();
    window.press("guide_payload");
    window.frames(50);
    window.press("disarm");
    while window.state() != State::Disarmed {
        window.frames(1);
    }
    assert!(window.says("finds a wrong zero"), "{:?}", window.texts);
    window.press("setup");
    window.press("setup_steps");
    window.press(guide);
    window.frames(20);
    window
}

#[test]
fn a_payload_is_named_in_the_page_and_taken_off_by_a_press() {
    for (guide, start) in [
        ("guide_tune", "tune_start"),
        ("guide_zero", "zero_start"),
        ("guide_motor", "jog_start"),
    ] {
        let mut window = loaded(guide);
        assert!(window.says("2.00 kg hang on the tip"), "{guide}");
        assert!(window.says("Take the payload off first."), "{guide}");
        window.press(start);
        window.frames(20);
        assert_eq!(window.state(), State::Disarmed, "{guide}");
        window.press("steps_payload_off");
        window.frames(40);
        assert!(!window.shows("steps_payload_off"), "{guide}");
        assert!(!window.says("hang on the tip"), "{guide}");
        window.press(start);
        assert_ne!(window.state(), State::Disarmed, "{guide}");
    }
}

/// The words about a zero that was found stand only where it is right.
#[test]
fn a_payload_that_is_hung_on_while_the_leg_homes_leaves_no_zero() {
    let mut window = loaded("guide_zero");
    window.press("steps_payload_off");
    window.frames(40);
    window.press("zero_start");
    window.frames(10);
    assert_eq!(window.state(), State::Homing);
    window.app.stage.leg_mut().hang(0.5);
    window.frames(30);
    assert!(window.says("hang on the tip: the zero that is found with it is wrong"));
    while window.state() == State::Homing {
        window.frames(1);
    }
    window.frames(50);
    assert!(!window.says("The zero is found"), "{:?}", window.texts);
}
