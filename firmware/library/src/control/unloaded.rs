//! Where a leg would point, and its pretension, without weight and payload.

use super::{
    Mechanism,
    bounds::{max, min},
};
use leg_model::{
    Direction, Elasticity, Error, Scalar, SupportKind, distribute, forward_kinematics,
    forward_kinematics_universal, inverse_kinematics,
};
use nalgebra::SVector;

/// Steps of the search. It is Newton's: the error is squared in each step, but for the first two, where the tendons' curves
/// make the steps too short.
const STEPS: u8 = 4;

/// The search for the pose and the pretension at which a leg without weight and payload would have the unstretched lengths that
/// its tendons have. With compensation off, the target of that pose has these lengths, so that a leg that begins there does not
/// move. One that began where it points would sag by its weights once more. The load cells give the start of the search, not its
/// result.
#[derive(Clone, Copy, Debug)]
pub struct Unloaded<T> {
    direction: Direction<T>,
    pretension_n: T,
    steps_left: u8,
}

impl<T: Scalar> Unloaded<T> {
    /// A search that starts where the leg points, with its mean tension, N.
    pub fn search(loaded: &Direction<T>, tensions_n: &[T; 3]) -> Self {
        let [a, b, c] = *tensions_n;
        Self {
            direction: *loaded,
            pretension_n: (a + b + c) * T::from(1.0 / 3.0),
            steps_left: STEPS,
        }
    }

    /// Where it points.
    pub fn direction(&self) -> &Direction<T> {
        &self.direction
    }

    /// Its pretension, N, within the bounds of the tensions.
    pub fn pretension_n(&self) -> T {
        self.pretension_n
    }

    /// A step by the unstretched lengths, m, at an elastic torsion, rad: true if it was the last.
    ///
    /// # Errors
    /// What kinematics and distribution refuse; a tension beyond a tendon's curve.
    #[inline(never)]
    pub fn step(
        &mut self,
        mechanism: &Mechanism<T>,
        unstretched_m: &[T; 3],
        torsion: T,
    ) -> Result<bool, Error> {
        let direction = &self.direction;
        let mut twisted = None;
        let geometry = mechanism.geometry(direction, torsion, &mut twisted);
        let kinematics = inverse_kinematics(geometry, direction)?;
        let plane = mechanism.support.plane(direction);
        let moment = mechanism.support.joint_moment(direction, torsion);
        let distribution = distribute(&kinematics.moment_map, &plane, &moment, &mechanism.bounds)?;
        let (lowest, highest) = (distribution.pretension_min, distribution.pretension_max);
        let pretension_n = min(max(self.pretension_n, lowest), highest);
        let tensions = distribution.tensions(pretension_n);
        let (mut lengths, mut per_n) = (SVector::<T, 3>::zeros(), SVector::<T, 3>::zeros());
        // The tensions per pretension do no work at the joint: no tilt changes the lengths along them. What is missing along them
        // is due to the pretension.
        let (mut along_m, mut along_m_per_n) = (T::SUM_START, T::SUM_START);
        for (i, tendon) in mechanism.tendons.iter().enumerate() {
            let part = distribution.per_pretension[i];
            lengths[i] = unstretched_m[i] + tendon.elongation(tensions[i])?;
            per_n[i] = part / tendon.stiffness(tensions[i])?;
            along_m += part * (lengths[i] - kinematics.lengths[i]);
            along_m_per_n += part * per_n[i];
        }
        let next_n = min(max(pretension_n - along_m / along_m_per_n, lowest), highest);
        lengths += per_n * (next_n - pretension_n);
        let found = if mechanism.support.kind() == SupportKind::Universal {
            forward_kinematics_universal(mechanism.rig.geometry(), &lengths, direction)?
        } else {
            forward_kinematics(geometry, &lengths, direction)?
        };
        (self.direction, self.pretension_n) = (found.direction, next_n);
        self.steps_left = self.steps_left.saturating_sub(1);
        Ok(self.steps_left == 0)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{STEPS, Unloaded};
    use crate::control::Mechanism;
    use crate::settings::Settings;
    use leg_model::{Direction, Elasticity, SupportKind, distribute, inverse_kinematics};

    /// Every kind of support, leaning far, with a sag of up to 3° and a third of the tension more or less.
    #[test]
    fn the_pose_without_its_weights_is_found() {
        for support in [
            SupportKind::TorsionFree,
            SupportKind::Universal,
            SupportKind::Spherical,
            SupportKind::ElasticUniversal,
        ] {
            let mut settings = Settings {
                support,
                ..Settings::table_1().unwrap()
            };
            if support == SupportKind::ElasticUniversal {
                settings.joint.torsion_nm_per_rad = 40.0;
            }
            let mechanism = Mechanism::<f64>::new(&settings).unwrap();
            for (x, y) in [(0.0, 0.0), (0.2, -0.1), (-0.3, 0.35), (0.45, 0.1)] {
                let unloaded = Direction::from_xy(x, y).unwrap();
                let mut twisted = None;
                let geometry = mechanism.geometry(&unloaded, 0.0, &mut twisted);
                let kinematics = inverse_kinematics(geometry, &unloaded).unwrap();
                let plane = mechanism.support.plane(&unloaded);
                let moment = mechanism.support.joint_moment(&unloaded, 0.0);
                let distribution =
                    distribute(&kinematics.moment_map, &plane, &moment, &mechanism.bounds).unwrap();
                for pretension_n in [25.0, 70.0] {
                    let tensions_n = distribution.tensions(pretension_n);
                    let unstretched_m = [0, 1, 2].map(|i| {
                        let tendon = &mechanism.tendons[i];
                        kinematics.lengths[i] - tendon.elongation(tensions_n[i]).unwrap()
                    });
                    for (off, part) in [(0.05, 1.3), (-0.05, 0.7), (0.02, 1.1)] {
                        let loaded = Direction::from_xy(x + off, y - off).unwrap();
                        let shown_n = [part * pretension_n; 3];
                        let mut search = Unloaded::search(&loaded, &shown_n);
                        for step in 1..=STEPS {
                            let last = search.step(&mechanism, &unstretched_m, 0.0).unwrap();
                            assert_eq!(last, step == STEPS);
                        }
                        let off = (search.direction().vector() - unloaded.vector()).norm();
                        let off_n = search.pretension_n() - pretension_n;
                        assert!(
                            off < 1e-5 && off_n.abs() < 0.01,
                            "{support:?} ({x}, {y}), {pretension_n} N: {off:e}, {off_n:e} N"
                        );
                    }
                }
            }
        }
    }
}
