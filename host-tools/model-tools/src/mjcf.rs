//! The rig as a MuJoCo model (MJCF), its tendons made to hold the loaded leg at a pose.
//!
//! MuJoCo's world frame is frame {A}: the joint centre is its origin, z points up. The tendons are springs that only
//! pull, straight where the leg is held; inertia and damping are those of the simulated leg. What neither says is chosen
//! here and in [`leg_shape`](crate::leg_shape). Joint and shaft do not stretch: for that see
//! `axial_stretch_m` of `leg eval`. Several legs stand around a body that floats; then the world's origin is on the floor.

mod actuators;
mod bodies;
mod held;
mod joints;
mod scenery;

pub use held::{HeldLeg, HeldTendon};

use crate::leg_shape::{Body, ShapeError};
use crate::line_error::LineError;
use crate::xml_element::{self, Element};
use actuators::COUNTS;
use joints::Joints;
use std::io::{self, Write};

/// Step of the simulation, s.
const TIMESTEP_S: f64 = 2e-4;

/// Time constant and damping ratio of the constraint that holds two joints equal: the stiffest that MuJoCo keeps
/// stable is two steps.
const SOLREF: [f64; 2] = [2.0 * TIMESTEP_S, 1.0];

/// Impedance of that constraint: constant, as near to 1 as MuJoCo allows.
const SOLIMP: [f64; 5] = [0.9999, 0.9999, 0.001, 0.5, 2.0];

/// Why there is no MuJoCo model.
#[derive(Debug, thiserror::Error)]
pub enum MjcfError {
    /// The model refuses the pose, the load or the pretension.
    #[error(transparent)]
    Model(#[from] LineError),
    /// No pretension serves.
    #[error(
        "no pretension keeps every tension inside its bounds at this pose under this load: give another pose or a smaller payload"
    )]
    Infeasible,
    /// The pretension gives a tension outside its bounds.
    #[error(
        "the pretension {pretension_n} N leaves a tension outside its bounds at this pose under this load: give a pretension from {lowest:.2} to {highest:.2} N",
        lowest = (lowest_n * 100.0).ceil() / 100.0,
        highest = (highest_n * 100.0).floor() / 100.0
    )]
    Pretension {
        /// The pretension, N.
        pretension_n: f64,
        /// The lowest that keeps the bounds, N.
        lowest_n: f64,
        /// The highest, N.
        highest_n: f64,
    },
    /// MuJoCo's joints cannot be combined to springs of this kind.
    #[error(
        "no joint of MuJoCo has these springs ({bending_nm_per_rad} N·m/rad in bending, {torsion_nm_per_rad} in torsion): export a support without springs, a universal joint of flexures, or a pivot that is softer in torsion than in bending"
    )]
    Springs {
        /// Against tilt, N·m/rad.
        bending_nm_per_rad: f64,
        /// Against torsion, N·m/rad.
        torsion_nm_per_rad: f64,
    },
    /// No body is like the leg.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}

/// A MuJoCo model that is ready to be written.
#[derive(Clone, Debug)]
pub struct Mjcf {
    root: Element,
    comment: String,
}

impl Mjcf {
    /// The model of a leg, or of several such legs on a body that stands on a floor; the first is towards x.
    ///
    /// # Errors
    /// [`MjcfError::Springs`].
    pub fn new(leg: &HeldLeg, several: Option<Body>) -> Result<Self, MjcfError> {
        let joints = Joints::new(&leg.support, &leg.rotation)?;
        let prefixes: Vec<String> = match several {
            None => vec![String::new()],
            Some(body) => (0..body.legs).map(bodies::prefix).collect(),
        };
        let of_each = |make: &dyn Fn(&str) -> Vec<Element>| -> Vec<Element> {
            prefixes.iter().flat_map(|prefix| make(prefix)).collect()
        };
        let equalities = of_each(&|prefix| {
            let names = joints.equal.into_iter();
            names.map(|pair| equality(prefix, pair)).collect()
        });
        let some = |name, elements: Vec<Element>| {
            (!elements.is_empty()).then(|| Element::new(name).children(elements))
        };
        let root = Element::new("mujoco")
            .text("model", "leg")
            .child(Element::new("compiler").text("angle", "radian"))
            .child(option(leg))
            .child(scenery::view(leg.shape.tip))
            .child(scenery::sky())
            .child(scenery::defaults(leg.shape.ring))
            .child(world(leg, &joints, several.as_ref()))
            .children(some(
                "tendon",
                of_each(&|prefix| tendons(leg, &joints, prefix)),
            ))
            .children(some("equality", equalities))
            .children(some(
                "actuator",
                of_each(&|prefix| actuators::motors(leg, prefix)),
            ))
            .children(some(
                "sensor",
                of_each(&|prefix| actuators::sensors(prefix)),
            ))
            .child(actuators::encoders(leg))
            .child(keyframe(leg, &joints, several.as_ref()));
        let comment = comment(leg, several.as_ref());
        Ok(Self { root, comment })
    }

    /// Writes the XML.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        xml_element::write(&self.root, &self.comment, out)
    }
}

/// Those of a leg, and what damps its joints together.
fn tendons(leg: &HeldLeg, joints: &Joints, prefix: &str) -> Vec<Element> {
    let damper = joints.damper.as_ref();
    let damper = damper.map(|damper| actuators::damper(leg, prefix, damper));
    actuators::paths(prefix).into_iter().chain(damper).collect()
}

fn comment(leg: &HeldLeg, several: Option<&Body>) -> String {
    let around = several.map_or_else(String::new, |body| format!("\n  {body} It floats."));
    let HeldLeg {
        azimuth_deg,
        tilt_deg,
        payload_kg,
        pretension_n,
        ..
    } = leg;
    format!(
        " Key `held`: azimuth {azimuth_deg:.3} deg, tilt {tilt_deg:.3} deg, payload {payload_kg} kg, pretension {pretension_n} N.\n  \
         Controls: how far each motor shall have reeled in from there, m; an activation is how far it has.\n  \
         An encoder's count from there: `counts_per_m` times the activation, or of a taut tendon by sensors\n  \
         {COUNTS}.\n  \
         Inertia and damping are those of the simulated leg: a payload is a point (a steel ball on a leg without mass).\n  \
         Joint and shaft do not stretch.{around} "
    )
}

fn option(leg: &HeldLeg) -> Element {
    Element::new("option")
        .numbers("timestep", &[TIMESTEP_S])
        .numbers("gravity", &[0.0, 0.0, -leg.parameters.gravity_m_per_s2])
        .text("integrator", "implicitfast")
}

fn world(leg: &HeldLeg, joints: &Joints, several: Option<&Body>) -> Element {
    let world = Element::new("worldbody").child(scenery::light(leg.shape.tip));
    match several {
        None => world.children(bodies::hanging(leg, joints, "")),
        Some(body) => world
            .child(scenery::floor())
            .child(bodies::floating(leg, joints, body)),
    }
}

fn equality(prefix: &str, [first, second]: [&str; 2]) -> Element {
    Element::new("joint")
        .text("joint1", &bodies::name(prefix, first))
        .text("joint2", &bodies::name(prefix, second))
        .numbers("solref", &SOLREF)
        .numbers("solimp", &SOLIMP)
}

fn keyframe(leg: &HeldLeg, joints: &Joints, several: Option<&Body>) -> Element {
    let of_leg = joints.positions();
    let positions = several.map_or_else(
        || of_leg.clone(),
        |body| {
            let mut all = vec![0.0, 0.0, bodies::height_m(leg), 1.0, 0.0, 0.0, 0.0];
            all.extend((0..body.legs).flat_map(|_| of_leg.clone()));
            all
        },
    );
    let key = Element::new("key")
        .text("name", "held")
        .numbers("qpos", &positions);
    Element::new("keyframe").child(key)
}

#[cfg(test)]
mod tests;
