//! The mechanism at the pose of a query.

use super::{Query, StiffnessAt, StiffnessDemand};
use crate::range::{TENSION_MAX, check_magnitude};
use crate::{
    Bending, Direction, Distribution, Elasticity, Error, FreePlane, Geometry, Kinematics, Load,
    Quantity, Rig, Scalar, StiffnessAnswer, StiffnessCommand, Support, Symmetric3, Tendon,
    TensionBounds, Twist, deviation, distribute, elastic_torsion, inverse_kinematics, solve3,
    structural_stiffness, tendon_stiffness, tip_displacement,
};
use nalgebra::{Matrix3, SVector, Vector3};

/// The mechanism at the pose of a query, balanced.
pub(super) struct BalancedLeg<T> {
    pub rig: Rig<T, 3>,
    pub support: Support<T>,
    pub geometry: Geometry<T, 3>,
    pub direction: Direction<T>,
    /// Of the leg, the joint's own twist included.
    pub torsion: T,
    pub elastic_torsion: T,
    pub plane: FreePlane<T>,
    pub load: Load<T>,
    pub load_moment: Vector3<T>,
    pub joint_moment: Vector3<T>,
    pub bounds: TensionBounds<T>,
    pub kinematics: Kinematics<T, 3>,
    pub distribution: Distribution<T, 3>,
}

pub(super) struct StiffnessParts<T> {
    pub total: Matrix3<T>,
    pub joint: Matrix3<T>,
    pub k2_exact: Matrix3<T>,
    /// Of each tendon, N/m.
    pub tendons: SVector<T, 3>,
    /// At which that is, N.
    pub tensions: SVector<T, 3>,
}

/// How far the tip deviates under the load, m.
pub(super) struct Sag<T> {
    pub deviation: T,
    pub axial_stretch: T,
}

impl<T: Scalar> BalancedLeg<T> {
    pub fn new(rig: Rig<T, 3>, query: &Query<T>) -> Result<Self, Error> {
        let direction = Direction::from_angles(query.azimuth_rad, query.tilt_rad)?;
        check_magnitude(query.pretension_n, TENSION_MAX, Quantity::Pretension)?;
        let bounds = TensionBounds::new(query.f_min_n, query.f_max_n)?;
        let load = Load::new(&rig, query.payload_kg)?;
        let load_moment = load.moment(&direction);
        let (support, pretension) = (query.support, query.pretension_n);
        let elastic = elastic_torsion(
            &rig,
            &support,
            &direction,
            &load_moment,
            &bounds,
            pretension,
        )?;
        let twist = support
            .twist(&direction)
            .composed(&Twist::from_torsion(elastic));
        let geometry = rig.geometry.twisted(&twist);
        let kinematics = inverse_kinematics(&geometry, &direction)?;
        let plane = support.plane(&direction);
        let joint_moment = support.joint_moment(&direction, elastic);
        let outer = load_moment + joint_moment;
        let distribution = distribute(&kinematics.moment_map, &plane, &outer, &bounds)?;
        Ok(Self {
            rig,
            support,
            geometry,
            direction,
            torsion: twist.torsion(),
            elastic_torsion: elastic,
            plane,
            load,
            load_moment,
            joint_moment,
            bounds,
            kinematics,
            distribution,
        })
    }

    pub fn stiffness(
        &self,
        query: &Query<T>,
        tensions: &SVector<T, 3>,
    ) -> Result<StiffnessParts<T>, Error> {
        let mut tendons = SVector::zeros();
        for (i, tendon) in query.tendons.iter().enumerate() {
            let at = match query.stiffness_at {
                StiffnessAt::Pretension => query.pretension_n,
                StiffnessAt::Tension => tensions[i],
            };
            tendons[i] = tendon.stiffness(at)?;
        }
        let k1 = tendon_stiffness(&self.kinematics.moment_map, &tendons);
        let k2_exact = structural_stiffness(&self.geometry, &self.direction, tensions);
        let joint = self
            .support
            .joint_stiffness(&self.direction, self.elastic_torsion);
        Ok(StiffnessParts {
            total: k1 + k2_exact + joint,
            joint,
            k2_exact,
            tendons,
            tensions: *tensions,
        })
    }

    pub fn sag(&self, k: &Matrix3<T>, stiffness: &StiffnessParts<T>) -> Result<Sag<T>, Error> {
        let rotation = if self.support.twists() {
            solve3(k, &self.load_moment)?
        } else {
            self.plane.solve(k, &self.load_moment)?
        };
        let axial_stretch = self.axial_stretch(&rotation, stiffness);
        let moved = tip_displacement(&rotation, &self.direction, self.rig.tip);
        Ok(Sag {
            deviation: deviation(&(moved + self.direction.vector() * axial_stretch)),
            axial_stretch,
        })
    }

    /// What the load adds to the force along the leg, the change of the tendons' pull included, times the compliance of
    /// joint and shaft, which are in series there.
    fn axial_stretch(&self, rotation: &Vector3<T>, stiffness: &StiffnessParts<T>) -> T {
        let (geometry, direction, kinematics) = (&self.geometry, &self.direction, &self.kinematics);
        let lengthening = -kinematics.moment_map.tr_mul(rotation);
        let tension_change = stiffness.tendons.component_mul(&lengthening);
        let turning = geometry.axial_pulls_change(direction, kinematics, rotation, &lengthening);
        let pull = geometry
            .axial_pulls(direction, kinematics)
            .dot(&tension_change)
            + turning.dot(&stiffness.tensions);
        let compliance = self.support.joint.axial_compliance_m_per_n;
        compliance * (self.load.axial_force_n(direction) - pull)
    }

    /// The smallest and the largest stiffness against a tilt.
    pub fn bending(&self, k: &Matrix3<T>) -> Result<[T; 2], Error> {
        let k = Symmetric3::symmetric_part(k);
        let bending = if self.support.twists() {
            Bending::twisting(&k, &self.direction)?
        } else {
            Bending::guided(&k, &self.direction, &self.plane)
        };
        bending.extremes()
    }

    /// Lengths of the tendons without these tensions.
    pub fn unstretched(
        &self,
        tendons: &[Tendon<T>; 3],
        tensions: &SVector<T, 3>,
    ) -> Result<SVector<T, 3>, Error> {
        let mut unstretched = self.kinematics.lengths;
        for (i, tendon) in tendons.iter().enumerate() {
            unstretched[i] -= tendon.elongation(tensions[i])?;
        }
        Ok(unstretched)
    }

    /// The pretension that gives a demanded stiffness at this pose.
    pub fn command(
        &self,
        demand: &StiffnessDemand<T>,
        tendons: &[Tendon<T>; 3],
    ) -> Result<StiffnessAnswer<T>, Error> {
        StiffnessCommand::new(
            &self.geometry,
            &self.support,
            &self.direction,
            self.elastic_torsion,
            &self.load,
            tendons,
            &self.kinematics,
            &self.distribution,
        )
        .pretension_for(demand.stiffness_nm_per_rad, &demand.axis()?, &self.bounds)
    }
}
