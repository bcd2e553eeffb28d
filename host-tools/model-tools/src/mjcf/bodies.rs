//! The bodies: the base, the leg and its payload, with the shapes that are shown.

use super::held::HeldLeg;
use super::joints::{Joint, Joints, Shape};
use super::scenery;
use crate::leg_shape::LegShape;
use crate::xml_element::Element;

/// Mass of the body between a pivot's two joints, kg. It lies at the joint centre and loads nothing.
const PIVOT_MASS_KG: f64 = 1e-6;

/// Inertia of that body beside the leg's about its axis.
const PIVOT_INERTIA_RATIO: f64 = 0.1;

/// Inertia of the drive of each of two tied joints beside the leg's: without it the two would be one at the vertical,
/// where their axes meet, and their constraint would be soft.
const TIED_ARMATURE_RATIO: f64 = 0.02;

const STEEL: [f64; 4] = [0.55, 0.58, 0.62, 1.0];
const PLATE: [f64; 4] = [0.25, 0.30, 0.36, 1.0];
const SEE_THROUGH: [f64; 4] = [0.25, 0.30, 0.36, 0.35];
const BRASS: [f64; 4] = [0.80, 0.62, 0.25, 1.0];

/// Name of the site where tendon `i` is fixed on the base plate.
pub(super) fn base_site(i: usize) -> String {
    format!("base_{}", i + 1)
}

/// Name of the site where tendon `i` is fixed on the leg.
pub(super) fn leg_site(i: usize) -> String {
    format!("leg_{}", i + 1)
}

/// The base plate, its anchors and all that hangs on the joint.
pub(super) fn world(leg: &HeldLeg, sizes: &LegShape, joints: &Joints) -> Element {
    let p = &leg.parameters;
    let world = Element::new("worldbody")
        .child(scenery::light(sizes.tip))
        .child(plate("base", sizes, p.upper_length_m, &SEE_THROUGH))
        .children(anchors(base_site, &p.base_anchors_m, p.upper_length_m));
    let hanging = leg_body(leg, sizes, joints);
    world.child(match &joints.pivot {
        None => hanging,
        Some(pivot) => pivot_body(leg, sizes, pivot).child(hanging),
    })
}

/// A body between two joints.
fn pivot_body(leg: &HeldLeg, sizes: &LegShape, pivot: &Joint) -> Element {
    let inertia = PIVOT_INERTIA_RATIO * leg_axial_inertia(sizes);
    Element::new("body")
        .text("name", "pivot")
        .child(inertial(0.0, PIVOT_MASS_KG, [inertia; 3]))
        .child(joint_element(leg, pivot))
}

/// Of the leg and its payload.
fn leg_axial_inertia(sizes: &LegShape) -> f64 {
    sizes.inertia[1] + sizes.payload_inertia
}

fn leg_body(leg: &HeldLeg, sizes: &LegShape, joints: &Joints) -> Element {
    let p = &leg.parameters;
    let [across, along] = sizes.inertia;
    let weight = (p.leg_mass_kg > 0.0)
        .then(|| inertial(-p.leg_centroid_m, p.leg_mass_kg, [across, across, along]));
    let tip = Element::new("site")
        .text("name", "tip")
        .numbers("pos", &[0.0, 0.0, -sizes.tip]);
    Element::new("body")
        .text("name", "leg")
        .children(weight)
        .children(joints.leg.iter().map(|joint| joint_element(leg, joint)))
        .children([centre(sizes), rod(sizes)])
        .child(plate("lower", sizes, -p.joint_length_m, &PLATE))
        .children(anchors(leg_site, &p.leg_anchors_m, -p.joint_length_m))
        .child(tip)
        .children((leg.payload_kg > 0.0).then(|| payload(leg, sizes)))
}

fn inertial(height: f64, mass: f64, inertia: [f64; 3]) -> Element {
    Element::new("inertial")
        .numbers("pos", &[0.0, 0.0, height])
        .numbers("mass", &[mass])
        .numbers("diaginertia", &inertia)
}

fn joint_element(leg: &HeldLeg, joint: &Joint) -> Element {
    let element = Element::new("joint").text("name", joint.name);
    let element = match joint.shape {
        Shape::Ball => element.text("type", "ball"),
        Shape::Hinge(axis) => element.text("type", "hinge").numbers("axis", &axis),
    };
    let element = element.numbers("damping", &[joint.damping * leg.damping_nm_s_per_rad()]);
    let element = if joint.spring > 0.0 {
        element.numbers("stiffness", &[joint.spring])
    } else {
        element
    };
    if joint.tied {
        let armature = TIED_ARMATURE_RATIO * leg.tilt_inertia_kg_m2();
        element.numbers("armature", &[armature])
    } else {
        element
    }
}

fn anchors(name: fn(usize) -> String, points: &[[f64; 2]; 3], height: f64) -> Vec<Element> {
    let site = |(i, &[x, y]): (usize, &[f64; 2])| {
        Element::new("site")
            .text("name", &name(i))
            .numbers("pos", &[x, y, height])
    };
    points.iter().enumerate().map(site).collect()
}

fn plate(name: &str, sizes: &LegShape, height: f64, rgba: &[f64]) -> Element {
    shape(name, "cylinder", rgba)
        .numbers("size", &[1.15 * sizes.ring, sizes.ring / 32.0])
        .numbers("pos", &[0.0, 0.0, height])
}

fn centre(sizes: &LegShape) -> Element {
    shape("joint", "sphere", &BRASS).numbers("size", &[sizes.ring / 8.0])
}

fn rod(sizes: &LegShape) -> Element {
    shape("rod", "cylinder", &STEEL)
        .numbers("size", &[sizes.rod])
        .numbers("fromto", &[0.0, 0.0, 0.0, 0.0, 0.0, -sizes.tip])
}

fn payload(leg: &HeldLeg, sizes: &LegShape) -> Element {
    let ball = shape("payload", "sphere", &BRASS)
        .numbers("size", &[sizes.payload])
        .numbers("mass", &[leg.payload_kg]);
    Element::new("body")
        .text("name", "payload")
        .numbers("pos", &[0.0, 0.0, -sizes.tip])
        .child(ball)
}

fn shape(name: &str, kind: &str, rgba: &[f64]) -> Element {
    Element::new("geom")
        .text("name", name)
        .text("type", kind)
        .numbers("rgba", rgba)
}
