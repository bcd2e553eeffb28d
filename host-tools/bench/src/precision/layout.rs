//! Which quantity each number of a reply belongs to.

use super::CheckedQuantity;
use leg_firmware_bench::kernels::Kernel;
use leg_model::SupportKind;

/// Consecutive numbers that are one array: their quantity (none if they are not compared) and how many they are.
pub type Part = (Option<CheckedQuantity>, usize);

const LENGTHS: Part = (Some(CheckedQuantity::Lengths), 3);
const MOMENT_MAP: Part = (Some(CheckedQuantity::MomentMap), 9);
const PRETENSION: Part = (Some(CheckedQuantity::PretensionDirection), 3);
const LOAD_MOMENT: Part = (Some(CheckedQuantity::LoadMoment), 3);
const LOAD_ESTIMATE: Part = (Some(CheckedQuantity::LoadEstimate), 3);
const TENSIONS: Part = (Some(CheckedQuantity::Tensions), 3);
const PRETENSION_RANGE: Part = (Some(CheckedQuantity::PretensionRange), 2);
const MATRIX: Part = (Some(CheckedQuantity::Stiffness), 9);
const SYMMETRIC: Part = (Some(CheckedQuantity::Stiffness), 6);
const K2_EXACT: Part = (Some(CheckedQuantity::K2Exact), 9);
const K2_PRINTED: Part = (Some(CheckedQuantity::K2Printed), 9);
const UNSTRETCHED: Part = (Some(CheckedQuantity::Unstretched), 3);
const DIRECTION: Part = (Some(CheckedQuantity::Direction), 3);
const RESIDUAL: Part = (Some(CheckedQuantity::Residual), 1);
/// A number of steps: f32 may need fewer than f64.
const STEPS: Part = (None, 1);

/// The parts of an evaluation, in the order of its fields.
#[must_use]
pub const fn evaluation_parts(support: SupportKind) -> [Part; 19] {
    let (deviation, torsion) = match support {
        SupportKind::TorsionFree | SupportKind::Universal => {
            (CheckedQuantity::Deviation, CheckedQuantity::Torsion)
        }
        SupportKind::Spherical | SupportKind::ElasticUniversal => (
            CheckedQuantity::DeviationBallJoint,
            CheckedQuantity::TorsionBallJoint,
        ),
    };
    [
        LENGTHS,
        MOMENT_MAP,
        PRETENSION,
        LOAD_MOMENT,
        (Some(CheckedQuantity::JointMoment), 3),
        TENSIONS,
        TENSIONS,
        PRETENSION_RANGE,
        MATRIX,
        (Some(CheckedQuantity::JointStiffness), 9),
        K2_EXACT,
        K2_PRINTED,
        (Some(CheckedQuantity::Bending), 2),
        (Some(CheckedQuantity::AxialStretch), 1),
        // With and without the load's own stiffness.
        (Some(deviation), 2),
        UNSTRETCHED,
        (Some(torsion), 1),
        (Some(CheckedQuantity::CommandedPretension), 1),
        (Some(CheckedQuantity::CommandedStiffness), 1),
    ]
}

/// The parts of a kernel's output, in its own order.
#[must_use]
pub const fn kernel_parts(kernel: Kernel) -> &'static [Part] {
    use CheckedQuantity::{Deviation, DeviationBallJoint, Rotation, RotationBallJoint};
    match kernel {
        Kernel::SquareRoot => &[(Some(CheckedQuantity::SquareRoot), 1)],
        Kernel::SinCos => &[(Some(CheckedQuantity::SinCos), 2)],
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
        Kernel::TendonCurve => &[
            (Some(CheckedQuantity::Elongation), 1),
            (Some(CheckedQuantity::TendonStiffness), 1),
        ],
        Kernel::InverseStatics => &[TENSIONS, UNSTRETCHED],
        Kernel::StiffnessCommand => &[
            (Some(CheckedQuantity::CommandedPretension), 1),
            (Some(CheckedQuantity::CommandedStiffness), 1),
            // Two bounds may meet within rounding, and either names one.
            (None, 1),
        ],
        Kernel::ModelTick => &[
            DIRECTION,
            RESIDUAL,
            STEPS,
            LOAD_ESTIMATE,
            SYMMETRIC,
            (Some(CheckedQuantity::TickRotation), 3),
            (Some(CheckedQuantity::TickDisplacement), 3),
            TENSIONS,
            UNSTRETCHED,
        ],
    }
}
