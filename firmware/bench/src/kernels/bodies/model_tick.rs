//! The model's part of a tick.

use super::full_pass::{push_deflection, push_symmetric};
use super::kinematics::push_found;
use super::{KernelArguments, KernelBody};
use leg_model::{Deflection, Elasticity, Error, Scalar, Symmetric3};
use nalgebra::{SVector, Vector3};

/// The model's part of a tick, as one kernel.
pub struct ModelTickKernel;

/// What the model's part of a tick computes.
pub struct TickOutput<T> {
    found: leg_model::ForwardKinematics<T>,
    moment: Vector3<T>,
    stiffness: Symmetric3<T>,
    deflection: Deflection<T>,
    tensions: SVector<T, 3>,
    unstretched: SVector<T, 3>,
}

impl<T: Scalar> KernelBody<T> for ModelTickKernel {
    type Output = TickOutput<T>;

    #[inline(always)]
    fn run(arguments: &KernelArguments<T>) -> Result<TickOutput<T>, Error> {
        let found = leg_model::forward_kinematics(
            arguments.rig.geometry(),
            &arguments.lengths,
            &arguments.start,
        )?;
        let pass = leg_model::full_pass(
            &arguments.rig,
            &found.direction,
            &arguments.load,
            &arguments.states,
        );
        let deflection = pass.deflection?;
        let kinematics = &pass.kinematics;
        let moment =
            leg_model::estimate_moment(&kinematics.moment_map, arguments.states.tensions());
        let plane = leg_model::FreePlane::torsion_free(&found.direction);
        let distribution =
            leg_model::distribute(&kinematics.moment_map, &plane, &moment, &arguments.bounds)?;
        let tensions = distribution.tensions(arguments.pretension);
        let mut unstretched = kinematics.lengths;
        for (i, tendon) in arguments.tendons.iter().enumerate() {
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
