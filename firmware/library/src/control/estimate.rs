//! Where the leg is, by the lengths and tensions of its tendons, and what these show of its load.

use super::{
    Mechanism,
    bounds::{clamp_symmetric, max},
    inertia::Turn,
    load_estimate::{LoadEstimation, LoadEstimator},
};
use crate::settings::Settings;
use leg_model::{
    Direction, Elasticity, Error, Scalar, SupportKind, estimate_moment, forward_kinematics,
    forward_kinematics_universal, inverse_kinematics,
};
use nalgebra::{SVector, Vector3};

/// Farthest that the torsion goes in a cycle, rad: 4 rad/s, as that of a target.
const TORSION_CYCLE_RAD: f32 = 2e-3;

/// The least torsion stiffness of tendons by their tensions that the search for the torsion divides by, m/rad: a tenth of that of the
/// paper's rig.
const LEAST_M_PER_RAD: f32 = 1.6e-3;

/// The pose that the tendons show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate<T> {
    /// Where the leg points.
    pub direction: Direction<T>,
    /// What forward kinematics leaves over, m: a tendon that jumped or a count that was lost shows there.
    pub residual_m: T,
    /// Length of each tendon, m.
    pub lengths_m: [T; 3],
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

/// Estimates the pose, warm-started from the last estimate, and keeps the estimator of the load.
#[derive(Clone, Copy, Debug)]
pub struct Estimator<T> {
    direction: Direction<T>,
    /// What it carries.
    pub load: LoadEstimator<T>,
    /// Elastic torsion of a leg that can twist, rad.
    torsion: T,
    /// What holds it, twice: torsion stiffness of the joint, N·m/rad, and that of the tendons by their tensions, m/rad.
    torsion_nm_per_rad: T,
    torsion_m_per_rad: T,
    /// The least tension, as a sum, that is taken to hold it, N.
    taut_n: T,
}

impl<T: Scalar> Estimator<T> {
    /// Straight down, without a payload.
    pub fn new(settings: &Settings) -> Self {
        Self {
            direction: Direction::straight_down(),
            load: LoadEstimator::new(settings),
            torsion: T::zero(),
            torsion_nm_per_rad: T::from(2.0 * settings.joint.torsion_nm_per_rad),
            torsion_m_per_rad: T::from(2.0 * torsion_m_per_rad(settings)),
            taut_n: settings.f_min_n.into(),
        }
    }

    /// The last direction.
    #[inline(always)]
    pub fn direction(&self) -> &Direction<T> {
        &self.direction
    }

    /// The last elastic torsion, rad.
    #[inline(always)]
    pub fn torsion(&self) -> T {
        self.torsion
    }

    /// Starts anew, straight down, without a load.
    pub fn straight_down(&mut self) {
        self.direction = Direction::straight_down();
        self.torsion = T::zero();
        self.load.forget();
    }

    /// The load beyond the leg's own weight at the last direction, as a horizontal moment (x, y), N·m.
    pub fn excess_nm(&self, mechanism: &Mechanism<T>) -> [T; 2] {
        self.load
            .estimate()
            .moment(&self.direction, mechanism.payload_lever)
    }

    /// Estimates the pose, and leaves what the tendons show for the next step of the load, or takes it now, as `load_estimation` says.
    /// `target_torsion`, rad, is the elastic one of a leg whose tendons are slack; taut ones show it by themselves.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; what forward kinematics refuses, but for slack tendons that show no pose.
    #[inline(always)]
    pub fn update(
        &mut self,
        mechanism: &Mechanism<T>,
        unstretched_m: &[T; 3],
        tensions_n: &[T; 3],
        target_torsion: T,
        load_estimation: LoadEstimation,
    ) -> Result<Estimate<T>, Error> {
        self.load.keep();
        let (mut lengths, mut pull) = (SVector::<T, 3>::zeros(), SVector::<T, 3>::zeros());
        let mut elongations_m = [T::zero(); 3];
        for (i, tendon) in mechanism.tendons.iter().enumerate() {
            // A slack tendon is as long as it is; noise does not make it push.
            pull[i] = max(tensions_n[i], T::zero());
            elongations_m[i] = tendon.elongation(pull[i])?;
            lengths[i] = unstretched_m[i] + elongations_m[i];
        }
        let slack = load_estimation == LoadEstimation::Slack;
        if slack {
            self.torsion = target_torsion;
        }
        let torsion = self.torsion;
        let mut twisted = None;
        let found = if mechanism.support.kind() == SupportKind::Universal {
            forward_kinematics_universal(mechanism.rig.geometry(), &lengths, &self.direction)
        } else {
            let geometry = mechanism.geometry(&self.direction, torsion, &mut twisted);
            forward_kinematics(geometry, &lengths, &self.direction)
        };
        let found = match found {
            // Tendons that are longer than any pose makes them show none, where their anchors are narrow: the last one stays until they pull, and nothing is
            // compared with it.
            Err(Error::NotConverged | Error::Singular) if slack => {
                return Ok(Estimate {
                    direction: self.direction,
                    residual_m: T::zero(),
                    lengths_m: lengths.into(),
                    length_error: None,
                });
            }
            found => found?,
        };
        self.direction = found.direction;
        let mut length_error = None;
        if !slack {
            let geometry = mechanism.geometry(&found.direction, torsion, &mut twisted);
            let kinematics = inverse_kinematics(geometry, &found.direction)?;
            length_error = Some(LengthError {
                // At what forward kinematics found all three errors have one sign.
                mean_m: (lengths - kinematics.lengths).sum() * T::from(1.0 / 3.0),
                elongations_m,
            });
            let twists = mechanism.support.twists();
            if twists || load_estimation != LoadEstimation::Frozen {
                let tendons = estimate_moment(&kinematics.moment_map, &pull);
                let load = tendons - mechanism.support.joint_moment(&found.direction, torsion);
                if twists {
                    self.update_torsion(&load, &pull);
                }
                self.load
                    .take(mechanism, &found.direction, &load, load_estimation);
            }
        }
        Ok(Estimate {
            direction: found.direction,
            residual_m: found.residual_m,
            lengths_m: lengths.into(),
            length_error,
        })
    }

    /// A step of the load of a leg that shall point and turn so.
    #[inline(always)]
    pub fn step_load(&mut self, mechanism: &Mechanism<T>, target: &Direction<T>, turn: &Turn<T>) {
        self.load.step(mechanism, &self.direction, target, turn);
    }

    /// One step of the search for the torsion at which the load, N·m, has no moment about the leg: weights and pushes act on
    /// its axis. Half a step, for the stiffness is that of a leg that hangs.
    #[inline(always)]
    fn update_torsion(&mut self, load: &Vector3<T>, pull: &SVector<T, 3>) {
        let stiffness =
            self.torsion_nm_per_rad + self.torsion_m_per_rad * max(pull.sum(), self.taut_n);
        let step = load.dot(&self.direction.vector()) / stiffness;
        self.torsion += clamp_symmetric(step, T::from(TORSION_CYCLE_RAD));
    }
}

/// Moment about a leg that hangs straight down, by tension and torsion, m/rad: b·s/l of the anchors of a tendon, as a mean.
fn torsion_m_per_rad(settings: &Settings) -> f32 {
    let rig = &settings.rig;
    let height = rig.upper_length_m + rig.joint_length_m;
    let mut sum = 0.0;
    for ([base_x, base_y], [leg_x, leg_y]) in rig.base_anchors_m.iter().zip(&rig.leg_anchors_m) {
        let (x, y) = (base_x - leg_x, base_y - leg_y);
        let square = x * x + y * y + height * height;
        sum += (base_x * leg_x + base_y * leg_y) / Scalar::sqrt(square);
    }
    // Anchors that cross hold no torsion: the search takes small steps then.
    (sum * (1.0 / 3.0)).max(LEAST_M_PER_RAD)
}

#[cfg(test)]
mod tests;
