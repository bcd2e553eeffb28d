//! Tensions, tendons with curves, inverse statics and stiffness on command.

use super::{KernelArguments, KernelBody};
use leg_model::{BendingAxis, Elasticity, Error, HoldError, Scalar, StiffnessAnswer};
use nalgebra::SVector;

pub struct DistributionKernel;

impl<T: Scalar> KernelBody<T> for DistributionKernel {
    type Output = (leg_model::Distribution<T, 3>, SVector<T, 3>);

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        let map = &arguments.kinematics.moment_map;
        let distribution =
            leg_model::distribute(map, &arguments.plane, &arguments.moment, &arguments.bounds)?;
        Ok((distribution, distribution.tensions(arguments.pretension)))
    }

    fn flatten((distribution, tensions): &Self::Output, push: &mut impl FnMut(T)) {
        distribution.particular.iter().copied().for_each(&mut *push);
        distribution
            .per_pretension
            .iter()
            .copied()
            .for_each(&mut *push);
        push(distribution.pretension_min);
        push(distribution.pretension_max);
        tensions.iter().copied().for_each(push);
    }
}

/// Elongation and stiffness of the first tendon at the pretension.
pub struct TendonCurveKernel;

impl<T: Scalar> KernelBody<T> for TendonCurveKernel {
    type Output = [T; 2];

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        let [curve, ..] = &arguments.curves;
        Ok([
            curve.elongation(arguments.pretension)?,
            curve.stiffness(arguments.pretension)?,
        ])
    }

    fn flatten(output: &Self::Output, push: &mut impl FnMut(T)) {
        output.iter().copied().for_each(push);
    }
}

pub struct InverseStaticsKernel;

impl<T: Scalar> KernelBody<T> for InverseStaticsKernel {
    type Output = leg_model::Hold<T, 3>;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        leg_model::inverse_statics_in_plane(
            arguments.rig.geometry(),
            &arguments.plane,
            &arguments.direction,
            &arguments.moment,
            &arguments.bounds,
            &arguments.curves,
            arguments.pretension,
        )
        .map_err(|error| match error {
            HoldError::Model(error) => error,
            _ => Error::Infeasible,
        })
    }

    fn flatten(found: &Self::Output, push: &mut impl FnMut(T)) {
        found.tensions.iter().copied().for_each(&mut *push);
        found.unstretched.iter().copied().for_each(push);
    }
}

pub struct StiffnessCommandKernel;

impl<T: Scalar> KernelBody<T> for StiffnessCommandKernel {
    type Output = StiffnessAnswer<T>;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<Self::Output, Error> {
        let command = leg_model::StiffnessCommand::new(
            arguments.rig.geometry(),
            &arguments.support,
            &arguments.direction,
            T::zero(),
            &arguments.load,
            &arguments.curves,
            &arguments.kinematics,
            &arguments.distribution,
        );
        command.pretension_for(arguments.demand, &BendingAxis::Softest, &arguments.bounds)
    }

    fn flatten(answer: &Self::Output, push: &mut impl FnMut(T)) {
        push(answer.pretension_n);
        push(answer.stiffness_nm_per_rad);
        push(T::from(f32::from(
            answer.limit.map_or(0, |limit| limit.tendon),
        )));
    }
}
