//! Tensions, tendons with curves, inverse statics and stiffness on command.

use super::{KernelArguments, KernelBody};
use leg_model::{BendingAxis, Elasticity, Error, HoldError, Scalar, StiffnessAnswer};
use nalgebra::SVector;

pub struct DistributionKernel;

impl<T: Scalar> KernelBody<T> for DistributionKernel {
    type Output = (leg_model::Distribution<T, 3>, SVector<T, 3>);

    #[inline(always)]
    fn run(bench: &KernelArguments<T>) -> Result<Self::Output, Error> {
        let map = &bench.kinematics.moment_map;
        let distribution = leg_model::distribute(map, &bench.plane, &bench.moment, &bench.bounds)?;
        Ok((distribution, distribution.tensions(bench.pretension)))
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
    fn run(bench: &KernelArguments<T>) -> Result<Self::Output, Error> {
        let [curve, ..] = &bench.curves;
        Ok([
            curve.elongation(bench.pretension)?,
            curve.stiffness(bench.pretension)?,
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
    fn run(bench: &KernelArguments<T>) -> Result<Self::Output, Error> {
        leg_model::inverse_statics_in_plane(
            bench.rig.geometry(),
            &bench.plane,
            &bench.direction,
            &bench.moment,
            &bench.bounds,
            &bench.curves,
            bench.pretension,
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
    fn run(bench: &KernelArguments<T>) -> Result<Self::Output, Error> {
        let command = leg_model::StiffnessCommand::new(
            bench.rig.geometry(),
            &bench.support,
            &bench.direction,
            T::zero(),
            &bench.load,
            &bench.curves,
            &bench.kinematics,
            &bench.distribution,
        );
        command.pretension_for(bench.demand, &BendingAxis::Softest, &bench.bounds)
    }

    fn flatten(answer: &Self::Output, push: &mut impl FnMut(T)) {
        push(answer.pretension_n);
        push(answer.stiffness_nm_per_rad);
        push(T::from(f32::from(
            answer.limit.map_or(0, |limit| limit.tendon),
        )));
    }
}
