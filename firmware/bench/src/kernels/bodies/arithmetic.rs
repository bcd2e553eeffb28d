//! Square root, sine and cosine.

use super::{KernelArguments, KernelBody};
use leg_model::{Error, Scalar};

pub struct SquareRootKernel;

impl<T: Scalar> KernelBody<T> for SquareRootKernel {
    type Output = T;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<T, Error> {
        Ok(arguments.angle.abs().sqrt())
    }

    fn flatten(&root: &T, push: &mut impl FnMut(T)) {
        push(root);
    }
}

pub struct SinCosKernel;

impl<T: Scalar> KernelBody<T> for SinCosKernel {
    type Output = (T, T);

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<(T, T), Error> {
        Ok(arguments.angle.sin_cos())
    }

    fn flatten(&(sin, cos): &(T, T), push: &mut impl FnMut(T)) {
        push(sin);
        push(cos);
    }
}
