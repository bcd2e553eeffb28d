//! Links and joints of a leg, and the body of several.

use super::JointLimits;
use crate::leg_shape::{Body, LegShape};
use crate::xml_element::Element;
use leg_rig::rig_file::RigFile;

/// Mass and inertia of the link between the two joints: readers want some. It lies at the joint centre and loads nothing.
const CROSS_MASS_KG: f64 = 1e-6;
const CROSS_INERTIA_KG_M2: f64 = 1e-9;

/// The links and joints of a leg, their names with a prefix.
pub(super) fn leg(
    rig: &RigFile,
    payload_kg: f64,
    shape: &LegShape,
    limits: JointLimits,
    prefix: &str,
) -> Vec<Element> {
    let [upper, lower] = [
        rig.parameters.upper_length_m,
        -rig.parameters.joint_length_m,
    ];
    let base = link(prefix, "base").child(visual(upper, plate(shape)));
    let cross = link(prefix, "cross").child(inertial(0.0, CROSS_MASS_KG, [CROSS_INERTIA_KG_M2; 3]));
    let [across, along] = shape.inertia;
    let mass = rig.parameters.leg_mass_kg;
    let weight = (mass > 0.0).then(|| {
        inertial(
            -rig.parameters.leg_centroid_m,
            mass,
            [across, across, along],
        )
    });
    let rod = Element::new("cylinder")
        .numbers("radius", &[shape.rod])
        .numbers("length", &[shape.tip]);
    let leg = link(prefix, "leg")
        .children(weight)
        .child(visual(-shape.tip / 2.0, rod))
        .child(visual(0.0, sphere(shape.ring / 8.0)))
        .child(visual(lower, plate(shape)));
    let mut elements = vec![
        base,
        revolute(prefix, ["tilt_x", "base", "cross"], 0, limits),
        cross,
        revolute(prefix, ["tilt_y", "cross", "leg"], 1, limits),
        leg,
        joint(prefix, "fixed", ["tip", "leg", "tip"])
            .child(origin([0.0, 0.0, -shape.tip], [0.0; 3])),
    ];
    let tip = link(prefix, "tip");
    elements.push(if payload_kg > 0.0 {
        tip.child(inertial(0.0, payload_kg, [shape.payload_inertia; 3]))
            .child(visual(0.0, sphere(shape.payload)))
    } else {
        tip
    });
    elements
}

/// The body of several legs: a disc.
pub(super) fn body(body: &Body, shape: &LegShape) -> Element {
    let (radius, mass) = (body.radius_m, body.mass_kg);
    let along = mass * radius * radius / 2.0;
    let disc = Element::new("cylinder")
        .numbers("radius", &[radius])
        .numbers("length", &[shape.ring / 4.0]);
    link("", "body")
        .child(inertial(0.0, mass, [along / 2.0, along / 2.0, along]))
        .child(visual(0.0, disc))
}

/// Fixes a leg to the body, its x axis outwards.
pub(super) fn mount(prefix: &str, radius: f64, angle: f64) -> Element {
    let place = [radius * angle.cos(), radius * angle.sin(), 0.0];
    Element::new("joint")
        .text("name", &format!("{prefix}mount"))
        .text("type", "fixed")
        .child(Element::new("parent").text("link", "body"))
        .child(Element::new("child").text("link", &format!("{prefix}base")))
        .child(origin(place, [0.0, 0.0, angle]))
}

fn link(prefix: &str, name: &str) -> Element {
    Element::new("link").text("name", &format!("{prefix}{name}"))
}

fn revolute(
    prefix: &str,
    [name, parent, child]: [&str; 3],
    axis: usize,
    limits: JointLimits,
) -> Element {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let zero = limits.zeros_rad[axis];
    let turned = axes[axis].map(|part: f64| part * zero);
    let limit = Element::new("limit")
        .numbers("lower", &[-limits.tilt_rad - zero])
        .numbers("upper", &[limits.tilt_rad - zero])
        .numbers("effort", &limits.moment_nm[axis..=axis])
        .numbers("velocity", &[limits.speed_rad_per_s]);
    joint(prefix, "revolute", [name, parent, child])
        .child(origin([0.0; 3], turned))
        .child(Element::new("axis").numbers("xyz", &axes[axis]))
        .child(limit)
}

fn joint(prefix: &str, kind: &str, [name, parent, child]: [&str; 3]) -> Element {
    let linked = |role, name: &str| Element::new(role).text("link", &format!("{prefix}{name}"));
    Element::new("joint")
        .text("name", &format!("{prefix}{name}"))
        .text("type", kind)
        .child(linked("parent", parent))
        .child(linked("child", child))
}

fn origin(place: [f64; 3], roll_pitch_yaw: [f64; 3]) -> Element {
    Element::new("origin")
        .numbers("xyz", &place)
        .numbers("rpy", &roll_pitch_yaw)
}

fn inertial(height: f64, mass: f64, [xx, yy, zz]: [f64; 3]) -> Element {
    let inertia = Element::new("inertia")
        .numbers("ixx", &[xx])
        .numbers("iyy", &[yy])
        .numbers("izz", &[zz])
        .numbers("ixy", &[0.0])
        .numbers("ixz", &[0.0])
        .numbers("iyz", &[0.0]);
    Element::new("inertial")
        .child(origin([0.0, 0.0, height], [0.0; 3]))
        .child(Element::new("mass").numbers("value", &[mass]))
        .child(inertia)
}

fn visual(height: f64, shape: Element) -> Element {
    Element::new("visual")
        .child(origin([0.0, 0.0, height], [0.0; 3]))
        .child(Element::new("geometry").child(shape))
}

fn plate(shape: &LegShape) -> Element {
    Element::new("cylinder")
        .numbers("radius", &[1.15 * shape.ring])
        .numbers("length", &[shape.ring / 16.0])
}

fn sphere(radius: f64) -> Element {
    Element::new("sphere").numbers("radius", &[radius])
}
