//! Which quantity each number of a reply belongs to.

use super::CheckedQuantity::{self, *};
use leg_firmware_bench::kernels::Kernel;
use leg_model::SupportKind;

/// Consecutive numbers that are one array: their quantity (none if they are not compared) and how many they are.
pub type Part = (Option<CheckedQuantity>, usize);

const LENGTHS: Part = (Some(Lengths), 3);
const MOMENT_MAP: Part = (Some(MomentMap), 9);
const PRETENSION: Part = (Some(PretensionDirection), 3);
const LOAD_MOMENT: Part = (Some(LoadMoment), 3);
const LOAD_ESTIMATE: Part = (Some(LoadEstimate), 3);
const TENSIONS: Part = (Some(Tensions), 3);
const PRETENSION_RANGE: Part = (Some(PretensionRange), 2);
const MATRIX: Part = (Some(Stiffness), 9);
const SYMMETRIC: Part = (Some(Stiffness), 6);
const K2_EXACT: Part = (Some(K2Exact), 9);
const K2_PRINTED: Part = (Some(K2Printed), 9);
const UNSTRETCHED: Part = (Some(Unstretched), 3);
const DIRECTION: Part = (Some(Direction), 3);
const RESIDUAL: Part = (Some(Residual), 1);
/// A number of steps: f32 may need fewer than f64.
const STEPS: Part = (None, 1);

/// The parts of an evaluation, in the order of its fields.
#[must_use]
pub const fn evaluation_parts(support: SupportKind) -> [Part; 19] {
    let (deviation, torsion) = match support {
        SupportKind::TorsionFree | SupportKind::Universal => (Deviation, Torsion),
        SupportKind::Spherical | SupportKind::ElasticUniversal => {
            (DeviationBallJoint, TorsionBallJoint)
        }
    };
    [
        LENGTHS,
        MOMENT_MAP,
        PRETENSION,
        LOAD_MOMENT,
        (Some(JointMoment), 3),
        TENSIONS,
        TENSIONS,
        PRETENSION_RANGE,
        MATRIX,
        (Some(JointStiffness), 9),
        K2_EXACT,
        K2_PRINTED,
        (Some(Bending), 2),
        (Some(AxialStretch), 1),
        // With and without the load's own stiffness.
        (Some(deviation), 2),
        UNSTRETCHED,
        (Some(torsion), 1),
        (Some(CommandedPretension), 1),
        (Some(CommandedStiffness), 1),
    ]
}

/// The parts of a kernel's output, in its own order.
#[must_use]
pub const fn kernel_parts(kernel: Kernel) -> &'static [Part] {
    match kernel {
        Kernel::SquareRoot => &[(Some(SquareRoot), 1)],
        Kernel::SinCos => &[(Some(SinCos), 2)],
        Kernel::InverseKinematics => &[LENGTHS, MOMENT_MAP],
        Kernel::ForwardKinematics | Kernel::ForwardKinematicsUniversal => {
            &[DIRECTION, RESIDUAL, STEPS]
        }
        Kernel::Distribution => &[TENSIONS, PRETENSION, PRETENSION_RANGE, TENSIONS],
        Kernel::FullPass => &[
            LENGTHS,
            MOMENT_MAP,
            SYMMETRIC,
            (Some(RotationBallJoint), 3),
            (Some(DeviationBallJoint), 3),
        ],
        Kernel::FullPassInPlane => &[
            LENGTHS,
            MOMENT_MAP,
            SYMMETRIC,
            (Some(Rotation), 3),
            (Some(Deviation), 3),
        ],
        Kernel::TendonCurve => &[(Some(Elongation), 1), (Some(TendonStiffness), 1)],
        Kernel::InverseStatics => &[TENSIONS, UNSTRETCHED],
        Kernel::StiffnessCommand => &[
            (Some(CommandedPretension), 1),
            (Some(CommandedStiffness), 1),
            // Two bounds may meet within rounding, and either names one.
            (None, 1),
        ],
        Kernel::ModelTick => &[
            DIRECTION,
            RESIDUAL,
            STEPS,
            LOAD_ESTIMATE,
            SYMMETRIC,
            (Some(TickRotation), 3),
            (Some(TickDisplacement), 3),
            TENSIONS,
            UNSTRETCHED,
        ],
    }
}
