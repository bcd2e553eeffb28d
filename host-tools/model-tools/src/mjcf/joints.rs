//! The central support as joints of MuJoCo: one place for every kind.

use super::MjcfError;
use leg_model::{JointStiffness, Support, SupportKind};
use nalgebra::{Rotation3, UnitQuaternion};

const X: Shape = Shape::Hinge([1.0, 0.0, 0.0]);
const Y: Shape = Shape::Hinge([0.0, 1.0, 0.0]);
const Z: Shape = Shape::Hinge([0.0, 0.0, 1.0]);

/// How a joint turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    Ball,
    /// About an axis of the leg.
    Hinge([f64; 3]),
}

/// One joint, at the joint centre.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    pub name: &'static str,
    pub shape: Shape,
    /// N·m/rad.
    pub spring: f64,
    /// Its share of the damping; two joints that turn together by half the angle each need twice the damping.
    pub damping: f64,
    /// Whether it is held equal to another joint.
    pub tied: bool,
    /// Where it is at the pose: an angle or a quaternion.
    pub position: Vec<f64>,
}

/// The joints from the base to the leg, the outermost first.
#[derive(Clone, Debug)]
pub(super) struct Joints {
    /// A joint that needs a body of its own, since MuJoCo has no ball together with a hinge in one body.
    pub pivot: Option<Joint>,
    /// Those of the leg's body.
    pub leg: Vec<Joint>,
    /// Names of two joints that are held equal.
    pub equal: Option<[&'static str; 2]>,
    /// What damps two joints together.
    pub damper: Option<Damper>,
}

/// The simulated leg's damping is that of its whole rotation. At a pose the axes of two hinges are not at right angles to each other:
/// a part of the damping is that of the sum, or of the difference, of their rates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Damper {
    /// Names of the joints.
    pub joints: [&'static str; 2],
    /// What each counts.
    pub signs: [f64; 2],
    /// Its share of the damping.
    pub damping: f64,
}

impl Joints {
    /// The joints of a support, with the leg turned by `rotation`.
    pub fn new(support: &Support<f64>, rotation: &Rotation3<f64>) -> Result<Self, MjcfError> {
        let joint = support.joint();
        match support.kind() {
            SupportKind::TorsionFree => torsion_free(joint, rotation),
            SupportKind::Spherical => spherical(joint, rotation),
            SupportKind::Universal => Ok(universal(joint, rotation)),
            SupportKind::ElasticUniversal => Ok(elastic_universal(joint, rotation)),
        }
    }

    const fn leg(leg: Vec<Joint>) -> Self {
        Self {
            pivot: None,
            leg,
            equal: None,
            damper: None,
        }
    }

    /// The positions of all joints in MuJoCo's order.
    pub fn positions(&self) -> Vec<f64> {
        let joints = self.pivot.iter().chain(&self.leg);
        joints.flat_map(|joint| joint.position.clone()).collect()
    }
}

/// R = Rx(α/2)·Ry(β)·Rx(α/2) has a horizontal axis: no torsion. The two halves are held equal.
fn torsion_free(
    joint: &JointStiffness<f64>,
    rotation: &Rotation3<f64>,
) -> Result<Joints, MjcfError> {
    if joint.bending_nm_per_rad > 0.0 {
        return Err(springs(joint));
    }
    let turn = UnitQuaternion::from_rotation_matrix(rotation);
    let (half_alpha, beta) = (turn.i.atan2(turn.w), 2.0 * turn.j.asin());
    let half = |name| Joint {
        damping: 2.0,
        tied: true,
        ..hinge(name, X, half_alpha)
    };
    Ok(Joints {
        equal: Some(["upper_x", "lower_x"]),
        ..Joints::leg(vec![
            half("upper_x"),
            hinge("tilt_y", Y, beta),
            half("lower_x"),
        ])
    })
}

/// A ball; an elastic pivot is a ball and a hinge about the leg in series.
///
/// MuJoCo's ball has the energy ½k|ω|², ω the rotation vector: to a tilt it is as stiff as the pivot, to a small torsion
/// (θ/2)·cot(θ/2) times that. The hinge gives way by what the pivot twists more, exactly so at this pose. Damped by c, the ball in series with
/// the hinge is damped by c in torsion, too, if the hinge is damped by c times the sum of the stiffnesses of ball and pivot over their
/// difference.
fn spherical(joint: &JointStiffness<f64>, rotation: &Rotation3<f64>) -> Result<Joints, MjcfError> {
    let (bending, torsion) = (joint.bending_nm_per_rad, joint.torsion_nm_per_rad);
    if bending == 0.0 && torsion == 0.0 {
        return Ok(Joints::leg(vec![ball("ball", 0.0, rotation)]));
    }
    let turn = TiltAndTorsion::new(rotation);
    let ball_torsion = bending * turn.half_tilt_by_tangent();
    if torsion >= ball_torsion {
        return Err(springs(joint));
    }
    let hinge_share = 1.0 - torsion / ball_torsion;
    let twist = hinge_share * turn.torsion;
    let untwisted = rotation * Rotation3::from_euler_angles(0.0, 0.0, -twist);
    Ok(Joints {
        pivot: Some(ball("pivot", bending, &untwisted)),
        ..Joints::leg(vec![Joint {
            spring: torsion / hinge_share,
            damping: (2.0 - hinge_share) / hinge_share,
            ..hinge("torsion", Z, twist)
        }])
    })
}

/// R = Rx(α)·Ry(β)·Rz(γ), the first axis on the base: the cosine between the first and the last is sin β.
fn elastic_universal(joint: &JointStiffness<f64>, rotation: &Rotation3<f64>) -> Joints {
    let cosine = rotation.matrix()[(0, 2)];
    let mut joints = Joints::leg(three_hinges(joint, rotation));
    if cosine != 0.0 {
        let damping = cosine.abs();
        for joint in joints.leg.iter_mut().step_by(2) {
            joint.damping -= damping;
        }
        joints.damper = Some(Damper {
            joints: ["tilt_x", "torsion"],
            signs: [1.0, cosine.signum()],
            damping,
        });
    }
    joints
}

fn three_hinges(joint: &JointStiffness<f64>, rotation: &Rotation3<f64>) -> Vec<Joint> {
    let r = rotation.matrix();
    let angles = [
        (-r[(1, 2)]).atan2(r[(2, 2)]),
        r[(0, 2)].asin(),
        (-r[(0, 1)]).atan2(r[(0, 0)]),
    ];
    let names = [("tilt_x", X), ("tilt_y", Y), ("torsion", Z)];
    let (bending, torsion) = (joint.bending_nm_per_rad, joint.torsion_nm_per_rad);
    let springs = [bending, bending, torsion];
    let joints = names.into_iter().zip(angles).zip(springs);
    let elastic = |(((name, axis), angle), spring)| Joint {
        spring,
        ..hinge(name, axis, angle)
    };
    joints.map(elastic).collect()
}

/// The same without torsion.
fn universal(joint: &JointStiffness<f64>, rotation: &Rotation3<f64>) -> Joints {
    let mut joints = three_hinges(joint, rotation);
    joints.truncate(2);
    Joints::leg(joints)
}

fn hinge(name: &'static str, shape: Shape, angle: f64) -> Joint {
    Joint {
        name,
        shape,
        spring: 0.0,
        damping: 1.0,
        tied: false,
        position: vec![angle],
    }
}

fn ball(name: &'static str, spring: f64, rotation: &Rotation3<f64>) -> Joint {
    let turn = UnitQuaternion::from_rotation_matrix(rotation);
    Joint {
        spring,
        position: vec![turn.w, turn.i, turn.j, turn.k],
        ..hinge(name, Shape::Ball, 0.0)
    }
}

/// θ and τ, rad, in R = Rod(k, θ)·Rz(τ) with a horizontal axis k.
struct TiltAndTorsion {
    tilt: f64,
    torsion: f64,
}

impl TiltAndTorsion {
    fn new(rotation: &Rotation3<f64>) -> Self {
        let turn = UnitQuaternion::from_rotation_matrix(rotation);
        Self {
            tilt: 2.0 * turn.i.hypot(turn.j).atan2(turn.w.hypot(turn.k)),
            torsion: 2.0 * turn.k.atan2(turn.w),
        }
    }

    /// (θ/2)·cot(θ/2), which is 1 at the vertical.
    fn half_tilt_by_tangent(&self) -> f64 {
        let half = self.tilt / 2.0;
        if half > 0.0 { half / half.tan() } else { 1.0 }
    }
}

fn springs(joint: &JointStiffness<f64>) -> MjcfError {
    MjcfError::Springs {
        bending_nm_per_rad: joint.bending_nm_per_rad,
        torsion_nm_per_rad: joint.torsion_nm_per_rad,
    }
}
