//! Stiffness on command, step by step: the pretension that makes the leg as stiff as demanded.

use super::{
    Mechanism, Target,
    bounds::{clamp_symmetric, max, min},
    target::ON_ITS_WAY_PART,
};
use crate::set_point::StreamTension;
use leg_model::{BendingAxis, Error, Scalar, StiffnessCommand};

/// Stiffnesses that differ by no more than this part of the demand are equal: well below what a tendon's curve is known to.
const TOLERANCE: f32 = 1e-3;

/// Longest step of the search, N: the secant's slope is not trusted over more of a curved stiffness. The scenarios `stiffness`
/// and `stiffness_lean` hold it.
const STEP_N: f32 = 10.0;

/// What the pretension is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PretensionDemand<T> {
    /// The pretension itself, N.
    Pretension(T),
    /// A bending stiffness, N·m/rad.
    Stiffness(T, BendingAxis<T>),
}

impl<T: Scalar> From<StreamTension> for PretensionDemand<T> {
    fn from(tension: StreamTension) -> Self {
        match tension {
            StreamTension::Pretension(pretension_n) => Self::Pretension(pretension_n.into()),
            StreamTension::Stiffness(stiffness) => {
                Self::Stiffness(stiffness.into(), BendingAxis::Softest)
            }
        }
    }
}

/// The search for the pretension.
#[derive(Clone, Copy, Debug)]
pub struct PretensionSearch<T> {
    demand: PretensionDemand<T>,
    pretension_n: T,
    last_pretension_n: T,
    last_stiffness: T,
    swing_stiffness: T,
    /// Stiffness per pretension.
    slope: T,
    unreachable: bool,
    /// Whether the last turn was the search's.
    has_turn: bool,
}

impl<T: Scalar> PretensionSearch<T> {
    /// A pretension that is asked for directly, N.
    pub fn new(pretension_n: T) -> Self {
        Self {
            demand: PretensionDemand::Pretension(pretension_n),
            pretension_n,
            last_pretension_n: T::zero(),
            last_stiffness: T::zero(),
            swing_stiffness: T::zero(),
            slope: T::one(),
            unreachable: false,
            has_turn: true,
        }
    }

    /// Takes another demand; the search goes on from where it is.
    pub fn demand(&mut self, demand: PretensionDemand<T>) {
        self.demand = demand;
        self.unreachable = false;
        if let PretensionDemand::Pretension(pretension_n) = demand {
            self.pretension_n = pretension_n;
        }
    }

    /// The demand: as a pretension, N, or as a stiffness, N·m/rad.
    pub fn demanded(&self) -> [Option<T>; 2] {
        match self.demand {
            PretensionDemand::Pretension(pretension_n) => [Some(pretension_n), None],
            PretensionDemand::Stiffness(stiffness, _) => [None, Some(stiffness)],
        }
    }

    /// The pretension found so far, N.
    #[inline(always)]
    pub fn pretension_n(&self) -> T {
        self.pretension_n
    }

    /// Stiffness at the pretension of the last step, N·m/rad: the smallest against a tilt unless another was demanded.
    #[inline(always)]
    pub fn stiffness_nm_per_rad(&self) -> T {
        self.last_stiffness
    }

    /// Stiffness of the leg's swing at that pretension, N·m/rad: that of the mean compliance against a tilt.
    #[inline(always)]
    pub fn swing_stiffness_nm_per_rad(&self) -> T {
        self.swing_stiffness
    }

    /// Whether the bounds on the tensions stop the search short of the demand.
    #[inline(always)]
    pub fn unreachable(&self) -> bool {
        self.unreachable
    }

    /// Whether a target with this pretension, N, is on its way to the one at which the last step looked.
    #[inline(always)]
    pub fn is_far_from(&self, pretension_n: T) -> bool {
        (pretension_n - self.last_pretension_n).abs() > T::from(ON_ITS_WAY_PART) * pretension_n
    }

    /// Takes turns with another: whether this one is the search's.
    #[inline(always)]
    pub fn take_turn(&mut self) -> bool {
        self.has_turn = !self.has_turn;
        self.has_turn
    }

    /// One step at a target, with the payload that it carries: at the target's own pretension where one is asked for, and at the one found so far
    /// where a stiffness is. Gives the stiffnesses of the tendons at that pretension, N/m.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; [`Error::Unstable`].
    #[inline(always)]
    pub fn step(
        &mut self,
        mechanism: &Mechanism<T>,
        target: &Target<T>,
        payload_kg: T,
    ) -> Result<[T; 3], Error> {
        let (axis, demand) = match self.demand {
            PretensionDemand::Pretension(_) => (BendingAxis::Softest, None),
            PretensionDemand::Stiffness(demand, axis) => (axis, Some(demand)),
        };
        let load = mechanism.load(payload_kg)?;
        let command = StiffnessCommand::new(
            mechanism.geometry(&target.direction, target.torsion, &mut None),
            &mechanism.support,
            &target.direction,
            target.torsion,
            &load,
            &mechanism.tendons,
            &target.kinematics,
            &target.distribution,
        );
        let (lowest, highest) = (
            target.distribution.pretension_min,
            target.distribution.pretension_max,
        );
        let pretension = match demand {
            None => target.pretension_n,
            Some(_) => min(max(self.pretension_n, lowest), highest),
        };
        let stiffnesses_n_per_m = command.tendon_stiffnesses(pretension)?;
        let bending = command.bending_with(pretension, &stiffnesses_n_per_m)?;
        let stiffness = bending.stiffness_about(&axis)?;
        self.swing_stiffness = bending.compliant_mean();
        if let Some(demand) = demand {
            self.search(pretension, stiffness, demand, [lowest, highest]);
        }
        (self.last_pretension_n, self.last_stiffness) = (pretension, stiffness);
        Ok(stiffnesses_n_per_m)
    }

    /// A step of the secant method, kept short.
    #[inline(always)]
    fn search(&mut self, pretension: T, stiffness: T, demand: T, [lowest, highest]: [T; 2]) {
        let error = demand - stiffness;
        let moved = pretension - self.last_pretension_n;
        // A tendon's stiffness about grows with its tension. Where it hardly does, the slope is taken as a fifth of proportional,
        // so that the search goes on.
        let proportion = T::from(0.2) * stiffness / max(pretension, T::one());
        // Over a shorter move, N, the difference of two stiffnesses is rounding.
        if moved.abs() > T::from(0.05) {
            self.slope = (stiffness - self.last_stiffness) / moved;
        }
        let slope = max(self.slope, proportion);
        let met = error.abs() <= T::from(TOLERANCE) * demand;
        let step = if met {
            T::zero()
        } else {
            clamp_symmetric(error / slope, T::from(STEP_N))
        };
        let wanted = pretension + step;
        // Not clamped: the bounds of the next target are others. One that stood still at the last ones while they move would let
        // the targets go to and fro, and the motors with them.
        self.pretension_n = wanted;
        self.unreachable = wanted < lowest || wanted > highest;
    }
}

#[cfg(test)]
mod tests {
    use super::PretensionSearch;

    /// What is asked for beyond a bound is called unreachable, below as above, and what is within them is not.
    #[test]
    fn a_demand_beyond_either_bound_is_unreachable() {
        let bounds_n @ [lowest_n, highest_n] = [60.0, 80.0];
        for (demand, unreachable) in [(59.0, true), (70.0, false), (81.0, true)] {
            let mut search = PretensionSearch::<f64>::new(70.0);
            for _ in 0..20 {
                // As stiff as it is taut.
                let pretension_n = search.pretension_n.clamp(lowest_n, highest_n);
                search.search(pretension_n, pretension_n, demand, bounds_n);
                (search.last_pretension_n, search.last_stiffness) = (pretension_n, pretension_n);
            }
            assert_eq!(search.unreachable(), unreachable, "{demand}");
        }
    }
}
