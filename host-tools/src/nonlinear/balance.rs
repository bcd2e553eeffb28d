//! Energy, moment and stiffness of a mechanism whose tendons have fixed lengths without tension.

use leg_model::{
    Direction, Error, FreePlane, Geometry, Load, Rig, RigParameters, SupportKind, Tendon, Twist,
    inverse_kinematics, structural_stiffness, tendon_stiffness, tip_displacement,
};
use nalgebra::{Matrix3, SVector, Vector3};

/// Damping of a step beside the stiffness: none first, then ever more until the step leads down.
const DAMPING: [f64; 12] = [
    0.0, 1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7,
];

/// Energies that differ by less than this part of their terms are equal but for rounding.
const ENERGY_ROUNDING: f64 = 1e-14;

/// A mechanism on a support with two freedoms, with weights, and tendons that hold it.
#[derive(Clone, Copy, Debug)]
pub struct Balance {
    rig: Rig<f64, 3>,
    load: Load<f64>,
    /// Σ weight × distance from the joint, N·m.
    lever_nm: f64,
    support: SupportKind,
    tendon: Tendon<f64>,
    /// Lengths of the tendons without tension, m.
    pub unstretched_m: SVector<f64, 3>,
}

/// What the mechanism does at a direction.
struct Point {
    plane: FreePlane<f64>,
    /// N·m.
    moment: Vector3<f64>,
    /// N·m/rad.
    stiffness: Matrix3<f64>,
}

impl Balance {
    /// A mechanism whose tendons are still without length.
    ///
    /// # Errors
    /// A parameter or payload that is refused.
    pub fn new(
        parameters: &RigParameters<f64, 3>,
        payload_kg: f64,
        support: SupportKind,
        tendon: Tendon<f64>,
    ) -> Result<Self, Error> {
        let p = parameters;
        let rig = Rig::new(p)?;
        Ok(Self {
            rig,
            load: Load::new(&rig, payload_kg)?,
            lever_nm: (p.leg_mass_kg * p.leg_centroid_m + payload_kg * rig.tip_m())
                * p.gravity_m_per_s2,
            support,
            tendon,
            unstretched_m: SVector::zeros(),
        })
    }

    /// From the joint centre to the tip, m.
    #[must_use]
    pub fn tip_m(&self) -> f64 {
        self.rig.tip_m()
    }

    /// The anchors, twisted as the support twists them at a direction, and the rotations that it leaves free.
    #[must_use]
    pub fn guided(&self, direction: &Direction<f64>) -> (Geometry<f64, 3>, FreePlane<f64>) {
        let (twist, plane) = guide(self.support, direction);
        (self.rig.geometry().twisted(&twist), plane)
    }

    /// Potential energy of tendons and weights, J.
    ///
    /// # Errors
    /// [`Error::TendonCollapsed`].
    pub fn energy_j(&self, direction: &Direction<f64>) -> Result<f64, Error> {
        Ok(self.tendon_energy_j(direction)? + self.lever_nm * direction.vector().z)
    }

    /// Moment along the free rotations: minus the energy's derivative by them, N·m.
    ///
    /// # Errors
    /// [`Error::TendonCollapsed`].
    pub fn free_moment_nm(&self, direction: &Direction<f64>) -> Result<[f64; 2], Error> {
        let point = self.at(direction)?;
        Ok(point.plane.project(&point.moment))
    }

    /// The next direction on the way down and the length of the step to it, rad.
    ///
    /// # Errors
    /// [`Error::TendonCollapsed`]; [`Error::Unstable`] when every way down leads above the horizon.
    pub(super) fn step(&self, here: &Direction<f64>) -> Result<(Direction<f64>, f64), Error> {
        let point = self.at(here)?;
        let scale = point.stiffness.amax();
        for damping in DAMPING {
            let damped = point.stiffness + Matrix3::identity() * (damping * scale);
            let Ok(rotation) = point.plane.solve(&damped, &point.moment) else {
                continue;
            };
            let Some(next) = turned(here, &rotation) else {
                continue;
            };
            if self.leads_down(here, &next, &point)? {
                return Ok((next, rotation.dot(&rotation).sqrt()));
            }
        }
        Err(Error::Unstable)
    }

    /// Whether the energy falls or, where rounding hides that, the moment does not rise.
    fn leads_down(
        &self,
        here: &Direction<f64>,
        next: &Direction<f64>,
        point: &Point,
    ) -> Result<bool, Error> {
        let change = self.energy_j(next)? - self.energy_j(here)?;
        let rounding = ENERGY_ROUNDING * (self.tendon_energy_j(here)? + self.lever_nm);
        if change.abs() > rounding {
            return Ok(change < 0.0);
        }
        let [x, y] = point.plane.project(&point.moment);
        let [next_x, next_y] = self.free_moment_nm(next)?;
        // At the rounding of the moment itself both are noise, and the step is too short to matter.
        let noise = f64::EPSILON * point.stiffness.amax();
        Ok(next_x.hypot(next_y) <= x.hypot(y) + noise)
    }

    fn at(&self, direction: &Direction<f64>) -> Result<Point, Error> {
        let (geometry, plane) = self.guided(direction);
        let kinematics = inverse_kinematics(&geometry, direction)?;
        let elongations = kinematics.lengths - self.unstretched_m;
        let tensions = elongations.map(|elongation| self.tendon.tension(elongation));
        let stiffnesses = elongations.map(|elongation| self.tangent(elongation));
        let stiffness = tendon_stiffness(&kinematics.moment_map, &stiffnesses)
            + structural_stiffness(&geometry, direction, &tensions)
            + self.load.stiffness(direction);
        Ok(Point {
            plane,
            moment: kinematics.moment_map * tensions + self.load.moment(direction),
            stiffness,
        })
    }

    fn tendon_energy_j(&self, direction: &Direction<f64>) -> Result<f64, Error> {
        let (geometry, _) = self.guided(direction);
        let elongations = inverse_kinematics(&geometry, direction)?.lengths - self.unstretched_m;
        let energies = elongations.map(|length| 0.5 * self.tendon.tension(length) * length);
        Ok(energies.sum())
    }

    /// Tangent stiffness at an elongation: none when slack, N/m.
    fn tangent(&self, elongation: f64) -> f64 {
        if elongation < 0.0 {
            0.0
        } else {
            self.tendon.stiffness()
        }
    }
}

/// The direction after a small rotation; none above the horizon.
fn turned(direction: &Direction<f64>, rotation: &Vector3<f64>) -> Option<Direction<f64>> {
    let moved = direction.vector() + tip_displacement(rotation, direction, 1.0);
    Direction::from_xy(moved.x, moved.y).ok()
}

/// The leg's twist and free rotations on a support with two freedoms.
fn guide(support: SupportKind, direction: &Direction<f64>) -> (Twist<f64>, FreePlane<f64>) {
    if support == SupportKind::Universal {
        let twist = Twist::universal(&direction.half_tangent());
        (twist, FreePlane::universal(direction))
    } else {
        (Twist::none(), FreePlane::torsion_free(direction))
    }
}
