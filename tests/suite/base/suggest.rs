//! What is offered for a mistyped key.

use leg_base::suggest::key_remedy;

#[test]
fn a_wrong_unit_is_answered_with_the_right_one() {
    assert_eq!(
        key_remedy("upper_cm", &["upper_mm", "joint_mm", "leg_mm"]),
        "the key here is `upper_mm`; mind its unit"
    );
}

#[test]
fn a_slip_of_the_pen_is_answered_with_the_right_key() {
    assert_eq!(
        key_remedy("uper_mm", &["upper_mm"]),
        "the key here is `upper_mm`"
    );
    assert_eq!(key_remedy("masses", &["mass"]), "the key here is `mass`");
}

#[test]
fn a_strange_key_is_answered_with_all_of_them() {
    assert_eq!(
        key_remedy("colour", &["leg_kg", "pretension_n"]),
        "the keys here are `leg_kg`, `pretension_n`"
    );
}
