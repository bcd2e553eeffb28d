//! The lengths that put the loaded leg on its target.

use super::{
    CYCLE_S, LoadEstimate, Mechanism,
    bounds::{clamp_symmetric, max, min},
    inertia::Turn,
    tendon_damping::TendonDamping,
};
use crate::settings::Settings;
use leg_model::{
    Direction, Distribution, Elasticity, Error, FreePlane, HalfTangent, Kinematics, Scalar,
    distribute, inverse_kinematics,
};
use nalgebra::Vector3;

/// An error of the pretension that is not trimmed, N. The motors leave the dead band and a part of the play: on the paper's rig 0.04 N;
/// summed up, that has a leg that keeps station correct to and fro once a second.
const TRIM_LEAST_N: f32 = 0.1;

/// A target is on its way where its pretension differs by more than this part from the one at which a stiffness is searched for, or from the one that
/// is asked for: its tendons are about as much softer or stiffer.
pub(super) const ON_ITS_WAY_PART: f32 = 0.05;

/// What the tendons shall do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target<T> {
    /// Where the leg shall point.
    pub direction: Direction<T>,
    /// Its elastic torsion there, rad.
    pub torsion: T,
    /// Lengths and moments of the tendons there.
    pub kinematics: Kinematics<T, 3>,
    /// The tensions that balance the load there.
    pub distribution: Distribution<T, 3>,
    /// Pretension on its way to the one that is asked for, N.
    pub pretension_n: T,
    /// The tensions at that pretension, N.
    pub tensions_n: [T; 3],
    /// The lengths without tension that give these tensions there, m.
    pub unstretched_m: [T; 3],
    /// Whether the bounds on the tensions, or the limit of the trim, hold the pretension back.
    pub limited: bool,
}

impl<T: Scalar> Target<T> {
    /// Whether the pretension is still on its way up to a wish, N, as far as the bounds allow that.
    #[inline(always)]
    pub fn is_below_pretension(&self, wish_n: T) -> bool {
        let allowed_n = min(
            max(wish_n, self.distribution.pretension_min),
            self.distribution.pretension_max,
        );
        let below = allowed_n - self.pretension_n > T::from(ON_ITS_WAY_PART) * allowed_n;
        below && self.distribution.feasible()
    }

    /// Whether the maximum tension holds the pretension below a wish, N.
    #[inline(always)]
    pub fn is_capped_below(&self, wish_n: T) -> bool {
        wish_n > self.pretension_n && self.pretension_n >= self.distribution.pretension_max
    }

    /// Whether the bounds leave a range of pretensions that the noise of the load does not close.
    #[inline(always)]
    pub fn has_room(&self) -> bool {
        self.distribution.pretension_max - self.distribution.pretension_min > T::one()
    }
}

/// Computes targets, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct TargetGenerator<T> {
    /// None before the first target.
    pretension_n: Option<T>,
    pretension_step_n: T,
    trim_n: T,
    trim_gain: T,
    trim_max_n: T,
    /// Part of the load that is held, 0 to 1, and how much that changes in a cycle.
    share: T,
    share_step: T,
    torsion: Torsion<T>,
    damping: TendonDamping<T>,
    /// Whether a target may take some of the last newtons below the maximum tension.
    may_take_last_newtons: bool,
}

/// What a target is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetDemand<'a, T> {
    /// The pose.
    pub q: HalfTangent<T>,
    /// The load beyond the leg's own weight.
    pub load: LoadEstimate<T>,
    /// How the leg turns there.
    pub turn: &'a Turn<T>,
    /// The payload whose inertia is moved, kg.
    pub payload_kg: T,
    /// Whether the weights shall be held, or left out.
    pub compensated: bool,
    /// Whether the pretension is trimmed by the measured tensions: not before every tendon pulls.
    pub trimmed: bool,
    /// The pretension, N.
    pub pretension_n: T,
}

impl<T: Scalar> TargetGenerator<T> {
    /// Before the first target.
    pub fn new(settings: &Settings) -> Self {
        Self {
            pretension_n: None,
            pretension_step_n: T::from(settings.motion.pretension_rate_n_per_s * CYCLE_S),
            trim_n: T::zero(),
            trim_gain: T::from(CYCLE_S / settings.estimation.trim_time_s),
            trim_max_n: settings.estimation.trim_max_n.into(),
            share: T::zero(),
            share_step: T::from(CYCLE_S / settings.motion.load_time_s),
            torsion: Torsion::new(),
            damping: TendonDamping::new(settings),
            may_take_last_newtons: false,
        }
    }

    /// Starts anew from the pretension that the tensions have at the first target, with the load held or left out.
    pub fn start(&mut self, compensated: bool) {
        self.pretension_n = None;
        self.may_take_last_newtons = false;
        self.trim_n = T::zero();
        self.damping.rest();
        self.share = if compensated { T::one() } else { T::zero() };
    }

    /// Has the first target this torsion, rad: that of a leg whose tendons pull.
    pub fn start_twisted(&mut self, torsion: T) {
        self.torsion.start_at(torsion);
    }

    /// Has the first target this pretension, N, whatever the tensions show.
    pub fn start_at(&mut self, pretension_n: T) {
        self.pretension_n = Some(pretension_n);
    }

    /// The torsion that the last target has, rad.
    #[inline(always)]
    pub fn torsion(&self) -> T {
        self.torsion.angle
    }

    /// By how much each tendon is longer than its tension stretches it, m: it has not followed that yet.
    #[inline(always)]
    pub fn damped_m(&self) -> &[T; 3] {
        self.damping.damped_m()
    }

    /// Has targets take up to three quarters of the last newtons below the maximum tension where they need them, or not.
    pub fn take_last_newtons(&mut self, may: bool) {
        self.may_take_last_newtons = may;
    }

    /// A leg at rest: nothing is damped.
    pub fn rest(&mut self) {
        self.damping.rest();
    }

    /// Takes the stiffnesses of the tendons from now on, N/m.
    #[inline(always)]
    pub fn set_stiffnesses(&mut self, stiffnesses_n_per_m: &[T; 3]) {
        self.damping.set_stiffnesses(stiffnesses_n_per_m);
    }

    /// Takes the stiffnesses that the tendons have at these tensions, N, from now on.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve.
    #[inline(always)]
    pub fn set_stiffnesses_at(
        &mut self,
        mechanism: &Mechanism<T>,
        tensions_n: &[T; 3],
    ) -> Result<(), Error> {
        let mut stiffnesses_n_per_m = *tensions_n;
        for (stiffness, tendon) in stiffnesses_n_per_m.iter_mut().zip(&mechanism.tendons) {
            *stiffness = tendon.stiffness(*stiffness)?;
        }
        self.set_stiffnesses(&stiffnesses_n_per_m);
        Ok(())
    }

    /// The next target; `measured_n` are the tensions now.
    ///
    /// # Errors
    /// [`Error::Infeasible`] if no pretension keeps the bounds; what kinematics and distribution refuse; a tension beyond a
    /// tendon's curve.
    #[inline(always)]
    pub fn next(
        &mut self,
        mechanism: &Mechanism<T>,
        demand: &TargetDemand<'_, T>,
        measured_n: &[T; 3],
    ) -> Result<Target<T>, Error> {
        let direction = demand.q.direction();
        let torsion = self.torsion.angle;
        let kinematics = inverse_kinematics(
            mechanism.geometry(&direction, torsion, &mut None),
            &direction,
        )?;
        let plane = mechanism.support.plane(&direction);
        let mut moment = mechanism.support.joint_moment(&direction, torsion);
        let [x, y] = demand.load.moment(&direction, mechanism.payload_lever);
        let load = mechanism.leg.moment(&direction) + Vector3::new(x, y, T::zero());
        moment += load * self.step_share(demand.compensated);
        let held = moment;
        moment -= demand.turn.acceleration * mechanism.inertia(demand.payload_kg);
        moment -= demand.turn.damping;
        let distribution = distribute(&kinematics.moment_map, &plane, &moment, &mechanism.bounds)?;
        let feasible = distribution.feasible();
        let mut range_n = [distribution.pretension_min, distribution.pretension_max];
        if !feasible {
            let may = self.may_take_last_newtons;
            let most_n = if may {
                last_newtons(mechanism, &distribution)
            } else {
                range_n[1]
            };
            // A motion may take more for a moment, which one tendon then lacks. The pose itself has to be held.
            let whole = most_n >= range_n[0];
            if !whole && !holds(mechanism, &kinematics, &plane, &held, may)? {
                return Err(Error::Infeasible);
            }
            range_n = [most_n; 2];
        }
        let measured_pretension_n = || pretension(&distribution, measured_n);
        let start_n = self.pretension_n.unwrap_or_else(measured_pretension_n);
        let (pretension_n, limited) = self.next_pretension(start_n, demand.pretension_n, range_n);
        self.pretension_n = Some(pretension_n);
        let tensions = distribution.tensions(pretension_n);
        if mechanism.support.twists() {
            let third = (kinematics.moment_map * tensions + moment).dot(&plane.normal());
            self.torsion.step(third);
        }
        // Otherwise it stays: what is dropped at once moves the tendons at once.
        if demand.trimmed {
            self.trim(pretension_n - measured_pretension_n());
        }
        let stretched = distribution.tensions(pretension_n + self.trim_n);
        let mut unstretched_m = <[T; 3]>::from(kinematics.lengths);
        let mut tensions_n = [T::zero(); 3];
        let mut elongations_m = [T::zero(); 3];
        for (i, tendon) in mechanism.tendons.iter().enumerate() {
            tensions_n[i] = tensions[i];
            elongations_m[i] = tendon.elongation(stretched[i])?;
        }
        let damped = self.damping.step(&elongations_m);
        for (unstretched, &elongation) in unstretched_m.iter_mut().zip(damped) {
            *unstretched -= elongation;
        }
        Ok(Target {
            direction,
            torsion,
            kinematics,
            distribution,
            pretension_n,
            tensions_n,
            unstretched_m,
            limited: limited
                || !feasible
                || (demand.trimmed && !(self.trim_n.abs() < self.trim_max_n)),
        })
    }

    /// Moves the part of the load that is held, and gives it smoothed, so that the leg does not swing.
    #[inline(always)]
    fn step_share(&mut self, compensated: bool) -> T {
        let wanted = if compensated { T::one() } else { T::zero() };
        let share = self.share + clamp_symmetric(wanted - self.share, self.share_step);
        self.share = share;
        share * share * (T::from(3.0) - T::TWO * share)
    }

    /// The pretension a step nearer to the demand, inside what the bounds allow, and whether they hold it back.
    #[inline(always)]
    fn next_pretension(&self, pretension_n: T, wish_n: T, [lowest, highest]: [T; 2]) -> (T, bool) {
        let allowed = min(max(wish_n, lowest), highest);
        let step = clamp_symmetric(allowed - pretension_n, self.pretension_step_n);
        // The pose may narrow the range faster than the pretension follows.
        let next_n = min(max(pretension_n + step, lowest), highest);
        (next_n, allowed != wish_n)
    }

    /// Changes what is added to the pretension so that the measured one becomes it: for what the curves leave out.
    #[inline(always)]
    fn trim(&mut self, error: T) {
        let missing = if error.abs() > T::from(TRIM_LEAST_N) {
            error
        } else {
            T::zero()
        };
        self.trim_n = clamp_symmetric(self.trim_n + self.trim_gain * missing, self.trim_max_n);
    }
}

/// Whether some tensions inside the bounds hold a moment, or some that may take a part of the last newtons.
#[cold]
fn holds<T: Scalar>(
    mechanism: &Mechanism<T>,
    kinematics: &Kinematics<T, 3>,
    plane: &FreePlane<T>,
    moment: &Vector3<T>,
    may_take_last_newtons: bool,
) -> Result<bool, Error> {
    let distribution = distribute(&kinematics.moment_map, plane, moment, &mechanism.bounds)?;
    let whole = || last_newtons(mechanism, &distribution) >= distribution.pretension_min;
    Ok(distribution.feasible() || may_take_last_newtons && whole())
}

/// The pretension of tensions that the bounds do not allow, N: the lowest at which no tendon pulls by less than the minimum, or as much of it as three quarters of
/// the last newtons below the maximum allow.
#[cold]
fn last_newtons<T: Scalar>(mechanism: &Mechanism<T>, distribution: &Distribution<T, 3>) -> T {
    let lowest_n = distribution.pretension_min;
    let tensions_n = distribution.tensions(lowest_n);
    let mut most_n = lowest_n;
    for (&tension_n, &part) in tensions_n.iter().zip(&distribution.per_pretension) {
        let beyond_n = tension_n - mechanism.holding_max_n;
        if beyond_n > T::zero() {
            most_n = min(most_n, lowest_n - beyond_n / part);
        }
    }
    max(most_n, distribution.pretension_max)
}

/// The pretension that tensions have.
#[inline(always)]
fn pretension<T: Scalar>(distribution: &Distribution<T, 3>, tensions_n: &[T; 3]) -> T {
    let mut sum = T::SUM_START;
    for (i, &tension) in tensions_n.iter().enumerate() {
        sum += distribution.per_pretension[i] * tension;
    }
    // The squares of the tensions per pretension add up to three.
    sum * T::from(1.0 / 3.0)
}

/// The elastic torsion, found by one step of the secant method a cycle.
#[derive(Clone, Copy, Debug)]
struct Torsion<T> {
    angle: T,
    last_angle: T,
    last_moment: T,
    /// Stiffness about the third axis, N·m/rad.
    slope: T,
}

impl<T: Scalar> Torsion<T> {
    fn new() -> Self {
        Self {
            angle: T::zero(),
            last_angle: -T::TORSION_START_RAD,
            last_moment: T::zero(),
            slope: -T::one(),
        }
    }

    /// Starts anew from an angle, with the slope that is known.
    fn start_at(&mut self, angle: T) {
        (self.angle, self.last_angle) = (angle, angle);
    }

    /// Takes the moment about the third axis at the present angle, N·m.
    #[inline(always)]
    fn step(&mut self, moment: T) {
        let turned = self.angle - self.last_angle;
        let slope = (moment - self.last_moment) / turned;
        // Over less than 1e-4 rad the difference of two moments is rounding. A stable leg has a negative slope; the softest, a
        // ball joint at 10 N, has −0.5 N·m/rad, so one above −0.01 is an artefact.
        if turned.abs() > T::from(1e-4) && slope < -T::from(1e-2) {
            self.slope = slope;
        }
        (self.last_angle, self.last_moment) = (self.angle, moment);
        // No more than 2 mrad a cycle, 4 rad/s: faster than any trajectory twists the leg, slow enough for its slope.
        self.angle -= clamp_symmetric(moment / self.slope, T::from(2e-3));
    }
}

#[cfg(test)]
mod tests;
