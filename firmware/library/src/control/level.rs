//! Stiffness on command, one step a cycle: the level of pretension that makes the leg as stiff as demanded.

use super::{
    Mechanism, Target,
    bounds::{least, most, within},
};
use leg_model::{BendingAxis, Error, Scalar, StiffnessCommand};

/// Stiffnesses that differ by no more than this part of the demand are equal.
const TOLERANCE: f32 = 1e-3;

/// Longest step of the search, N.
const STEP_N: f32 = 10.0;

/// What the level of pretension is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LevelDemand<T> {
    /// The level itself, N.
    Level(T),
    /// A bending stiffness, N·m/rad.
    Stiffness(T, BendingAxis<T>),
}

/// The search for the level.
#[derive(Clone, Copy, Debug)]
pub struct Level<T> {
    demand: LevelDemand<T>,
    level_n: T,
    last_level_n: T,
    last_stiffness: T,
    /// Stiffness per level.
    slope: T,
    unreachable: bool,
}

impl<T: Scalar> Level<T> {
    /// A level that is asked for directly, N.
    pub fn new(level_n: T) -> Self {
        Self {
            demand: LevelDemand::Level(level_n),
            level_n,
            last_level_n: T::zero(),
            last_stiffness: T::zero(),
            slope: T::one(),
            unreachable: false,
        }
    }

    /// Takes another demand; the search goes on from where it is.
    pub fn demand(&mut self, demand: LevelDemand<T>) {
        self.demand = demand;
        self.unreachable = false;
        if let LevelDemand::Level(level_n) = demand {
            self.level_n = level_n;
        }
    }

    /// The level found so far, N.
    #[inline(always)]
    pub fn level_n(&self) -> T {
        self.level_n
    }

    /// Stiffness at that level, N·m/rad: the smallest against a tilt unless another was demanded.
    #[inline(always)]
    pub fn stiffness_nm_per_rad(&self) -> T {
        self.last_stiffness
    }

    /// Whether the bounds on the tensions stop the search short of the demand.
    #[inline(always)]
    pub fn unreachable(&self) -> bool {
        self.unreachable
    }

    /// One step at a target, with the payload that it carries.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; [`Error::Unstable`].
    #[inline(always)]
    pub fn step(
        &mut self,
        mechanism: &Mechanism<T>,
        target: &Target<T>,
        payload_kg: T,
    ) -> Result<(), Error> {
        let (axis, demand) = match self.demand {
            LevelDemand::Level(_) => (BendingAxis::Softest, None),
            LevelDemand::Stiffness(demand, axis) => (axis, Some(demand)),
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
            target.distribution.lowest_level,
            target.distribution.highest_level,
        );
        let level = least(most(self.level_n, lowest), highest);
        let stiffness = command.stiffness_at(level, &axis)?;
        if let Some(demand) = demand {
            self.search(level, stiffness, demand, [lowest, highest]);
        }
        (self.last_level_n, self.last_stiffness) = (level, stiffness);
        Ok(())
    }

    /// A step of the secant method, kept short.
    #[inline(always)]
    fn search(&mut self, level: T, stiffness: T, demand: T, [lowest, highest]: [T; 2]) {
        let error = demand - stiffness;
        let moved = level - self.last_level_n;
        // A tendon's stiffness about grows with its tension; where it does not, the search must still go on.
        let proportion = T::from(0.2) * stiffness / most(level, T::one());
        if moved.abs() > T::from(0.05) {
            self.slope = (stiffness - self.last_stiffness) / moved;
        }
        let slope = most(self.slope, proportion);
        let met = error.abs() <= T::from(TOLERANCE) * demand;
        let step = if met {
            T::zero()
        } else {
            within(error / slope, T::from(STEP_N))
        };
        let wanted = level + step;
        self.level_n = least(most(wanted, lowest), highest);
        self.unreachable = wanted < lowest || wanted > highest;
    }
}
