//! The model's kernels by name, so that one request can run or count any of them.

mod arguments;
mod bodies;

use crate::counter::InstructionCounter;
use arguments::KernelArguments;
use bodies::KernelBody;
use heapless::Vec;
use leg_model::{Error, RigParameters, Scalar};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// A kernel of the model's fast path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Kernel {
    /// Square root of |azimuth|.
    SquareRoot,
    /// Sine and cosine of the azimuth.
    SinCos,
    /// Lengths and moment map.
    InverseKinematics,
    /// Direction without torsion from lengths.
    ForwardKinematics,
    /// Direction on a universal joint from lengths.
    ForwardKinematicsUniversal,
    /// Tensions with bounds.
    Distribution,
    /// Kinematics, total stiffness, 3×3 solve, tip.
    FullPass,
    /// Kinematics, total stiffness, 2×2 solve in the plane without torsion, tip.
    FullPassInPlane,
    /// Elongation and stiffness of a tendon with a curve.
    TendonCurve,
    /// Unstretched lengths of tendons with curves that hold a load.
    InverseStatics,
    /// The pretension that gives a demanded bending stiffness, with tendons with curves.
    StiffnessCommand,
    /// The model's part of a control tick: forward kinematics, load estimate, full pass, distribution, unstretched
    /// lengths.
    ModelTick,
}

impl Kernel {
    /// Every kernel.
    pub const ALL: [Self; 12] = [
        Self::SquareRoot,
        Self::SinCos,
        Self::InverseKinematics,
        Self::ForwardKinematics,
        Self::ForwardKinematicsUniversal,
        Self::Distribution,
        Self::FullPass,
        Self::FullPassInPlane,
        Self::TendonCurve,
        Self::InverseStatics,
        Self::StiffnessCommand,
        Self::ModelTick,
    ];

    /// Its name in tables and errors.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SquareRoot => "square root",
            Self::SinCos => "sine and cosine",
            Self::InverseKinematics => "inverse kinematics",
            Self::ForwardKinematics => "forward kinematics",
            Self::ForwardKinematicsUniversal => "forward kinematics, universal joint",
            Self::Distribution => "tension distribution",
            Self::FullPass => "full pass, 3×3",
            Self::FullPassInPlane => "full pass, 2×2",
            Self::TendonCurve => "tendon curve",
            Self::InverseStatics => "inverse statics",
            Self::StiffnessCommand => "stiffness on command",
            Self::ModelTick => "model part of a tick",
        }
    }
}

/// Arguments from which every kernel takes what it needs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct KernelInput {
    /// The mechanism.
    pub rig: RigParameters<f32, 3>,
    /// Azimuth of the pose, rad.
    pub azimuth_rad: f32,
    /// Tilt of the pose, rad.
    pub tilt_rad: f32,
    /// Azimuth from which forward kinematics starts, rad.
    pub start_azimuth_rad: f32,
    /// Tilt from which forward kinematics starts, rad.
    pub start_tilt_rad: f32,
    /// What is added to the lengths of the pose before forward kinematics gets them, m.
    pub length_errors_m: [f32; 3],
    /// Mass at the tip, kg.
    pub payload_kg: f32,
    /// Pretension, N.
    pub pretension_n: f32,
    /// Lowest tension allowed, N.
    pub f_min_n: f32,
    /// Highest tension allowed, N.
    pub f_max_n: f32,
    /// Stiffness of each tendon, N/m. Kernels that take tendons with curves get the paper's
    /// ([`CurvePoint::PAPER`](leg_model::CurvePoint::PAPER)), scaled to have this stiffness at the pretension.
    pub stiffness_n_per_m: f32,
    /// Bending stiffness demanded of the leg, N·m/rad.
    pub demand_nm_per_rad: f32,
}

/// The numbers that a kernel computed, in its own order.
pub type KernelOutput<T = f32> = Vec<T, 32>;

/// Runs a kernel, in f32 as on the board or in f64 as its proof.
///
/// # Errors
/// What the kernel refuses, or the preparation of its arguments.
pub fn run<T: Scalar>(kernel: Kernel, input: &KernelInput) -> Result<KernelOutput<T>, Error> {
    visit::<T, _>(kernel, Runner(KernelArguments::new(input)?))
}

/// Counts the instructions of a kernel, without the preparation of its arguments.
///
/// # Errors
/// As [`run`]. `Ok(None)` where there is nothing to count with.
pub fn count(
    kernel: Kernel,
    input: &KernelInput,
    counter: &mut impl InstructionCounter,
) -> Result<Option<u32>, Error> {
    visit::<f32, _>(kernel, Counting(KernelArguments::new(input)?, counter))
}

/// Something to do with a kernel whose type is known.
trait Visitor<T> {
    type Output;
    fn visit<B: KernelBody<T>>(self) -> Result<Self::Output, Error>;
}

fn visit<T: Scalar, V: Visitor<T>>(kernel: Kernel, visitor: V) -> Result<V::Output, Error> {
    match kernel {
        Kernel::SquareRoot => visitor.visit::<bodies::SquareRootKernel>(),
        Kernel::SinCos => visitor.visit::<bodies::SinCosKernel>(),
        Kernel::InverseKinematics => visitor.visit::<bodies::InverseKinematicsKernel>(),
        Kernel::ForwardKinematics => visitor.visit::<bodies::ForwardKinematicsKernel>(),
        Kernel::ForwardKinematicsUniversal => {
            visitor.visit::<bodies::ForwardKinematicsUniversalKernel>()
        }
        Kernel::Distribution => visitor.visit::<bodies::DistributionKernel>(),
        Kernel::FullPass => visitor.visit::<bodies::FullPassKernel>(),
        Kernel::FullPassInPlane => visitor.visit::<bodies::FullPassInPlaneKernel>(),
        Kernel::TendonCurve => visitor.visit::<bodies::TendonCurveKernel>(),
        Kernel::InverseStatics => visitor.visit::<bodies::InverseStaticsKernel>(),
        Kernel::StiffnessCommand => visitor.visit::<bodies::StiffnessCommandKernel>(),
        Kernel::ModelTick => visitor.visit::<bodies::ModelTickKernel>(),
    }
}

struct Runner<T>(KernelArguments<T>);

impl<T: Scalar> Visitor<T> for Runner<T> {
    type Output = KernelOutput<T>;

    fn visit<B: KernelBody<T>>(self) -> Result<KernelOutput<T>, Error> {
        let mut result = Err(Error::NotConverged);
        execute::<T, B>(&self.0, &mut result);
        let mut numbers = KernelOutput::new();
        let output = result?;
        B::check(&output)?;
        B::flatten(&output, &mut |number| {
            // The capacity is that of the longest output, which a test checks.
            let _ = numbers.push(number);
        });
        Ok(numbers)
    }
}

struct Counting<'a, C>(KernelArguments<f32>, &'a mut C);

impl<C: InstructionCounter> Visitor<f32> for Counting<'_, C> {
    type Output = Option<u32>;

    fn visit<B: KernelBody<f32>>(self) -> Result<Option<u32>, Error> {
        let mut result = Err(Error::NotConverged);
        match self.1.count(execute::<f32, B>, &self.0, &mut result) {
            Some(count) => result
                .and_then(|output| B::check(&output))
                .map(|()| Some(count)),
            None => Ok(None),
        }
    }
}

/// The kernel as it is counted: one function, not inlined, arguments and result in memory.
#[inline(never)]
fn execute<T, B: KernelBody<T>>(
    arguments: &KernelArguments<T>,
    result: &mut Result<B::Output, Error>,
) {
    *result = B::run(arguments);
}
