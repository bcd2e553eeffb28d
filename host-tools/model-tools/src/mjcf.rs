//! The rig as a MuJoCo model (MJCF), its tendons made to hold the loaded leg at a pose.
//!
//! MuJoCo's world frame is frame {A}: the joint centre is its origin, z points up. The tendons are springs that only
//! pull. What a rig file does not say is chosen here and nowhere else: the inertia of the leg is that of a solid
//! cylinder from the joint to the tip about the file's centroid, the payload is a steel ball, and the joint's damping
//! is a tenth of the critical. None of it has a part in the statics. Joint and shaft do not stretch: for that see
//! `axial_stretch_m` of `leg eval`.

mod bodies;
mod held;
mod joints;
mod scenery;

pub use held::{HeldLeg, HeldTendon};

use crate::leg_shape::LegShape;
use crate::line_error::LineError;
use crate::xml_element::{self, Element};
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
    /// Nothing has a mass.
    #[error(
        "neither the leg nor the payload has a mass, and MuJoCo moves no body without: give a payload"
    )]
    Massless,
}

/// A MuJoCo model that is ready to be written.
#[derive(Clone, Debug)]
pub struct Mjcf {
    root: Element,
    comment: String,
}

impl Mjcf {
    /// The model of a leg.
    ///
    /// # Errors
    /// [`MjcfError::Springs`] and [`MjcfError::Massless`].
    pub fn new(leg: &HeldLeg) -> Result<Self, MjcfError> {
        let sizes = LegShape::new(&leg.parameters, leg.payload_kg).ok_or(MjcfError::Massless)?;
        let joints = Joints::new(&leg.support, &leg.rotation)?;
        let root = Element::new("mujoco")
            .text("model", "leg")
            .child(Element::new("compiler").text("angle", "radian"))
            .child(option(leg))
            .child(scenery::view(sizes.tip))
            .child(scenery::sky())
            .child(scenery::defaults(sizes.ring))
            .child(bodies::world(leg, &sizes, &joints))
            .child(tendons(leg))
            .children(joints.equal.map(equality))
            .child(keyframe(&joints));
        let comment = comment(leg);
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

fn comment(leg: &HeldLeg) -> String {
    let HeldLeg {
        azimuth_deg,
        tilt_deg,
        payload_kg,
        pretension_n,
        ..
    } = leg;
    format!(
        " Key `held`: azimuth {azimuth_deg:.3} deg, tilt {tilt_deg:.3} deg, payload {payload_kg} kg, pretension {pretension_n} N.\n  \
         Not from the rig file: the leg's inertia (a solid cylinder from joint to tip), the payload's (a steel ball),\n  \
         and the joint's damping (a tenth of the critical). Joint and shaft do not stretch. "
    )
}

fn option(leg: &HeldLeg) -> Element {
    Element::new("option")
        .numbers("timestep", &[TIMESTEP_S])
        .numbers("gravity", &[0.0, 0.0, -leg.parameters.gravity_m_per_s2])
        .text("integrator", "implicitfast")
}

/// Springs with a dead band from zero to the unstretched length: they do not push.
fn tendons(leg: &HeldLeg) -> Element {
    let spatial = |(i, tendon): (usize, &HeldTendon)| {
        Element::new("spatial")
            .text("name", &format!("tendon_{}", i + 1))
            .numbers("stiffness", &[tendon.stiffness_n_per_m])
            .numbers("springlength", &[0.0, tendon.unstretched_m])
            .child(Element::new("site").text("site", &bodies::base_site(i)))
            .child(Element::new("site").text("site", &bodies::leg_site(i)))
    };
    Element::new("tendon").children(leg.tendons.iter().enumerate().map(spatial))
}

fn equality([first, second]: [&str; 2]) -> Element {
    let equal = Element::new("joint")
        .text("joint1", first)
        .text("joint2", second)
        .numbers("solref", &SOLREF)
        .numbers("solimp", &SOLIMP);
    Element::new("equality").child(equal)
}

fn keyframe(joints: &Joints) -> Element {
    let key = Element::new("key")
        .text("name", "held")
        .numbers("qpos", &joints.positions());
    Element::new("keyframe").child(key)
}

#[cfg(test)]
mod tests;
