//! What each kernel may take.

use leg_firmware_bench::kernels::Kernel;
use serde::Serialize;

/// Bounds on the instructions of a kernel, and what reference programs for the same work take on the same core.
///
/// A is hand-written C for one rig known at compile time, B is C++ with Eigen; both by gcc 12 -O3 without contraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Budget {
    /// The fewest that are believed: fewer means that something is no longer done.
    pub lowest: u32,
    /// The most that are allowed.
    pub highest: u32,
    /// Reference A, where there is one.
    pub reference_a: Option<u32>,
    /// Reference B, where there is one.
    pub reference_b: Option<u32>,
}

impl Budget {
    pub(super) const fn new(lowest: u32, highest: u32) -> Self {
        Self {
            lowest,
            highest,
            reference_a: None,
            reference_b: None,
        }
    }

    const fn references(self, a: u32, b: u32) -> Self {
        Self {
            reference_a: Some(a),
            reference_b: Some(b),
            ..self
        }
    }

    /// Whether counts from `minimum` to `maximum` keep the bounds.
    #[must_use]
    pub const fn held(&self, minimum: u32, maximum: u32) -> bool {
        self.lowest <= minimum && maximum <= self.highest
    }
}

/// The budget of a kernel.
#[must_use]
pub const fn of(kernel: Kernel) -> Budget {
    match kernel {
        Kernel::SquareRoot => Budget::new(1, 10),
        Kernel::SinCos => Budget::new(20, 60),
        Kernel::InverseKinematics => Budget::new(100, 150).references(152, 170),
        Kernel::ForwardKinematics => Budget::new(200, 330).references(281, 580),
        Kernel::ForwardKinematicsUniversal => Budget::new(600, 800),
        Kernel::Distribution => Budget::new(90, 150).references(155, 237),
        Kernel::FullPass => Budget::new(240, 340).references(284, 605),
        Kernel::FullPassInPlane => Budget::new(240, 340),
        Kernel::TendonCurve => Budget::new(40, 80),
        Kernel::InverseStatics => Budget::new(350, 480),
        Kernel::StiffnessCommand => Budget::new(900, 2300),
        Kernel::ModelTick => Budget::new(600, 900).references(779, 1516),
    }
}
