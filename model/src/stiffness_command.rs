//! Stiffness on command: the pretension that makes the leg as stiff as demanded.

use crate::full_pass::tension_stiffness;
use crate::range::{JOINT_STIFFNESS_MAX, check_positive};
use crate::{
    Bending, BendingAxis, Direction, Distribution, Elasticity, Error, FreePlane, Geometry,
    Kinematics, Limit, Load, Quantity, Scalar, Support, Symmetric3, TensionBounds,
};

/// Stiffnesses that differ by no more than this part of the demand are equal.
const TOLERANCE: f32 = 1e-4;

/// Steps after which a search without convergence ends. Stiffness is nearly linear in the pretension: three do as a rule.
const STEPS_MAX: u8 = 12;

/// Where the range is probed for a stiffness that comes nearer to the demand inwards: this part of it from the nearer
/// end.
const INWARD: f32 = 1.0 / 64.0;

/// It does if it is nearer there by more than this part of the demand. Where the stiffness hardly depends on the
/// pretension, no pretension is much better than another.
const CLOSER_BY: f32 = 1e-2;

/// Steps in which the range is tried then, and how often, ever nearer to the best.
const SCAN_STEPS: u8 = 16;
const SCAN_ROUNDS: u8 = 3;

/// A leg at a pose under a load, whose pretension is still open.
#[derive(Clone, Copy, Debug)]
pub struct StiffnessCommand<'a, T, E, const N: usize> {
    tendons: &'a [E; N],
    kinematics: &'a Kinematics<T, N>,
    distribution: &'a Distribution<T, N>,
    direction: Direction<T>,
    plane: FreePlane<T>,
    twists: bool,
    /// The stiffness at pretension zero but for that of the tendons themselves.
    base: Symmetric3<T>,
    /// What a pretension of one adds to that.
    per_pretension: Symmetric3<T>,
}

/// The answer to a demand.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub struct StiffnessAnswer<T> {
    /// Pretension, N.
    #[cfg_attr(feature = "serde", serde(rename = "level_n"))]
    pub pretension_n: T,
    /// The stiffness that it gives, N·m/rad: the demanded one, or the nearest to it that can be reached.
    pub stiffness_nm_per_rad: T,
    /// The tendon and the bound that stop it short of the demand. None if the demand is met, or if the tendons' softest
    /// point stops it and no bound does.
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
        let [fixed, per_pretension] = tension_stiffness(geometry, direction, load, distribution);
        Self {
            tendons,
            kinematics,
            distribution,
            direction: *direction,
            plane: support.plane(direction),
            twists: support.twists(),
            base: fixed.plus(&joint),
            per_pretension,
        }
    }

    /// The bending stiffness at a pretension in N, with each tendon at its own tension, N·m/rad.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; [`Error::Unstable`].
    #[inline(always)]
    pub fn stiffness_at(&self, pretension: T, axis: &BendingAxis<T>) -> Result<T, Error> {
        self.bending_at(pretension)?.stiffness_about(axis)
    }

    /// The stiffness against tilts at a pretension in N, with each tendon at its own tension.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; [`Error::Unstable`].
    #[inline(always)]
    pub fn bending_at(&self, pretension: T) -> Result<Bending<T>, Error> {
        let mut total = self.base.plus_scaled(&self.per_pretension, pretension);
        let tensions = self.distribution.tensions(pretension);
        for (i, tendon) in self.tendons.iter().enumerate() {
            let stiffness = tendon.stiffness(tensions[i])?;
            total.add_square(&self.kinematics.moment_map, i, stiffness);
        }
        if self.twists {
            Bending::twisting(&total, &self.direction)
        } else {
            Ok(Bending::guided(&total, &self.direction, &self.plane))
        }
    }

    /// The pretension that gives a demanded bending stiffness (N·m/rad) within the bounds on the tensions.
    ///
    /// A tendon with a curve is softest at some tension, so stiffness need not rise all the way. Where both ends of the
    /// range lie on one side of the demand and the stiffness nears it inwards, pretensions between them are tried, too;
    /// if none of them crosses the demand, the nearest of them is the answer, with no bound to name.
    ///
    /// # Errors
    /// A demand that is not finite or not positive; [`Error::Infeasible`] if no pretension keeps the bounds; those of
    /// [`Self::stiffness_at`]; [`Error::NotConverged`].
    #[inline(always)]
    pub fn pretension_for(
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
            self.distribution.pretension_min,
            self.distribution.pretension_max,
        );
        let below = Trial::new(low, self.stiffness_at(low, axis)?, demand);
        let above = Trial::new(high, self.stiffness_at(high, axis)?, demand);
        if (below.error > T::zero()) == (above.error > T::zero()) {
            return self.nearest_end(below, above, demand, axis, bounds);
        }
        self.search(below, above, demand, axis)
    }

    /// Both ends of the range lie on one side of the demand: the nearer one is the answer unless the stiffness nears the
    /// demand from there inwards.
    #[inline(always)]
    fn nearest_end(
        &self,
        below: Trial<T>,
        above: Trial<T>,
        demand: T,
        axis: &BendingAxis<T>,
        bounds: &TensionBounds<T>,
    ) -> Result<StiffnessAnswer<T>, Error> {
        let [lowest, highest] = self.distribution.limits(bounds);
        let (end, other, limit) = if below.error.abs() <= above.error.abs() {
            (below, above, lowest)
        } else {
            (above, below, highest)
        };
        let inward = end.pretension + (other.pretension - end.pretension) * T::from(INWARD);
        let inside = Trial::new(inward, self.stiffness_at(inward, axis)?, demand);
        if inside.error.abs() + T::from(CLOSER_BY) * demand < end.error.abs() {
            return self.scan(end, other, demand, axis);
        }
        Ok(StiffnessAnswer {
            pretension_n: end.pretension,
            stiffness_nm_per_rad: demand + end.error,
            limit: Some(limit),
        })
    }

    /// Tries pretensions from one end of the range to the other, then more of them around the nearest.
    #[cold]
    #[inline(never)]
    fn scan(
        &self,
        mut start: Trial<T>,
        end: Trial<T>,
        demand: T,
        axis: &BendingAxis<T>,
    ) -> Result<StiffnessAnswer<T>, Error> {
        let steps = T::from(f32::from(SCAN_STEPS));
        let (lowest, highest) = (
            self.distribution.pretension_min,
            self.distribution.pretension_max,
        );
        let mut step = (end.pretension - start.pretension) / steps;
        let mut nearest = start;
        for _ in 0..SCAN_ROUNDS {
            let mut last = start;
            for _ in 0..SCAN_STEPS {
                let pretension = clamp(last.pretension + step, lowest, highest);
                let next = Trial::new(pretension, self.stiffness_at(pretension, axis)?, demand);
                if (next.error > T::zero()) != (last.error > T::zero()) {
                    return self.search(last, next, demand, axis);
                }
                if next.error.abs() < nearest.error.abs() {
                    nearest = next;
                }
                last = next;
            }
            // From one step before the nearest to one after it.
            let pretension = clamp(nearest.pretension - step, lowest, highest);
            start = Trial::new(pretension, self.stiffness_at(pretension, axis)?, demand);
            step = (step + step) / steps;
        }
        Ok(StiffnessAnswer {
            pretension_n: nearest.pretension,
            stiffness_nm_per_rad: demand + nearest.error,
            limit: None,
        })
    }

    /// Between two pretensions whose stiffnesses enclose the demand: the false position, the end that stays weighed less
    /// each time (after Anderson and Björck, 1973).
    #[inline(always)]
    fn search(
        &self,
        mut kept: Trial<T>,
        mut last: Trial<T>,
        demand: T,
        axis: &BendingAxis<T>,
    ) -> Result<StiffnessAnswer<T>, Error> {
        for _ in 0..STEPS_MAX {
            let slope = last.error - kept.error;
            let pretension =
                last.pretension - last.error * (last.pretension - kept.pretension) / slope;
            let next = Trial::new(pretension, self.stiffness_at(pretension, axis)?, demand);
            if next.error.abs() <= T::from(TOLERANCE) * demand {
                return Ok(StiffnessAnswer {
                    pretension_n: pretension,
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

/// The pretension, or the end of the range that it is beyond.
fn clamp<T: Scalar>(pretension: T, lowest: T, highest: T) -> T {
    if pretension < lowest {
        lowest
    } else if pretension > highest {
        highest
    } else {
        pretension
    }
}

/// A pretension and how far its stiffness is above the demand.
#[derive(Clone, Copy)]
struct Trial<T> {
    pretension: T,
    error: T,
}

impl<T: Scalar> Trial<T> {
    #[inline(always)]
    fn new(pretension: T, stiffness: T, demand: T) -> Self {
        Self {
            pretension,
            error: stiffness - demand,
        }
    }
}
