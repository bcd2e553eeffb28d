//! What each kernel calls, and the numbers of its result.

use super::bench::Bench;
use leg_model::{
    BendingAxis, Deflection, Elasticity, Error, HoldError, Scalar, StiffnessAnswer, Symmetric3,
};
use nalgebra::{SVector, Vector3};

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

pub struct InverseKinematics;

impl<T: Scalar> Body<T> for InverseKinematics {
    type Output = leg_model::Kinematics<T, 3>;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
        leg_model::inverse_kinematics(bench.rig.geometry(), &bench.direction)
    }

    fn flatten(kinematics: &Self::Output, push: &mut impl FnMut(T)) {
        kinematics.lengths.iter().copied().for_each(&mut *push);
        kinematics.moment_map.iter().copied().for_each(push);
    }
}

pub struct ForwardKinematics;

impl<T: Scalar> Body<T> for ForwardKinematics {
    type Output = leg_model::ForwardKinematics<T>;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
        leg_model::forward_kinematics(bench.rig.geometry(), &bench.lengths, &bench.start)
    }

    fn flatten(found: &Self::Output, push: &mut impl FnMut(T)) {
        push_found(found, push);
    }
}

pub struct ForwardKinematicsUniversal;

impl<T: Scalar> Body<T> for ForwardKinematicsUniversal {
    type Output = leg_model::ForwardKinematics<T>;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
        leg_model::forward_kinematics_universal(
            bench.rig.geometry(),
            &bench.lengths_universal,
            &bench.start,
        )
    }

    fn flatten(found: &Self::Output, push: &mut impl FnMut(T)) {
        push_found(found, push);
    }
}

pub struct Distribution;

impl<T: Scalar> Body<T> for Distribution {
    type Output = (leg_model::Distribution<T, 3>, SVector<T, 3>);

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
        let map = &bench.kinematics.moment_map;
        let distribution = leg_model::distribute(map, &bench.plane, &bench.moment, &bench.bounds)?;
        Ok((distribution, distribution.tensions(bench.level)))
    }

    fn flatten((distribution, tensions): &Self::Output, push: &mut impl FnMut(T)) {
        distribution.particular.iter().copied().for_each(&mut *push);
        distribution.per_level.iter().copied().for_each(&mut *push);
        push(distribution.lowest_level);
        push(distribution.highest_level);
        tensions.iter().copied().for_each(push);
    }
}

pub struct FullPass;

impl<T: Scalar> Body<T> for FullPass {
    type Output = leg_model::FullPass<T, 3>;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
        Ok(leg_model::full_pass(
            &bench.rig,
            &bench.direction,
            &bench.load,
            &bench.states,
        ))
    }

    fn flatten(pass: &Self::Output, push: &mut impl FnMut(T)) {
        push_pass(pass, push);
    }

    fn check(pass: &Self::Output) -> Result<(), Error> {
        pass.deflection.map(|_| ())
    }
}

pub struct FullPassInPlane;

impl<T: Scalar> Body<T> for FullPassInPlane {
    type Output = leg_model::FullPass<T, 3>;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
        Ok(leg_model::full_pass_in_plane(
            &bench.rig,
            &bench.direction,
            &bench.plane,
            &bench.load,
            &bench.states,
        ))
    }

    fn flatten(pass: &Self::Output, push: &mut impl FnMut(T)) {
        push_pass(pass, push);
    }

    fn check(pass: &Self::Output) -> Result<(), Error> {
        pass.deflection.map(|_| ())
    }
}

/// Elongation and stiffness of the first tendon at the level.
pub struct TendonCurve;

impl<T: Scalar> Body<T> for TendonCurve {
    type Output = [T; 2];

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
        let [curve, ..] = &bench.curves;
        Ok([
            curve.elongation(bench.level)?,
            curve.stiffness(bench.level)?,
        ])
    }

    fn flatten(output: &Self::Output, push: &mut impl FnMut(T)) {
        output.iter().copied().for_each(push);
    }
}

pub struct InverseStatics;

impl<T: Scalar> Body<T> for InverseStatics {
    type Output = leg_model::Hold<T, 3>;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
        leg_model::inverse_statics_in_plane(
            bench.rig.geometry(),
            &bench.plane,
            &bench.direction,
            &bench.moment,
            &bench.bounds,
            &bench.curves,
            bench.level,
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

pub struct StiffnessCommand;

impl<T: Scalar> Body<T> for StiffnessCommand {
    type Output = StiffnessAnswer<T>;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<Self::Output, Error> {
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
        command.level_for(bench.demand, &BendingAxis::Softest, &bench.bounds)
    }

    fn flatten(answer: &Self::Output, push: &mut impl FnMut(T)) {
        push(answer.level_n);
        push(answer.stiffness_nm_per_rad);
        push(T::from(f32::from(
            answer.limit.map_or(0, |limit| limit.tendon),
        )));
    }
}

/// The model's part of a tick, as one kernel.
pub struct ModelTick;

/// What the model's part of a tick computes.
pub struct TickOutput<T> {
    found: leg_model::ForwardKinematics<T>,
    moment: Vector3<T>,
    stiffness: Symmetric3<T>,
    deflection: Deflection<T>,
    tensions: SVector<T, 3>,
    unstretched: SVector<T, 3>,
}

impl<T: Scalar> Body<T> for ModelTick {
    type Output = TickOutput<T>;

    #[inline(always)]
    fn run(bench: &Bench<T>) -> Result<TickOutput<T>, Error> {
        let found =
            leg_model::forward_kinematics(bench.rig.geometry(), &bench.lengths, &bench.start)?;
        let pass = leg_model::full_pass(&bench.rig, &found.direction, &bench.load, &bench.states);
        let deflection = pass.deflection?;
        let kinematics = &pass.kinematics;
        let moment = leg_model::estimate_moment(&kinematics.moment_map, bench.states.tensions());
        let plane = leg_model::FreePlane::torsion_free(&found.direction);
        let distribution =
            leg_model::distribute(&kinematics.moment_map, &plane, &moment, &bench.bounds)?;
        let tensions = distribution.tensions(bench.level);
        let mut unstretched = kinematics.lengths;
        for (i, tendon) in bench.tendons.iter().enumerate() {
            unstretched[i] -= tendon.elongation(tensions[i])?;
        }
        Ok(TickOutput {
            found,
            moment,
            stiffness: pass.stiffness,
            deflection,
            tensions,
            unstretched,
        })
    }

    fn flatten(tick: &Self::Output, push: &mut impl FnMut(T)) {
        push_found(&tick.found, push);
        tick.moment.iter().copied().for_each(&mut *push);
        push_symmetric(&tick.stiffness, push);
        push_deflection(&tick.deflection, push);
        tick.tensions.iter().copied().for_each(&mut *push);
        tick.unstretched.iter().copied().for_each(push);
    }
}

fn push_found<T: Scalar>(found: &leg_model::ForwardKinematics<T>, push: &mut impl FnMut(T)) {
    found
        .direction
        .vector()
        .iter()
        .copied()
        .for_each(&mut *push);
    push(found.residual_m);
    push(T::from(f32::from(found.steps)));
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

fn push_symmetric<T: Scalar>(matrix: &Symmetric3<T>, push: &mut impl FnMut(T)) {
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

fn push_deflection<T: Scalar>(deflection: &Deflection<T>, push: &mut impl FnMut(T)) {
    deflection.rotation.iter().copied().for_each(&mut *push);
    deflection.tip_displacement.iter().copied().for_each(push);
}
