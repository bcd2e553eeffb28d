//! The bodies: the base, the leg and its payload, with the shapes that are shown.

use super::held::HeldLeg;
use super::joints::{Joint, Joints, Shape};
use crate::leg_shape::{Body, LegShape};
use crate::xml_element::Element;
use nalgebra::Vector3;
use std::f64::consts::TAU;

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
pub(super) fn base_site(prefix: &str, i: usize) -> String {
    format!("{prefix}base_{}", i + 1)
}

/// Name of the site where tendon `i` is fixed on the leg.
pub(super) fn leg_site(prefix: &str, i: usize) -> String {
    format!("{prefix}leg_{}", i + 1)
}

/// The base plate, its anchors and all that hangs on the joint, the names with a prefix; its origin is the joint centre.
pub(super) fn hanging(leg: &HeldLeg, joints: &Joints, prefix: &str) -> Vec<Element> {
    let (p, sizes) = (&leg.parameters, &leg.shape);
    let base = plate(&name(prefix, "base"), sizes, p.upper_length_m, &SEE_THROUGH);
    let mut elements = vec![base];
    let site = |i| base_site(prefix, i);
    elements.extend(anchors(site, &p.base_anchors_m, p.upper_length_m));
    let body = leg_body(leg, joints, prefix);
    elements.push(match &joints.pivot {
        None => body,
        Some(pivot) => pivot_body(leg, pivot, prefix).child(body),
    });
    elements
}

/// Several legs around a body that floats: a disc with its origin in the plane of the joint centres, so high (m) that the
/// legs' tips stand on the floor.
pub(super) fn floating(leg: &HeldLeg, joints: &Joints, body: &Body) -> Element {
    let (radius, mass) = (body.radius_m, body.mass_kg);
    let along = mass * radius * radius / 2.0;
    let disc =
        shape("disc", "cylinder", &SEE_THROUGH).numbers("size", &[radius, leg.shape.ring / 8.0]);
    let legs = (0..body.legs).map(|i| {
        let angle = TAU * f64::from(i) / f64::from(body.legs);
        let prefix = prefix(i);
        Element::new("body")
            .text("name", &name(&prefix, "mount"))
            .numbers("pos", &[radius * angle.cos(), radius * angle.sin(), 0.0])
            .numbers("axisangle", &[0.0, 0.0, 1.0, angle])
            .children(hanging(leg, joints, &prefix))
    });
    Element::new("body")
        .text("name", "body")
        .numbers("pos", &[0.0, 0.0, height_m(leg)])
        .child(Element::new("freejoint").text("name", "body"))
        .child(inertial(0.0, mass, [along / 2.0, along / 2.0, along]))
        .child(disc)
        .children(legs)
}

/// Prefix of the names of leg `i` of several.
pub(super) fn prefix(i: u32) -> String {
    format!("leg_{}_", i + 1)
}

pub(super) fn name(prefix: &str, name: &str) -> String {
    format!("{prefix}{name}")
}

/// The joint centres above the floor while the feet touch it, m.
pub(super) fn height_m(leg: &HeldLeg) -> f64 {
    (leg.rotation * Vector3::z()).z * leg.shape.tip + leg.shape.rod
}

/// A body between two joints.
fn pivot_body(leg: &HeldLeg, pivot: &Joint, prefix: &str) -> Element {
    let inertia = PIVOT_INERTIA_RATIO * leg_axial_inertia(&leg.shape);
    Element::new("body")
        .text("name", &name(prefix, "pivot"))
        .child(inertial(0.0, PIVOT_MASS_KG, [inertia; 3]))
        .child(joint_element(leg, pivot, prefix))
}

/// Of the leg and its payload.
fn leg_axial_inertia(sizes: &LegShape) -> f64 {
    sizes.inertia[1] + sizes.payload_inertia
}

fn leg_body(leg: &HeldLeg, joints: &Joints, prefix: &str) -> Element {
    let (p, sizes) = (&leg.parameters, &leg.shape);
    let [across, along] = sizes.inertia;
    let weight = (p.leg_mass_kg > 0.0)
        .then(|| inertial(-p.leg_centroid_m, p.leg_mass_kg, [across, across, along]));
    let tip = Element::new("site")
        .text("name", &name(prefix, "tip"))
        .numbers("pos", &[0.0, 0.0, -sizes.tip]);
    let joints = joints.leg.iter();
    let site = |i| leg_site(prefix, i);
    Element::new("body")
        .text("name", &name(prefix, "leg"))
        .children(weight)
        .children(joints.map(|joint| joint_element(leg, joint, prefix)))
        .children([centre(sizes, prefix), rod(sizes, prefix)])
        .child(plate(
            &name(prefix, "lower"),
            sizes,
            -p.joint_length_m,
            &PLATE,
        ))
        .children(anchors(site, &p.leg_anchors_m, -p.joint_length_m))
        .child(tip)
        .children((!prefix.is_empty()).then(|| foot(sizes, prefix)))
        .children((leg.payload_kg > 0.0).then(|| payload(leg, prefix)))
}

/// What stands on the floor.
fn foot(sizes: &LegShape, prefix: &str) -> Element {
    shape(&name(prefix, "foot"), "sphere", &STEEL)
        .numbers("size", &[sizes.rod])
        .numbers("pos", &[0.0, 0.0, -sizes.tip])
        .numbers("contype", &[1.0])
        .numbers("conaffinity", &[1.0])
}

fn inertial(height: f64, mass: f64, inertia: [f64; 3]) -> Element {
    Element::new("inertial")
        .numbers("pos", &[0.0, 0.0, height])
        .numbers("mass", &[mass])
        .numbers("diaginertia", &inertia)
}

fn joint_element(leg: &HeldLeg, joint: &Joint, prefix: &str) -> Element {
    let element = Element::new("joint").text("name", &name(prefix, joint.name));
    let element = match joint.shape {
        Shape::Ball => element.text("type", "ball"),
        Shape::Hinge(axis) => element.text("type", "hinge").numbers("axis", &axis),
    };
    let element = element.numbers("damping", &[joint.damping * leg.joint_damping_nm_s_per_rad]);
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

fn anchors(name: impl Fn(usize) -> String, points: &[[f64; 2]; 3], height: f64) -> Vec<Element> {
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

fn centre(sizes: &LegShape, prefix: &str) -> Element {
    shape(&name(prefix, "joint"), "sphere", &BRASS).numbers("size", &[sizes.ring / 8.0])
}

fn rod(sizes: &LegShape, prefix: &str) -> Element {
    shape(&name(prefix, "rod"), "cylinder", &STEEL)
        .numbers("size", &[sizes.rod])
        .numbers("fromto", &[0.0, 0.0, 0.0, 0.0, 0.0, -sizes.tip])
}

fn payload(leg: &HeldLeg, prefix: &str) -> Element {
    let sizes = &leg.shape;
    let ball = shape(&name(prefix, "payload"), "sphere", &BRASS).numbers("size", &[sizes.payload]);
    Element::new("body")
        .text("name", &name(prefix, "payload"))
        .numbers("pos", &[0.0, 0.0, -sizes.tip])
        .child(inertial(0.0, leg.payload_kg, [sizes.payload_inertia; 3]))
        .child(ball)
}

fn shape(name: &str, kind: &str, rgba: &[f64]) -> Element {
    Element::new("geom")
        .text("name", name)
        .text("type", kind)
        .numbers("rgba", rgba)
}
