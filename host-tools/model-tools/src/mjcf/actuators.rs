//! What pulls the tendons, and what is measured.
//!
//! The tendon and its motor are one actuator of MuJoCo: its control is how far the motor shall have reeled in from the pose
//! of the key `held`, m, which it follows with the servo's time constant; its force is the tension, a spring's and a
//! damper's that only pull.

use super::bodies::{base_site, leg_site, name};
use super::held::{HeldLeg, HeldTendon};
use super::joints::Damper;
use crate::xml_element::Element;

/// Highest tension, N: none, which MuJoCo has to be told as a number. The simulated tendon does not break either.
const TENSION_MAX_N: f64 = 1e6;

/// The tendons' paths.
pub(super) fn paths(prefix: &str) -> Vec<Element> {
    let path = |i: usize| {
        Element::new("spatial")
            .text("name", &tendon_name(prefix, i))
            .child(Element::new("site").text("site", &base_site(prefix, i)))
            .child(Element::new("site").text("site", &leg_site(prefix, i)))
    };
    (0..3).map(path).collect()
}

/// What damps two joints together: a tendon of MuJoCo that is none of the leg's.
pub(super) fn damper(leg: &HeldLeg, prefix: &str, damper: &Damper) -> Element {
    let joint = |(joint, sign): (&str, f64)| {
        Element::new("joint")
            .text("joint", &name(prefix, joint))
            .numbers("coef", &[sign])
    };
    Element::new("fixed")
        .text("name", &name(prefix, "joint_damper"))
        .numbers(
            "damping",
            &[damper.damping * leg.joint_damping_nm_s_per_rad],
        )
        .children(damper.joints.into_iter().zip(damper.signs).map(joint))
}

/// One actuator a tendon: with gear −1, its force is positive where it pulls.
pub(super) fn motors(leg: &HeldLeg, prefix: &str) -> Vec<Element> {
    let motor = |(i, tendon): (usize, &HeldTendon)| {
        let stiffness = tendon.stiffness_n_per_m;
        Element::new("general")
            .text("name", &motor_name(prefix, i))
            .text("tendon", &tendon_name(prefix, i))
            .numbers("gear", &[-1.0])
            .numbers("ctrlrange", &tendon.travel_m)
            .numbers("forcerange", &[0.0, TENSION_MAX_N])
            .text("dyntype", "filterexact")
            .numbers("dynprm", &[tendon.servo_time_s])
            .numbers("gainprm", &[stiffness])
            .text("biastype", "affine")
            .numbers(
                "biasprm",
                &[
                    -stiffness * tendon.unstretched_m,
                    -stiffness,
                    -leg.tendon_damping_n_s_per_m,
                ],
            )
    };
    leg.tendons.iter().enumerate().map(motor).collect()
}

/// Tensions, N; lengths, m, and their rates, m/s; where the tip is, m, and the leg's axis, in the world.
pub(super) fn sensors(prefix: &str) -> Vec<Element> {
    let tension = |i: usize| {
        Element::new("actuatorfrc")
            .text("name", &format!("{prefix}tension_{}", i + 1))
            .text("actuator", &motor_name(prefix, i))
    };
    let of_tendon = |kind: &'static str, name: &'static str| {
        (0..3).map(move |i| {
            Element::new(kind)
                .text("name", &format!("{prefix}{name}_{}", i + 1))
                .text("tendon", &tendon_name(prefix, i))
        })
    };
    let tip = Element::new("framepos")
        .text("name", &name(prefix, "tip"))
        .text("objtype", "site")
        .text("objname", &name(prefix, "tip"));
    let axis = Element::new("framezaxis")
        .text("name", &name(prefix, "axis"))
        .text("objtype", "xbody")
        .text("objname", &name(prefix, "leg"));
    (0..3)
        .map(tension)
        .chain(of_tendon("tendonpos", "length"))
        .chain(of_tendon("tendonvel", "rate"))
        .chain([tip, axis])
        .collect()
}

/// What an encoder's count is made of, for each of a leg's tendons: MuJoCo has no sensor of how far a motor has reeled in.
/// [`COUNTS`] says how.
pub(super) fn encoders(leg: &HeldLeg) -> Element {
    let numeric = |name: &str, of: &dyn Fn(&HeldTendon) -> f64| {
        Element::new("numeric")
            .text("name", name)
            .numbers("data", &leg.tendons.each_ref().map(of))
    };
    Element::new("custom")
        .child(numeric("counts_per_m", &|tendon| 1.0 / tendon.m_per_count))
        .child(numeric("unstretched_m", &|tendon| tendon.unstretched_m))
        .child(numeric("stiffness_n_per_m", &|tendon| {
            tendon.stiffness_n_per_m
        }))
        .child(numeric("damping_n_s_per_m", &|_| {
            leg.tendon_damping_n_s_per_m
        }))
}

/// An encoder's count, by the names of sensors and numbers.
pub(super) const COUNTS: &str = "counts_per_m * (unstretched_m - length + (tension - damping_n_s_per_m * rate) / stiffness_n_per_m)";

fn tendon_name(prefix: &str, i: usize) -> String {
    format!("{prefix}tendon_{}", i + 1)
}

fn motor_name(prefix: &str, i: usize) -> String {
    format!("{prefix}motor_{}", i + 1)
}
