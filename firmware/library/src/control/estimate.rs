//! Where the leg is and what it carries, by the lengths and tensions of its tendons.

use super::{CYCLE_S, Mechanism, bounds::max, filter::LowPass};
use crate::settings::Settings;
use leg_model::{
    Direction, Elasticity, Error, Scalar, SupportKind, estimate_moment, forward_kinematics,
    forward_kinematics_universal, inverse_kinematics,
};
use nalgebra::{SVector, Vector3};

/// The pose that the tendons show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate<T> {
    /// Where the leg points.
    pub direction: Direction<T>,
    /// What forward kinematics leaves over, m: a tendon that jumped or a count that was lost shows there.
    pub residual_m: T,
    /// The same with its sign, for the watch over time; none while the tendons are not taut.
    pub length_error: Option<LengthError<T>>,
}

/// What the estimate of the pose leaves over, with its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthError<T> {
    /// Mean of measured lengths less those of the pose, m.
    pub mean_m: T,
    /// Elongation of each tendon by its load cell, m.
    pub elongations_m: [T; 3],
}

/// How the load is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadEstimation {
    /// It stays as it is: the tendons are not taut yet.
    Slack,
    /// It stays as it is.
    Frozen,
    /// It follows the tensions, filtered.
    Filtered,
    /// It is what the tensions show now, unfiltered.
    Immediate,
}

/// Estimates pose and load, warm-started from the last estimate.
#[derive(Clone, Copy, Debug)]
pub struct Estimator<T> {
    direction: Direction<T>,
    /// Moment beyond that of the leg's own weight, as a horizontal one (x, y) of the same effect, N·m.
    excess: [[LowPass<T>; 2]; 2],
    payload_kg: T,
    /// Square of the sine of the tilt from which the payload is estimated.
    payload_sine_squared: T,
}

impl<T: Scalar> Estimator<T> {
    /// Straight down, without a payload.
    pub fn new(settings: &Settings) -> Self {
        let estimation = &settings.estimation;
        let filter = LowPass::new(estimation.load_time_s, CYCLE_S);
        let sine = T::from(estimation.payload_sine);
        Self {
            direction: Direction::down(),
            excess: [[filter; 2]; 2],
            payload_kg: T::zero(),
            payload_sine_squared: sine * sine,
        }
    }

    /// The last direction.
    #[inline(always)]
    pub fn direction(&self) -> &Direction<T> {
        &self.direction
    }

    /// Starts anew, straight down, without a load.
    pub fn straight_down(&mut self) {
        self.direction = Direction::down();
        self.payload_kg = T::zero();
        for filter in self.excess.iter_mut().flatten() {
            filter.set(T::zero());
        }
    }

    /// The load beyond the leg's own weight, as a horizontal moment (x, y), N·m.
    #[inline(always)]
    pub fn excess_nm(&self) -> [T; 2] {
        self.excess.map(|[_, second]| second.value())
    }

    /// The payload that such a load would be, kg.
    #[inline(always)]
    pub fn payload_kg(&self) -> T {
        self.payload_kg
    }

    /// Estimates the pose and, as `load_estimation` says, the load. `torsion` is the elastic one, rad.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; what forward kinematics refuses.
    #[inline(always)]
    pub fn update(
        &mut self,
        mechanism: &Mechanism<T>,
        unstretched_m: &[T; 3],
        tensions_n: &[T; 3],
        torsion: T,
        load_estimation: LoadEstimation,
    ) -> Result<Estimate<T>, Error> {
        let (mut lengths, mut pull) = (SVector::<T, 3>::zeros(), SVector::<T, 3>::zeros());
        let mut elongations_m = [T::zero(); 3];
        for (i, tendon) in mechanism.tendons.iter().enumerate() {
            // A slack tendon is as long as it is; noise does not make it push.
            pull[i] = max(tensions_n[i], T::zero());
            elongations_m[i] = tendon.elongation(pull[i])?;
            lengths[i] = unstretched_m[i] + elongations_m[i];
        }
        let mut twisted = None;
        let found = if mechanism.support.kind() == SupportKind::Universal {
            forward_kinematics_universal(mechanism.rig.geometry(), &lengths, &self.direction)?
        } else {
            let geometry = mechanism.geometry(&self.direction, torsion, &mut twisted);
            forward_kinematics(geometry, &lengths, &self.direction)?
        };
        self.direction = found.direction;
        let mut length_error = None;
        if load_estimation != LoadEstimation::Slack {
            let geometry = mechanism.geometry(&found.direction, torsion, &mut twisted);
            let kinematics = inverse_kinematics(geometry, &found.direction)?;
            length_error = Some(LengthError {
                // At what forward kinematics found all three errors have one sign.
                mean_m: (lengths - kinematics.lengths).sum() * T::from(1.0 / 3.0),
                elongations_m,
            });
            if load_estimation != LoadEstimation::Frozen {
                let tendons = estimate_moment(&kinematics.moment_map, &pull);
                self.update_load(mechanism, &tendons, torsion, load_estimation);
            }
        }
        Ok(Estimate {
            direction: found.direction,
            residual_m: found.residual_m,
            length_error,
        })
    }

    /// By the moment against that of the tendons, N·m.
    #[inline(always)]
    fn update_load(
        &mut self,
        mechanism: &Mechanism<T>,
        against: &Vector3<T>,
        torsion: T,
        load_estimation: LoadEstimation,
    ) {
        let (direction, support) = (&self.direction, &mechanism.support);
        let load = against - support.joint_moment(direction, torsion);
        let [x, y] = support.plane(direction).project(&load);
        let own = mechanism.leg.moment(direction);
        let excess = [x - own.x, y - own.y];
        for ([first, second], input) in self.excess.iter_mut().zip(excess) {
            if load_estimation == LoadEstimation::Immediate {
                first.set(input);
                second.set(input);
            }
            second.step(first.step(input));
        }
        self.update_payload(mechanism);
    }

    /// A weight at the tip turns the leg about (−p_y, p_x), the more the further it leans.
    #[inline(always)]
    fn update_payload(&mut self, mechanism: &Mechanism<T>) {
        let down = self.direction.vector();
        let sine_squared = down.x * down.x + down.y * down.y;
        let lever = sine_squared * mechanism.payload_lever;
        if sine_squared > self.payload_sine_squared && lever > T::zero() {
            let [x, y] = self.excess_nm();
            self.payload_kg = max((down.x * y - down.y * x) / lever, T::zero());
        }
    }
}

#[cfg(test)]
mod tests;
