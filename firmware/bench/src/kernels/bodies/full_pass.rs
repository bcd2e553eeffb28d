//! The full pass, on a ball joint and in a plane.

use super::{KernelArguments, KernelBody};
use leg_model::{Deflection, Error, Scalar, Symmetric3};

pub struct FullPassKernel;

impl<T: Scalar> KernelBody<T> for FullPassKernel {
    type Output = leg_model::FullPass<T, 3>;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        Ok(leg_model::full_pass(
            &arguments.rig,
            &arguments.direction,
            &arguments.load,
            &arguments.states,
        ))
    }

    fn flatten(pass: &Self::Output, push: &mut impl FnMut(T)) {
        push_pass(pass, push);
    }

    fn check(pass: &Self::Output) -> Result<(), Error> {
        pass.deflection.map(|_| ())
    }
}

pub struct FullPassInPlaneKernel;

impl<T: Scalar> KernelBody<T> for FullPassInPlaneKernel {
    type Output = leg_model::FullPass<T, 3>;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        Ok(leg_model::full_pass_in_plane(
            &arguments.rig,
            &arguments.direction,
            &arguments.plane,
            &arguments.load,
            &arguments.states,
        ))
    }

    fn flatten(pass: &Self::Output, push: &mut impl FnMut(T)) {
        push_pass(pass, push);
    }

    fn check(pass: &Self::Output) -> Result<(), Error> {
        pass.deflection.map(|_| ())
    }
}

fn push_pass<T: Scalar>(pass: &leg_model::FullPass<T, 3>, push: &mut impl FnMut(T)) {
    pass.kinematics.lengths.iter().copied().for_each(&mut *push);
    pass.kinematics
        .moment_map
        .iter()
        .copied()
        .for_each(&mut *push);
    push_symmetric(&pass.stiffness, push);
    if let Ok(deflection) = &pass.deflection {
        push_deflection(deflection, push);
    }
}

pub(super) fn push_symmetric<T: Scalar>(matrix: &Symmetric3<T>, push: &mut impl FnMut(T)) {
    let &Symmetric3 {
        xx,
        xy,
        xz,
        yy,
        yz,
        zz,
    } = matrix;
    [xx, xy, xz, yy, yz, zz].into_iter().for_each(push);
}

pub(super) fn push_deflection<T: Scalar>(deflection: &Deflection<T>, push: &mut impl FnMut(T)) {
    deflection.rotation.iter().copied().for_each(&mut *push);
    deflection.tip_displacement.iter().copied().for_each(push);
}
