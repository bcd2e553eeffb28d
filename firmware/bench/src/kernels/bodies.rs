//! What each kernel calls, and the numbers of its result.

mod arithmetic;
mod full_pass;
mod kinematics;
mod model_tick;
mod statics;

pub use arithmetic::{SinCos, SquareRoot};
pub use full_pass::{FullPass, FullPassInPlane};
pub use kinematics::{ForwardKinematics, ForwardKinematicsUniversal, InverseKinematics};
pub use model_tick::ModelTick;
pub use statics::{Distribution, InverseStatics, StiffnessCommand, TendonCurve};

use super::bench::Bench;
use leg_model::Error;

/// A kernel as a type.
pub trait Body<T> {
    type Output;
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error>;
    fn flatten(output: &Self::Output, push: &mut impl FnMut(T));

    /// An error that stands inside the output.
    fn check(_output: &Self::Output) -> Result<(), Error> {
        Ok(())
    }
}
