//! What each kernel calls, and the numbers of its result.

use super::bench::Bench;
use leg_model::{Error, Scalar, Symmetric3};
use nalgebra::{SVector, Vector3};

/// A kernel as a type.
pub trait Body {
    type Output;
    fn run(bench: &Bench) -> Result<Self::Output, Error>;
    fn flatten(output: &Self::Output, push: &mut impl FnMut(f32));
}

pub struct SquareRoot;

impl Body for SquareRoot {
    type Output = f32;

    #[inline(always)]
    fn run(bench: &Bench) -> Result<f32, Error> {
        Ok(Scalar::sqrt(Scalar::abs(bench.angle)))
    }

    fn flatten(&root: &f32, push: &mut impl FnMut(f32)) {
        push(root);
    }
}

pub struct SinCos;

impl Body for SinCos {
    type Output = (f32, f32);

    #[inline(always)]
    fn run(bench: &Bench) -> Result<(f32, f32), Error> {
        Ok(Scalar::sin_cos(bench.angle))
    }

    fn flatten(&(sin, cos): &(f32, f32), push: &mut impl FnMut(f32)) {
        push(sin);
        push(cos);
    }
}

pub struct InverseKinematics;

impl Body for InverseKinematics {
    type Output = leg_model::Kinematics<f32, 3>;

    #[inline(always)]
    fn run(bench: &Bench) -> Result<Self::Output, Error> {
        leg_model::inverse_kinematics(bench.rig.geometry(), &bench.direction)
    }

    fn flatten(kinematics: &Self::Output, push: &mut impl FnMut(f32)) {
        kinematics.lengths.iter().copied().for_each(&mut *push);
        kinematics.moment_map.iter().copied().for_each(push);
    }
}

pub struct ForwardKinematics;

impl Body for ForwardKinematics {
    type Output = leg_model::ForwardKinematics<f32>;

    #[inline(always)]
    fn run(bench: &Bench) -> Result<Self::Output, Error> {
        leg_model::forward_kinematics(bench.rig.geometry(), &bench.lengths, &bench.start)
    }

    fn flatten(found: &Self::Output, push: &mut impl FnMut(f32)) {
        push_found(found, push);
    }
}

pub struct ForwardKinematicsUniversal;

impl Body for ForwardKinematicsUniversal {
    type Output = leg_model::ForwardKinematics<f32>;

    #[inline(always)]
    fn run(bench: &Bench) -> Result<Self::Output, Error> {
        leg_model::forward_kinematics_universal(
            bench.rig.geometry(),
            &bench.lengths_universal,
            &bench.start,
        )
    }

    fn flatten(found: &Self::Output, push: &mut impl FnMut(f32)) {
        push_found(found, push);
    }
}

pub struct Distribution;

impl Body for Distribution {
    type Output = (leg_model::Distribution<f32, 3>, SVector<f32, 3>);

    #[inline(always)]
    fn run(bench: &Bench) -> Result<Self::Output, Error> {
        let map = &bench.kinematics.moment_map;
        let distribution = leg_model::distribute(map, &bench.plane, &bench.moment, &bench.bounds)?;
        Ok((distribution, distribution.tensions(bench.level)))
    }

    fn flatten((distribution, tensions): &Self::Output, push: &mut impl FnMut(f32)) {
        distribution.particular.iter().copied().for_each(&mut *push);
        distribution.per_level.iter().copied().for_each(&mut *push);
        push(distribution.lowest_level);
        push(distribution.highest_level);
        tensions.iter().copied().for_each(push);
    }
}

pub struct FullPass;

impl Body for FullPass {
    type Output = leg_model::FullPass<f32, 3>;

    #[inline(always)]
    fn run(bench: &Bench) -> Result<Self::Output, Error> {
        leg_model::full_pass(&bench.rig, &bench.direction, &bench.load, &bench.states)
    }

    fn flatten(pass: &Self::Output, push: &mut impl FnMut(f32)) {
        push_pass(pass, push);
    }
}

pub struct FullPassInPlane;

impl Body for FullPassInPlane {
    type Output = leg_model::FullPass<f32, 3>;

    #[inline(always)]
    fn run(bench: &Bench) -> Result<Self::Output, Error> {
        leg_model::full_pass_in_plane(
            &bench.rig,
            &bench.direction,
            &bench.plane,
            &bench.load,
            &bench.states,
        )
    }

    fn flatten(pass: &Self::Output, push: &mut impl FnMut(f32)) {
        push_pass(pass, push);
    }
}

/// The model's part of a tick, as one kernel.
pub struct ModelTick;

/// What the model's part of a tick computes.
pub struct TickOutput {
    found: leg_model::ForwardKinematics<f32>,
    moment: Vector3<f32>,
    pass: leg_model::FullPass<f32, 3>,
    tensions: SVector<f32, 3>,
    unstretched: SVector<f32, 3>,
}

impl Body for ModelTick {
    type Output = TickOutput;

    #[inline(always)]
    fn run(bench: &Bench) -> Result<TickOutput, Error> {
        let found =
            leg_model::forward_kinematics(bench.rig.geometry(), &bench.lengths, &bench.start)?;
        let pass = leg_model::full_pass(&bench.rig, &found.direction, &bench.load, &bench.states)?;
        let kinematics = &pass.kinematics;
        let moment = leg_model::estimate_moment(&kinematics.moment_map, &bench.states.tensions);
        let plane = leg_model::FreePlane::torsion_free(&found.direction);
        let distribution =
            leg_model::distribute(&kinematics.moment_map, &plane, &moment, &bench.bounds)?;
        let tensions = distribution.tensions(bench.level);
        let unstretched =
            SVector::from_fn(|i, _| bench.tendon.unstretched(kinematics.lengths[i], tensions[i]));
        Ok(TickOutput {
            found,
            moment,
            pass,
            tensions,
            unstretched,
        })
    }

    fn flatten(tick: &TickOutput, push: &mut impl FnMut(f32)) {
        push_found(&tick.found, push);
        tick.moment.iter().copied().for_each(&mut *push);
        tick.pass
            .tip_displacement
            .iter()
            .copied()
            .for_each(&mut *push);
        tick.tensions.iter().copied().for_each(&mut *push);
        tick.unstretched.iter().copied().for_each(push);
    }
}

fn push_found(found: &leg_model::ForwardKinematics<f32>, push: &mut impl FnMut(f32)) {
    found
        .direction
        .vector()
        .iter()
        .copied()
        .for_each(&mut *push);
    push(found.residual_m);
    push(f32::from(found.steps));
}

fn push_pass(pass: &leg_model::FullPass<f32, 3>, push: &mut impl FnMut(f32)) {
    pass.kinematics.lengths.iter().copied().for_each(&mut *push);
    pass.kinematics
        .moment_map
        .iter()
        .copied()
        .for_each(&mut *push);
    let Symmetric3 {
        xx,
        xy,
        xz,
        yy,
        yz,
        zz,
    } = pass.stiffness;
    [xx, xy, xz, yy, yz, zz].into_iter().for_each(&mut *push);
    pass.rotation.iter().copied().for_each(&mut *push);
    pass.tip_displacement.iter().copied().for_each(push);
}
