//! Inverse and forward kinematics.

use super::{KernelArguments, KernelBody};
use leg_model::{Error, Scalar};

pub struct InverseKinematicsKernel;

impl<T: Scalar> KernelBody<T> for InverseKinematicsKernel {
    type Output = leg_model::Kinematics<T, 3>;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        leg_model::inverse_kinematics(arguments.rig.geometry(), &arguments.direction)
    }

    fn flatten(kinematics: &Self::Output, push: &mut impl FnMut(T)) {
        kinematics.lengths.iter().copied().for_each(&mut *push);
        kinematics.moment_map.iter().copied().for_each(push);
    }
}

pub struct ForwardKinematicsKernel;

impl<T: Scalar> KernelBody<T> for ForwardKinematicsKernel {
    type Output = leg_model::ForwardKinematics<T>;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        leg_model::forward_kinematics(
            arguments.rig.geometry(),
            &arguments.lengths,
            &arguments.start,
        )
    }

    fn flatten(found: &Self::Output, push: &mut impl FnMut(T)) {
        push_found(found, push);
    }
}

pub struct ForwardKinematicsUniversalKernel;

impl<T: Scalar> KernelBody<T> for ForwardKinematicsUniversalKernel {
    type Output = leg_model::ForwardKinematics<T>;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        leg_model::forward_kinematics_universal(
            arguments.rig.geometry(),
            &arguments.lengths_universal,
            &arguments.start,
        )
    }

    fn flatten(found: &Self::Output, push: &mut impl FnMut(T)) {
        push_found(found, push);
    }
}

pub(super) fn push_found<T: Scalar>(
    found: &leg_model::ForwardKinematics<T>,
    push: &mut impl FnMut(T),
) {
    found
        .direction
        .vector()
        .iter()
        .copied()
        .for_each(&mut *push);
    push(found.residual_m);
    push(T::from(f32::from(found.steps)));
}
