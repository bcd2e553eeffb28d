#![doc = include_str!("../README.md")]
#![no_std]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a comparison that is negated refuses NaN, too"
)]
#![allow(
    clippy::excessive_precision,
    reason = "constants are written once, for f32 and f64"
)]

pub use nalgebra;

mod axial_pull;
mod bending;
mod deviation;
mod error;
mod evaluation;
mod flexure;
mod forward;
mod free_plane;
mod full_pass;
mod geometry;
mod inverse_statics;
mod joint;
mod kinematics;
mod length_polynomial;
mod load;
mod pose;
pub mod printed;
mod range;
mod rig;
mod scalar;
mod solve;
mod sqrt;
mod stiffness_command;
mod structural_stiffness;
mod support;
mod tendon;
mod tendon_stiffness;
mod tension;
mod torsion;
mod trigonometry;

pub use bending::{Bending, BendingAxis};
pub use deviation::{deviation, tip_displacement};
pub use error::{Error, Quantity, Reason};
pub use evaluation::{
    Evaluation, MapEvaluation, Query, StiffnessAt, StiffnessDemand, evaluate, evaluate_for_map,
};
pub use flexure::*;
pub use forward::{ForwardKinematics, forward_kinematics, forward_kinematics_universal};
pub use free_plane::FreePlane;
pub use full_pass::{Deflection, FullPass, TendonStates, full_pass, full_pass_in_plane};
pub use geometry::Geometry;
pub use inverse_statics::{
    Hold, HoldError, estimate_load, hold, inverse_statics, inverse_statics_in_plane,
};
pub use kinematics::{Kinematics, inverse_kinematics};
pub use load::{Load, estimate_moment};
pub use pose::{Direction, HalfTangent, Twist};
pub use rig::{Rig, RigParameters};
pub use scalar::Scalar;
pub use solve::{Symmetric3, solve2, solve3};
pub use stiffness_command::{StiffnessAnswer, StiffnessCommand};
pub use structural_stiffness::structural_stiffness;
pub use support::{JointStiffness, Support, SupportKind};
pub use tendon::{
    CURVE_POINTS_MAX, ConstantStiffness, CurvePoint, Elasticity, Tendon, TendonCurve,
};
pub use tendon_stiffness::tendon_stiffness;
pub use tension::{Bound, Distribution, Limit, TensionBounds, distribute};
pub use torsion::elastic_torsion;
