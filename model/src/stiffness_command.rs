//! Stiffness on command: the level of pretension that makes the leg as stiff as demanded.

use crate::full_pass::tension_stiffness;
use crate::range::{JOINT_STIFFNESS_MAX, check_positive};
use crate::{
    Bending, BendingAxis, Direction, Distribution, Elasticity, Error, FreePlane, Geometry,
    Kinematics, Limit, Load, Quantity, Scalar, Support, Symmetric3, TensionBounds,
};

/// Stiffnesses that differ by no more than this part of the demand are equal.
const TOLERANCE: f32 = 1e-4;

/// Steps after which a search without convergence ends. Stiffness is nearly linear in the level: three do as a rule.
const STEPS_MAX: u8 = 12;

/// A leg at a pose under a load, whose level of pretension is still open.
#[derive(Clone, Copy, Debug)]
pub struct StiffnessCommand<'a, T, E, const N: usize> {
    tendons: &'a [E; N],
    kinematics: &'a Kinematics<T, N>,
    distribution: &'a Distribution<T, N>,
    direction: Direction<T>,
    plane: FreePlane<T>,
    twists: bool,
    /// The stiffness at level zero but for that of the tendons themselves.
    base: Symmetric3<T>,
    /// What a level of one adds to that.
    per_level: Symmetric3<T>,
}

/// The answer to a demand.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize, postcard_schema::Schema)
)]
pub struct StiffnessAnswer<T> {
    /// Level of pretension, N.
    pub level_n: T,
    /// The stiffness that it gives, N·m/rad: the demanded one, or the nearest to it that can be reached.
    pub stiffness_nm_per_rad: T,
    /// The tendon and the bound that stop it short of the demand; none if the demand is met.
    pub limit: Option<Limit>,
}

impl<'a, T: Scalar, E: Elasticity<T>, const N: usize> StiffnessCommand<'a, T, E, N> {
    /// The leg at a pose: its geometry twisted as the support twists it there, `torsion` the elastic part of that (rad),
    /// and `kinematics` and `distribution` of that pose under the load.
    #[allow(
        clippy::too_many_arguments,
        reason = "each is a part of the pose that the caller has at hand"
    )]
    #[inline(always)]
    pub fn new(
        geometry: &Geometry<T, N>,
        support: &Support<T>,
        direction: &Direction<T>,
        torsion: T,
        load: &Load<T>,
        tendons: &'a [E; N],
        kinematics: &'a Kinematics<T, N>,
        distribution: &'a Distribution<T, N>,
    ) -> Self {
        let joint = Symmetric3::symmetric_part(&support.joint_stiffness(direction, torsion));
        let [fixed, per_level] = tension_stiffness(geometry, direction, load, distribution);
        Self {
            tendons,
            kinematics,
            distribution,
            direction: *direction,
            plane: support.plane(direction),
            twists: support.twists(),
            base: fixed.plus(&joint),
            per_level,
        }
    }

    /// The bending stiffness at a level of pretension in N, with each tendon at its own tension, N·m/rad.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; [`Error::Unstable`].
    #[inline(always)]
    pub fn stiffness_at(&self, level: T, axis: &BendingAxis<T>) -> Result<T, Error> {
        let mut total = self.base.plus_scaled(&self.per_level, level);
        let tensions = self.distribution.tensions(level);
        for (i, tendon) in self.tendons.iter().enumerate() {
            let stiffness = tendon.stiffness(tensions[i])?;
            total.add_square(&self.kinematics.moment_map, i, stiffness);
        }
        let bending = if self.twists {
            Bending::twisting(&total, &self.direction)?
        } else {
            Bending::guided(&total, &self.direction, &self.plane)
        };
        bending.about(axis)
    }

    /// The level that gives a demanded bending stiffness (N·m/rad) within the bounds on the tensions.
    ///
    /// Stiffness is taken to rise (or to fall) with the level from one end of its range to the other, as it does where
    /// every tendon is tensioned beyond its softest point; a demand outside the stiffnesses at the two ends is answered
    /// with the nearer end.
    ///
    /// # Errors
    /// A demand that is not finite or not positive; [`Error::Infeasible`] if no level keeps the bounds; those of
    /// [`Self::stiffness_at`]; [`Error::NotConverged`].
    #[inline(always)]
    pub fn level_for(
        &self,
        demand: T,
        axis: &BendingAxis<T>,
        bounds: &TensionBounds<T>,
    ) -> Result<StiffnessAnswer<T>, Error> {
        check_positive(demand, JOINT_STIFFNESS_MAX, Quantity::BendingStiffness)?;
        if !self.distribution.feasible() {
            return Err(Error::Infeasible);
        }
        let (low, high) = (
            self.distribution.lowest_level,
            self.distribution.highest_level,
        );
        let below = End::new(low, self.stiffness_at(low, axis)?, demand);
        let above = End::new(high, self.stiffness_at(high, axis)?, demand);
        if (below.error > T::zero()) == (above.error > T::zero()) {
            let nearer_below = below.error.abs() <= above.error.abs();
            let [lowest, highest] = self.distribution.limits(bounds);
            let (end, limit) = if nearer_below {
                (below, lowest)
            } else {
                (above, highest)
            };
            return Ok(StiffnessAnswer {
                level_n: end.level,
                stiffness_nm_per_rad: demand + end.error,
                limit: Some(limit),
            });
        }
        self.search(below, above, demand, axis)
    }

    /// Between two levels whose stiffnesses enclose the demand: the false position, the end that stays weighed less
    /// each time (after Anderson and Björck, 1973).
    #[inline(always)]
    fn search(
        &self,
        mut kept: End<T>,
        mut last: End<T>,
        demand: T,
        axis: &BendingAxis<T>,
    ) -> Result<StiffnessAnswer<T>, Error> {
        for _ in 0..STEPS_MAX {
            let slope = last.error - kept.error;
            let level = last.level - last.error * (last.level - kept.level) / slope;
            let next = End::new(level, self.stiffness_at(level, axis)?, demand);
            if next.error.abs() <= T::from(TOLERANCE) * demand {
                return Ok(StiffnessAnswer {
                    level_n: level,
                    stiffness_nm_per_rad: demand + next.error,
                    limit: None,
                });
            }
            if (next.error > T::zero()) == (last.error > T::zero()) {
                let left = T::one() - next.error / last.error;
                kept.error *= if left > T::zero() { left } else { T::HALF };
            } else {
                kept = last;
            }
            last = next;
        }
        Err(Error::NotConverged)
    }
}

/// A level of pretension and how far its stiffness is above the demand.
#[derive(Clone, Copy)]
struct End<T> {
    level: T,
    error: T,
}

impl<T: Scalar> End<T> {
    #[inline(always)]
    fn new(level: T, stiffness: T, demand: T) -> Self {
        Self {
            level,
            error: stiffness - demand,
        }
    }
}
