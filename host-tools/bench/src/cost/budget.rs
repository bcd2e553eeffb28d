//! What each kernel may take.

use leg_firmware_bench::kernels::Kernel;
use serde::Serialize;

/// Bounds on the instructions of a kernel, and what reference programs for the same work take on the same core.
///
/// A is hand-written C for one rig known at compile time, B is C++ with Eigen; both by gcc 12 -O3 without contraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct InstructionBudget {
    /// Fewer mean that something is no longer done.
    pub lowest: u32,
    /// More are not allowed.
    pub highest: u32,
    /// Reference A, where there is one.
    pub reference_a: Option<u32>,
    /// Reference B, where there is one.
    pub reference_b: Option<u32>,
}

impl InstructionBudget {
    pub(super) const fn new(lowest: u32, highest: u32) -> Self {
        Self {
            lowest,
            highest,
            reference_a: None,
            reference_b: None,
        }
    }

    const fn compared(self, a: u32, b: u32) -> Self {
        Self {
            reference_a: Some(a),
            reference_b: Some(b),
            ..self
        }
    }

    /// Whether counts from `minimum` to `maximum` keep the bounds.
    #[must_use]
    pub const fn passes(&self, minimum: u32, maximum: u32) -> bool {
        self.lowest <= minimum && maximum <= self.highest
    }
}

/// The budget of a kernel.
#[must_use]
pub const fn kernel_budget(kernel: Kernel) -> InstructionBudget {
    match kernel {
        Kernel::SquareRoot => InstructionBudget::new(1, 10),
        Kernel::SinCos => InstructionBudget::new(20, 60),
        Kernel::InverseKinematics => InstructionBudget::new(100, 150).compared(152, 170),
        Kernel::ForwardKinematics => InstructionBudget::new(200, 330).compared(281, 580),
        Kernel::ForwardKinematicsUniversal => InstructionBudget::new(600, 800),
        Kernel::Distribution => InstructionBudget::new(90, 150).compared(155, 237),
        Kernel::FullPass => InstructionBudget::new(240, 340).compared(284, 605),
        Kernel::FullPassInPlane => InstructionBudget::new(240, 340),
        Kernel::TendonCurve => InstructionBudget::new(40, 80),
        Kernel::InverseStatics => InstructionBudget::new(350, 480),
        Kernel::StiffnessCommand => InstructionBudget::new(900, 2300),
        Kernel::ModelTick => InstructionBudget::new(600, 900).compared(779, 1516),
    }
}
