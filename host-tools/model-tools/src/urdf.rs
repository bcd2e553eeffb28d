//! Legs as a URDF robot, for other programs: two revolute joints a leg, bodies of primitives, inertias and limits.
//!
//! URDF has no tendons and no closed chains: the leg of a rig is a universal joint, R = Rx(α)·Ry(β), that the tendons turn.
//! Its tip goes where that of any support goes; only on `universal` does it twist as the support does. Each joint ends at the
//! rig's greatest tilt, so that the corners of the joints' range are beyond it.
//!
//! URDF has no initial positions: the origins of the joints are turned, so that the leg has its pose where they are at zero.

mod links;

use crate::leg_shape::{Body, LegShape, ShapeError};
use crate::xml_element::{self, Element};
use leg_model::{Direction, Error, evaluate};
use leg_rig::number::decimal;
use leg_rig::rig_file::RigFile;
use links::{body, leg};
use std::f64::consts::TAU;
use std::io::{self, Write};

/// Why there is no robot.
#[derive(Debug, thiserror::Error)]
pub enum UrdfError {
    /// The model refuses the payload.
    #[error(transparent)]
    Model(#[from] Error),
    /// No body is like the leg.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The joints do not go there.
    #[error(
        "the rig leans by at most {tilt_max_deg}°, and the joints end there: give a tilt from -{tilt_max_deg} to {tilt_max_deg}"
    )]
    Tilt {
        /// The rig's greatest tilt, degrees.
        tilt_max_deg: f64,
    },
}

/// What the joints of a leg can do.
#[derive(Clone, Copy, Debug)]
struct JointLimits {
    tilt_rad: f64,
    /// About x and y, N·m: what the tendons give straight down, one side at its highest tension and the other at its lowest.
    moment_nm: [f64; 2],
    speed_rad_per_s: f64,
    /// Where the joints are at zero, as angles from straight down.
    zeros_rad: [f64; 2],
}

/// A robot that is ready to be written.
#[derive(Clone, Debug)]
pub struct Urdf {
    root: Element,
    comment: String,
}

impl Urdf {
    /// One leg, whose first link is the base: its origin is the joint centre, z points up. Or several on a body, whose origin is
    /// in the plane of the joint centres; the first is towards x. `pose` is azimuth and tilt, degrees, of each leg where its joints
    /// are at zero.
    ///
    /// # Errors
    /// [`UrdfError`].
    pub fn new(
        rig: &RigFile,
        payload_kg: f64,
        pose: [f64; 2],
        several: Option<Body>,
    ) -> Result<Self, UrdfError> {
        let shape = LegShape::new(rig, payload_kg)?;
        let tilt_max_deg = rig.tilt_deg;
        if pose[1].abs() > tilt_max_deg {
            return Err(UrdfError::Tilt { tilt_max_deg });
        }
        let limits = limits(rig, payload_kg, joint_angles(pose)?)?;
        let of_leg = |prefix: &str| leg(rig, payload_kg, &shape, limits, prefix);
        let root = Element::new("robot").text("name", "leg");
        let root = match several {
            None => root.children(of_leg("")),
            Some(several) => {
                let legs = (0..several.legs).flat_map(|i| {
                    let prefix = format!("leg_{}_", i + 1);
                    let angle = TAU * f64::from(i) / f64::from(several.legs);
                    let mount = links::mount(&prefix, several.radius_m, angle);
                    [mount].into_iter().chain(of_leg(&prefix))
                });
                root.child(body(&several, &shape)).children(legs)
            }
        };
        Ok(Self {
            root,
            comment: comment(pose, limits.zeros_rad, several.as_ref()),
        })
    }

    /// Writes the XML.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        xml_element::write(&self.root, &self.comment, out)
    }
}

/// Of a leg whose joints are at zero where it is straight down, rad.
fn joint_angles([azimuth_deg, tilt_deg]: [f64; 2]) -> Result<[f64; 2], Error> {
    let direction = Direction::from_angles(azimuth_deg.to_radians(), tilt_deg.to_radians())?;
    let along = direction.vector();
    // Adding zero turns −0 into 0.
    Ok([along.y.atan2(-along.z) + 0.0, -along.x.asin() + 0.0])
}

fn comment(
    [azimuth_deg, tilt_deg]: [f64; 2],
    [x_rad, y_rad]: [f64; 2],
    several: Option<&Body>,
) -> String {
    // From zero, so that of zero there is no −0.
    let (x_rad, y_rad) = (0.0 - x_rad, 0.0 - y_rad);
    let around = several.map_or_else(String::new, |body| {
        format!("\n  {body}\n  No joint holds its link `body`: it floats where the simulator does not fix it.")
    });
    format!(
        " Inertia is that of the simulated leg: a payload is a point (a steel ball on a leg without mass).\n  \
         Joints at zero: azimuth {azimuth_deg:.3} deg, tilt {tilt_deg:.3} deg. A leg that leans by t towards azimuth a has\n  \
         tilt_x = atan2(sin t sin a, cos t) {x_rad:+.9}, tilt_y = -asin(sin t cos a) {y_rad:+.9}.{around} "
    )
}

fn limits(rig: &RigFile, payload_kg: f64, zeros_rad: [f64; 2]) -> Result<JointLimits, Error> {
    let evaluation = evaluate(&rig.parameters, &rig.query(0.0, 0.0, payload_kg))?;
    let [x, y, _] = evaluation.moment_map_m;
    let moment = |row: [f64; 3]| {
        let of = |sign: f64| {
            let arms = row.map(|arm| sign * arm);
            let pull = |arm: f64| arm * if arm > 0.0 { rig.f_max_n } else { rig.f_min_n };
            arms.into_iter().map(pull).sum::<f64>()
        };
        of(1.0).min(of(-1.0))
    };
    Ok(JointLimits {
        tilt_rad: rig.tilt_deg.to_radians(),
        moment_nm: [moment(x), moment(y)],
        speed_rad_per_s: decimal(rig.gains.motion.speed_rad_per_s),
        zeros_rad,
    })
}
