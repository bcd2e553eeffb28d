//! What each kernel calls, and the numbers of its result.

mod arithmetic;
mod full_pass;
mod kinematics;
mod model_tick;
mod statics;

pub use arithmetic::{SinCosKernel, SquareRootKernel};
pub use full_pass::{FullPassInPlaneKernel, FullPassKernel};
pub use kinematics::{
    ForwardKinematicsKernel, ForwardKinematicsUniversalKernel, InverseKinematicsKernel,
};
pub use model_tick::ModelTickKernel;
pub use statics::{
    DistributionKernel, InverseStaticsKernel, StiffnessCommandKernel, TendonCurveKernel,
};

use super::arguments::KernelArguments;
use leg_model::Error;

/// A kernel as a type.
pub trait KernelBody<T> {
    type Output;
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error>;
    fn flatten(output: &Self::Output, push: &mut impl FnMut(T));

    /// An error that stands inside the output.
    fn check(_output: &Self::Output) -> Result<(), Error> {
        Ok(())
    }
}
