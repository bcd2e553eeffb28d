//! Where the leg is and what it carries, by the lengths and tensions of its tendons.

use super::{
    CYCLE_S, Mechanism,
    bounds::{clamp_symmetric, max},
    filter::LowPass,
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
    /// Elastic torsion of a leg that can twist, rad.
    torsion: T,
    /// What holds it, twice: torsion stiffness of the joint, N·m/rad, and that of the tendons by their tensions, m/rad.
    torsion_nm_per_rad: T,
    torsion_m_per_rad: T,
    /// The least tension, as a sum, that is taken to hold it, N.
    taut_n: T,
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
            torsion: T::zero(),
            torsion_nm_per_rad: T::from(2.0 * settings.joint.torsion_nm_per_rad),
            torsion_m_per_rad: T::from(2.0 * torsion_m_per_rad(settings)),
            taut_n: settings.f_min_n.into(),
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

    /// Estimates the pose and, as `load_estimation` says, the load. `target_torsion`, rad, is the elastic one of a leg whose
    /// tendons are slack; taut ones show it by themselves.
    ///
    /// # Errors
    /// A tension beyond a tendon's curve; what forward kinematics refuses.
    #[inline(always)]
    pub fn update(
        &mut self,
        mechanism: &Mechanism<T>,
        unstretched_m: &[T; 3],
        tensions_n: &[T; 3],
        target_torsion: T,
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
        let slack = load_estimation == LoadEstimation::Slack;
        if slack {
            self.torsion = target_torsion;
        }
        let torsion = self.torsion;
        let mut twisted = None;
        let found = if mechanism.support.kind() == SupportKind::Universal {
            forward_kinematics_universal(mechanism.rig.geometry(), &lengths, &self.direction)?
        } else {
            let geometry = mechanism.geometry(&self.direction, torsion, &mut twisted);
            forward_kinematics(geometry, &lengths, &self.direction)?
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
                if load_estimation != LoadEstimation::Frozen {
                    self.update_load(mechanism, &load, load_estimation);
                }
            }
        }
        Ok(Estimate {
            direction: found.direction,
            residual_m: found.residual_m,
            length_error,
        })
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

    /// By the load, N·m.
    #[inline(always)]
    fn update_load(
        &mut self,
        mechanism: &Mechanism<T>,
        load: &Vector3<T>,
        load_estimation: LoadEstimation,
    ) {
        let (direction, support) = (&self.direction, &mechanism.support);
        let [x, y] = support.plane(direction).project(load);
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
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Estimator, LoadEstimation, Mechanism};
    use crate::settings::Settings;
    use leg_model::nalgebra::Vector3;
    use leg_model::{Direction, Elasticity, SupportKind, inverse_kinematics};

    /// A push across the way to which a leg on a ball joint leans twists it: tensions without a moment about the leg.
    #[test]
    fn a_push_that_twists_a_leg_moves_neither_the_pose_nor_the_length_error() {
        let mut settings = Settings::for_table_1().unwrap();
        settings.support = SupportKind::Spherical;
        let mechanism = Mechanism::<f64>::new(&settings).unwrap();
        for (x, y, torsion) in [(0.3, 0.1, 0.02), (-0.1, 0.45, -0.03)] {
            let direction = Direction::from_xy(x, y).unwrap();
            let mut twisted = None;
            let geometry = mechanism.geometry(&direction, torsion, &mut twisted);
            let kinematics = inverse_kinematics(geometry, &direction).unwrap();
            let turning = kinematics.moment_map.transpose() * direction.vector();
            let even = Vector3::repeat(70.0);
            let tensions = even - turning * (turning.dot(&even) / turning.dot(&turning));
            assert!(tensions.min() > 5.0, "{tensions}");
            let unstretched_m = [0, 1, 2].map(|i| {
                kinematics.lengths[i] - mechanism.tendons[i].elongation(tensions[i]).unwrap()
            });
            let mut estimator = Estimator::new(&settings);
            estimator.direction = direction;
            let mut estimate = None;
            for _ in 0..200 {
                let (tensions, load) = (tensions.into(), LoadEstimation::Filtered);
                let found = estimator.update(&mechanism, &unstretched_m, &tensions, 0.0, load);
                estimate = Some(found.unwrap());
            }
            let estimate = estimate.unwrap();
            let off = estimate.direction.vector() - direction.vector();
            let off = off.dot(&off);
            assert!(
                (estimator.torsion - torsion).abs() < 1e-6,
                "{}",
                estimator.torsion
            );
            assert!(
                off < 1e-14 && estimate.residual_m < 1e-8,
                "{off} {estimate:?}"
            );
            assert!(estimate.length_error.unwrap().mean_m.abs() < 1e-8);
        }
    }
}
