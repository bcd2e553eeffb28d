//! Which quantity each number of a reply belongs to.

use super::Quantity;
use leg_firmware_bench::kernels::Kernel;
use leg_model::SupportKind;

/// Consecutive numbers that are one array: their quantity (none if they are not compared) and how many they are.
pub type Part = (Option<Quantity>, usize);

const LENGTHS: Part = (Some(Quantity::Lengths), 3);
const MOMENT_MAP: Part = (Some(Quantity::MomentMap), 9);
const PRETENSION: Part = (Some(Quantity::PretensionDirection), 3);
const LOAD_MOMENT: Part = (Some(Quantity::LoadMoment), 3);
const LOAD_ESTIMATE: Part = (Some(Quantity::LoadEstimate), 3);
const TENSIONS: Part = (Some(Quantity::Tensions), 3);
const PRETENSION_RANGE: Part = (Some(Quantity::PretensionRange), 2);
const MATRIX: Part = (Some(Quantity::Stiffness), 9);
const SYMMETRIC: Part = (Some(Quantity::Stiffness), 6);
const K2_EXACT: Part = (Some(Quantity::K2Exact), 9);
const K2_PRINTED: Part = (Some(Quantity::K2Printed), 9);
const UNSTRETCHED: Part = (Some(Quantity::Unstretched), 3);
const DIRECTION: Part = (Some(Quantity::Direction), 3);
const RESIDUAL: Part = (Some(Quantity::Residual), 1);
/// A number of steps: f32 may need fewer than f64.
const STEPS: Part = (None, 1);

/// The parts of an evaluation, in the order of its fields.
#[must_use]
pub const fn of_evaluation(support: SupportKind) -> [Part; 19] {
    let (deviation, torsion) = match support {
        SupportKind::TorsionFree | SupportKind::Universal => {
            (Quantity::Deviation, Quantity::Torsion)
        }
        SupportKind::Spherical | SupportKind::ElasticUniversal => {
            (Quantity::DeviationBallJoint, Quantity::TorsionBallJoint)
        }
    };
    [
        LENGTHS,
        MOMENT_MAP,
        PRETENSION,
        LOAD_MOMENT,
        (Some(Quantity::JointMoment), 3),
        TENSIONS,
        TENSIONS,
        PRETENSION_RANGE,
        MATRIX,
        (Some(Quantity::JointStiffness), 9),
        K2_EXACT,
        K2_PRINTED,
        (Some(Quantity::Bending), 2),
        (Some(Quantity::AxialStretch), 1),
        // With and without the load's own stiffness.
        (Some(deviation), 2),
        UNSTRETCHED,
        (Some(torsion), 1),
        (Some(Quantity::CommandedPretension), 1),
        (Some(Quantity::CommandedStiffness), 1),
    ]
}

/// The parts of a kernel's output, in its own order.
#[must_use]
pub const fn of_kernel(kernel: Kernel) -> &'static [Part] {
    use Quantity::{Deviation, DeviationBallJoint, Rotation, RotationBallJoint};
    match kernel {
        Kernel::SquareRoot => &[(Some(Quantity::SquareRoot), 1)],
        Kernel::SinCos => &[(Some(Quantity::SinCos), 2)],
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
            (Some(Quantity::Elongation), 1),
            (Some(Quantity::TendonStiffness), 1),
        ],
        Kernel::InverseStatics => &[TENSIONS, UNSTRETCHED],
        Kernel::StiffnessCommand => &[
            (Some(Quantity::CommandedPretension), 1),
            (Some(Quantity::CommandedStiffness), 1),
            // Two bounds may meet within rounding, and either names one.
            (None, 1),
        ],
        Kernel::ModelTick => &[
            DIRECTION,
            RESIDUAL,
            STEPS,
            LOAD_ESTIMATE,
            SYMMETRIC,
            (Some(Quantity::TickRotation), 3),
            (Some(Quantity::TickDisplacement), 3),
            TENSIONS,
            UNSTRETCHED,
        ],
    }
}
