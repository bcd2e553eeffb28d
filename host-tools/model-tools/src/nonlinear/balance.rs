//! Energy, moment and stiffness of a mechanism whose tendons have fixed lengths without tension.

use leg_model::{
    Direction, Elasticity, Error, FreePlane, Geometry, Kinematics, Load, Rig, Support, Tendon,
    Twist, inverse_kinematics, solve3, structural_stiffness, tendon_stiffness, tip_displacement,
};
use nalgebra::{Matrix3, SVector, Vector3};

/// Damping of a step beside the stiffness: none first, then ever more until the step leads down.
const DAMPING: [f64; 12] = [
    0.0, 1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7,
];

/// Energies that differ by less than this part of their terms are equal but for rounding.
const ENERGY_ROUNDING: f64 = 1e-14;

/// Steps after which a search without convergence ends.
const STEPS_MAX: u32 = 100;

/// The search has converged when a step is not longer than this, rad: a hundred times its rounding.
const STEP_RAD: f64 = 1e-13;

/// Where the leg is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture {
    /// Where it points.
    pub direction: Direction<f64>,
    /// Its torsion beyond that which the joint itself gives it, rad; zero on a support that blocks it.
    pub torsion: f64,
}

/// A mechanism with weights, on tendons that pull as far as they are stretched.
#[derive(Clone, Copy, Debug)]
pub struct Balance {
    rig: Rig<f64, 3>,
    load: Load<f64>,
    support: Support<f64>,
    tendons: [Tendon<f64>; 3],
    unstretched_m: SVector<f64, 3>,
    /// A force at the tip beside the weights, N.
    push_n: Vector3<f64>,
}

/// What the mechanism does at a posture.
struct PostureResponse {
    plane: FreePlane<f64>,
    /// N·m.
    moment: Vector3<f64>,
    /// N·m/rad.
    stiffness: Matrix3<f64>,
}

impl Balance {
    /// A mechanism with weights whose tendons have these lengths without tension (m).
    #[must_use]
    pub fn new(
        rig: Rig<f64, 3>,
        load: Load<f64>,
        support: Support<f64>,
        tendons: [Tendon<f64>; 3],
        unstretched_m: SVector<f64, 3>,
    ) -> Self {
        Self {
            rig,
            load,
            support,
            tendons,
            unstretched_m,
            push_n: Vector3::zeros(),
        }
    }

    /// The same with a force at the tip, N in frame {A}.
    #[must_use]
    pub fn pushed(&self, push_n: Vector3<f64>) -> Self {
        Self { push_n, ..*self }
    }

    /// The same with the leg's own weight and a payload (kg).
    ///
    /// # Errors
    /// A payload that is refused.
    pub fn with_payload(&self, payload_kg: f64) -> Result<Self, Error> {
        let load = Load::new(&self.rig, payload_kg)?;
        Ok(Self { load, ..*self })
    }

    /// Where it comes to rest: down the potential energy from `start`, by Newton's steps where they lead down and by
    /// shorter ones elsewhere.
    ///
    /// # Errors
    /// [`Error::Unstable`] if it comes to no rest below the horizon; a tension beyond a tendon's curve;
    /// [`Error::TendonCollapsed`]; [`Error::NotConverged`].
    pub fn rest(&self, start: Posture) -> Result<Posture, Error> {
        let mut here = start;
        for _ in 0..STEPS_MAX {
            let (next, step_rad) = self.step(&here)?;
            if step_rad <= STEP_RAD {
                return Ok(next);
            }
            here = next;
        }
        Err(Error::NotConverged)
    }

    /// Tension of each tendon, N.
    ///
    /// # Errors
    /// [`Error::TendonCollapsed`]; a tension beyond a tendon's curve.
    pub fn tensions_n(&self, posture: &Posture) -> Result<SVector<f64, 3>, Error> {
        self.pull(&self.kinematics(posture)?)
            .map(|(tensions, _)| tensions)
    }

    /// Lengths and moments of the tendons.
    ///
    /// # Errors
    /// [`Error::TendonCollapsed`].
    pub fn kinematics(&self, posture: &Posture) -> Result<Kinematics<f64, 3>, Error> {
        inverse_kinematics(&self.geometry(posture), &posture.direction)
    }

    /// From the joint centre to the tip, m.
    #[must_use]
    pub fn tip_m(&self) -> f64 {
        self.rig.tip_m()
    }

    /// How much longer joint and shaft are under the force along them than without any, m.
    ///
    /// # Errors
    /// [`Error::TendonCollapsed`]; a tension beyond a tendon's curve.
    pub fn axial_stretch_m(&self, posture: &Posture) -> Result<f64, Error> {
        let kinematics = self.kinematics(posture)?;
        let (tensions, _) = self.pull(&kinematics)?;
        let direction = &posture.direction;
        let along = self.geometry(posture).axial_pulls(direction, &kinematics);
        let force = self.load.axial_force_n(direction) - along.dot(&tensions);
        Ok(self.support.joint().axial_compliance_m_per_n * force)
    }

    /// Potential energy of tendons, joint and weights, J.
    ///
    /// # Errors
    /// [`Error::TendonCollapsed`]; a tension beyond a tendon's curve.
    pub fn energy_j(&self, posture: &Posture) -> Result<f64, Error> {
        let (springs, weights) = self.energies_j(posture)?;
        Ok(springs + weights)
    }

    /// Moment along each free rotation, N·m: minus the energy's derivative by it. On a support with two freedoms the
    /// third is zero.
    ///
    /// # Errors
    /// [`Error::TendonCollapsed`]; a tension beyond a tendon's curve.
    pub fn free_moment_nm(&self, posture: &Posture) -> Result<Vector3<f64>, Error> {
        let response = self.respond(posture)?;
        if self.support.twists() {
            return Ok(response.moment);
        }
        let [x, y] = response.plane.project(&response.moment);
        Ok(Vector3::new(x, y, 0.0))
    }

    /// The next posture on the way down and the length of the step to it, rad.
    fn step(&self, here: &Posture) -> Result<(Posture, f64), Error> {
        let response = self.respond(here)?;
        let scale = response.stiffness.amax();
        let mut refusal = Error::Unstable;
        for damping in DAMPING {
            let damped = response.stiffness + Matrix3::identity() * (damping * scale);
            let Some((next, step_rad)) = self.turn(here, &response, &damped) else {
                continue;
            };
            match self.leads_down(here, &next, scale) {
                Ok(true) => return Ok((next, step_rad)),
                Ok(false) => {}
                // A step that overstretches a tendon is too long; it is the end only if no shorter one leads down.
                Err(error) => refusal = error,
            }
        }
        Err(refusal)
    }

    /// One step under a stiffness; none above the horizon or if the stiffness is not positive.
    fn turn(
        &self,
        here: &Posture,
        response: &PostureResponse,
        stiffness: &Matrix3<f64>,
    ) -> Option<(Posture, f64)> {
        let rotation = if self.support.twists() {
            solve3(stiffness, &response.moment)
        } else {
            response.plane.solve(stiffness, &response.moment)
        };
        let rotation = rotation.ok()?;
        let next = self.turned(here, &rotation)?;
        Some((next, rotation.norm()))
    }

    /// The posture after a small rotation; none above the horizon.
    pub(super) fn turned(&self, here: &Posture, rotation: &Vector3<f64>) -> Option<Posture> {
        let direction = &here.direction;
        let moved = direction.vector() + tip_displacement(rotation, direction, 1.0);
        let torsion = if self.support.twists() {
            here.torsion + self.support.torsion_change(direction).dot(rotation)
        } else {
            0.0
        };
        let direction = Direction::from_xy(moved.x, moved.y).ok()?;
        Some(Posture { direction, torsion })
    }

    /// Whether the energy falls or, where rounding hides that, the moment does not rise.
    fn leads_down(&self, here: &Posture, next: &Posture, stiffness: f64) -> Result<bool, Error> {
        let (springs, weights) = self.energies_j(here)?;
        let change = self.energy_j(next)? - (springs + weights);
        if change.abs() > ENERGY_ROUNDING * (springs + weights.abs()) {
            return Ok(change < 0.0);
        }
        // At the rounding of the moment itself both are noise, and the step is too short to matter.
        let noise = f64::EPSILON * stiffness;
        Ok(self.free_moment_nm(next)?.norm() <= self.free_moment_nm(here)?.norm() + noise)
    }

    fn tip(&self, direction: &Direction<f64>) -> Vector3<f64> {
        direction.vector() * self.rig.tip_m()
    }

    fn geometry(&self, posture: &Posture) -> Geometry<f64, 3> {
        let twist = self.support.twist(&posture.direction);
        let twist = twist.composed(&Twist::from_torsion(posture.torsion));
        self.rig.geometry().twisted(&twist)
    }

    fn respond(&self, posture: &Posture) -> Result<PostureResponse, Error> {
        let (geometry, direction) = (self.geometry(posture), &posture.direction);
        let kinematics = inverse_kinematics(&geometry, direction)?;
        let (tensions, stiffnesses) = self.pull(&kinematics)?;
        let moment_map = kinematics.moment_map;
        Ok(PostureResponse {
            plane: self.support.plane(direction),
            moment: moment_map * tensions
                + self.load.moment(direction)
                + self.tip(direction).cross(&self.push_n)
                + self.support.joint_moment(direction, posture.torsion),
            stiffness: tendon_stiffness(&moment_map, &stiffnesses)
                + structural_stiffness(&geometry, direction, &tensions)
                + self.load.stiffness(direction)
                + self.support.joint_stiffness(direction, posture.torsion),
        })
    }

    /// Tensions and tangent stiffnesses: none of either in a slack tendon.
    fn pull(
        &self,
        kinematics: &Kinematics<f64, 3>,
    ) -> Result<(SVector<f64, 3>, SVector<f64, 3>), Error> {
        let (mut tensions, mut stiffnesses) = (SVector::zeros(), SVector::zeros());
        for (i, tendon) in self.tendons.iter().enumerate() {
            let elongation = kinematics.lengths[i] - self.unstretched_m[i];
            if elongation > 0.0 {
                tensions[i] = tendon.tension(elongation)?;
                stiffnesses[i] = tendon.stiffness(tensions[i])?;
            }
        }
        Ok((tensions, stiffnesses))
    }

    /// Of tendons and joint, and of weights and push.
    fn energies_j(&self, posture: &Posture) -> Result<(f64, f64), Error> {
        let direction = &posture.direction;
        let mut springs = self.support.joint_energy(direction, posture.torsion);
        let lengths = self.kinematics(posture)?.lengths;
        for (i, tendon) in self.tendons.iter().enumerate() {
            springs += tendon.energy(lengths[i] - self.unstretched_m[i])?;
        }
        let outer = self.load.energy(direction) - self.tip(direction).dot(&self.push_n);
        Ok((springs, outer))
    }
}
