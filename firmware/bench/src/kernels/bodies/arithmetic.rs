//! Square root, sine and cosine.

use super::{Bench, Body};
use leg_model::{Error, Scalar};

pub struct SquareRoot;

impl<T: Scalar> Body<T> for SquareRoot {
    type Output = T;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<T, Error> {
        Ok(bench.angle.abs().sqrt())
    }

    fn flatten(&root: &T, push: &mut impl FnMut(T)) {
        push(root);
    }
}

pub struct SinCos;

impl<T: Scalar> Body<T> for SinCos {
    type Output = (T, T);

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<(T, T), Error> {
        Ok(bench.angle.sin_cos())
    }

    fn flatten(&(sin, cos): &(T, T), push: &mut impl FnMut(T)) {
        push(sin);
        push(cos);
    }
}
