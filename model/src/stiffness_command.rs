//! Stiffness on command: the pretension that makes the leg as stiff as demanded.

use crate::full_pass::tension_stiffness;
use crate::range::{JOINT_STIFFNESS_MAX, check_positive};
use crate::{
    Bending, BendingAxis, Direction, Distribution, Elasticity, Error, FreePlane, Geometry,
    Kinematics, Limit, Load, Quantity, Scalar, Support, Symmetric3, TensionBounds,
};

/// Stiffnesses that differ by no more than this part of the demand are equal.
const TOLERANCE: f32 = 1e-4;

/// Steps of the false position. Stiffness is nearly linear in the pretension: three do as a rule.
const FALSE_POSITION_STEPS: u8 = 8;

/// Steps after which a search without convergence ends. Those after the false position halve the range: 20 of them make a
/// millionth of it, where the stiffness differs by less than the tolerance.
const STEPS_MAX: u8 = FALSE_POSITION_STEPS + 20;

/// Where both ends of the range lie on one side of the demand: pretensions between them are tried if the stiffness nears the
/// demand over this part of the range, from the nearer end.
const INWARD: f32 = 1.0 / 64.0;

/// They are, too, if some tendon softens over this part of it, from the lower end: small, so that a softest point close to the
/// end is seen, and far above the rounding of f32.
const A_LITTLE: f32 = 1.0 / 4096.0;

/// Steps in which the range is tried, and how often, ever nearer to the best. They shrink to a sixteenth each time: those of
/// the last round are 5e-7 of the range, and miss the softest point by less than the tolerance.
const SCAN_STEPS: u8 = 32;
const SCAN_ROUNDS: u8 = 5;

/// A pretension inside the range that does not meet the demand is the answer if it is nearer by more than this part of the
/// demand, and only where the stiffness is steep: on a flat top none is much better than another, and rounding would choose.
const CLEAR_GAIN: f32 = 1e-2;

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
        self.bending_with(pretension, &self.tendon_stiffnesses(pretension)?)
    }

    /// The stiffness of each tendon at its own tension, N/m, at a pretension in N.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve.
    #[inline(always)]
    pub fn tendon_stiffnesses(&self, pretension: T) -> Result<[T; N], Error> {
        let tensions = self.distribution.tensions(pretension);
        let mut stiffnesses = [T::zero(); N];
        for (i, tendon) in self.tendons.iter().enumerate() {
            stiffnesses[i] = tendon.stiffness(tensions[i])?;
        }
        Ok(stiffnesses)
    }

    /// The stiffness against tilts at a pretension in N, with tendons of these stiffnesses, N/m.
    ///
    /// # Errors
    /// [`Error::Unstable`].
    #[inline(always)]
    pub fn bending_with(
        &self,
        pretension: T,
        stiffnesses_n_per_m: &[T; N],
    ) -> Result<Bending<T>, Error> {
        let mut total = self.base.plus_scaled(&self.per_pretension, pretension);
        for (i, &stiffness) in stiffnesses_n_per_m.iter().enumerate() {
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
    /// range lie on one side of the demand, and the stiffness nears it inwards or a tendon softens there, pretensions
    /// between them are tried, too; if none of them meets the demand but one is clearly nearer than the ends, it is the
    /// answer, with no bound to name.
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
        if below.encloses(&above) {
            let met = self.search(below, above, demand, axis)?;
            return Ok(met.answer(demand, None));
        }
        self.nearest(below, above, demand, axis, bounds)
    }

    /// Both ends of the range lie on one side of the demand: the nearer one is the answer unless a pretension between them
    /// meets the demand or is clearly nearer.
    #[inline(always)]
    fn nearest(
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
        let pretension = end.pretension + (other.pretension - end.pretension) * T::from(INWARD);
        let inward = Trial::new(pretension, self.stiffness_at(pretension, axis)?, demand);
        let gain = end.gain(&inward);
        let softens = end.error > T::zero() && self.softens()?;
        if !(softens || gain > T::zero() || end.encloses(&inward)) {
            return Ok(end.answer(demand, Some(limit)));
        }
        let inside = self.scan(end, other, demand, axis)?;
        let clear_gain = T::from(CLEAR_GAIN) * demand;
        let steep = softens || gain > clear_gain;
        if inside.meets(demand) || steep && end.gain(&inside) > clear_gain {
            Ok(inside.answer(demand, None))
        } else {
            Ok(end.answer(demand, Some(limit)))
        }
    }

    /// Whether some tendon is softer at a little more than the lowest pretension. The leg may then be softest anywhere
    /// between the ends, or at several pretensions: each tendon has its own tension.
    #[inline(always)]
    fn softens(&self) -> Result<bool, Error> {
        let (lowest, highest) = (
            self.distribution.pretension_min,
            self.distribution.pretension_max,
        );
        let before = self.distribution.tensions(lowest);
        let after = self
            .distribution
            .tensions(lowest + (highest - lowest) * T::from(A_LITTLE));
        for (i, tendon) in self.tendons.iter().enumerate() {
            if tendon.stiffness(after[i])? < tendon.stiffness(before[i])? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Tries pretensions from one end of the range to the other, then more of them around the nearest: one that meets the
    /// demand, or the nearest.
    #[cold]
    #[inline(never)]
    fn scan(
        &self,
        mut start: Trial<T>,
        end: Trial<T>,
        demand: T,
        axis: &BendingAxis<T>,
    ) -> Result<Trial<T>, Error> {
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
                if next.encloses(&last) {
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
        Ok(nearest)
    }

    /// Between two pretensions whose stiffnesses enclose the demand: the false position, the end that stays weighed less
    /// each time (after Anderson and Björck, 1973). It creeps where the slope jumps, as at the softest points of the tendons:
    /// then halving, which is sure to end.
    #[inline(always)]
    fn search(
        &self,
        mut kept: Trial<T>,
        mut last: Trial<T>,
        demand: T,
        axis: &BendingAxis<T>,
    ) -> Result<Trial<T>, Error> {
        for step in 0..STEPS_MAX {
            let part = if step < FALSE_POSITION_STEPS {
                last.error / (last.error - kept.error)
            } else {
                T::HALF
            };
            let pretension = last.pretension - part * (last.pretension - kept.pretension);
            let next = Trial::new(pretension, self.stiffness_at(pretension, axis)?, demand);
            if next.meets(demand) {
                return Ok(next);
            }
            if next.encloses(&last) {
                kept = last;
            } else {
                let left = T::one() - next.error / last.error;
                kept.error *= if left > T::zero() { left } else { T::HALF };
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

    /// Whether the demand is between its stiffness and another's.
    #[inline(always)]
    fn encloses(&self, other: &Self) -> bool {
        (self.error > T::zero()) != (other.error > T::zero())
    }

    /// How much nearer to the demand another one is.
    #[inline(always)]
    fn gain(&self, other: &Self) -> T {
        self.error.abs() - other.error.abs()
    }

    /// Whether its stiffness is the demanded one.
    #[inline(always)]
    fn meets(&self, demand: T) -> bool {
        self.error.abs() <= T::from(TOLERANCE) * demand
    }

    #[inline(always)]
    fn answer(&self, demand: T, limit: Option<Limit>) -> StiffnessAnswer<T> {
        StiffnessAnswer {
            pretension_n: self.pretension,
            stiffness_nm_per_rad: demand + self.error,
            limit,
        }
    }
}
