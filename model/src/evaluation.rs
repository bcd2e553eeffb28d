//! The whole model at one pose: what `leg eval` prints.

use crate::range::{TENSION_MAX, check_magnitude};
use crate::{
    Bending, Direction, Distribution, Elasticity, Error, FreePlane, Geometry, Kinematics, Limit,
    Load, Quantity, Rig, RigParameters, Scalar, Support, Symmetric3, Tendon, TensionBounds, Twist,
    deviation, distribute, elastic_torsion, inverse_kinematics, solve3, structural_stiffness,
    structural_stiffness_printed, tendon_stiffness, tip_displacement,
};
use nalgebra::{Matrix3, SVector, Vector3};

/// At which tension the stiffness of a tendon is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize, postcard_schema::Schema),
    serde(rename_all = "snake_case")
)]
pub enum StiffnessAt {
    /// At the level of pretension: equal for equal tendons and independent of the load. The deviation then grows in
    /// proportion to the load, as the paper's does.
    Pretension,
    /// At the tension of each tendon under the load.
    Tension,
}

/// A pose, a load and what holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query<T> {
    /// Direction towards which the leg leans, rad, within ten turns.
    pub azimuth_rad: T,
    /// How far it leans, rad, within 60°; a negative tilt is the opposite azimuth.
    pub tilt_rad: T,
    /// Mass hung at the tip, kg.
    pub payload_kg: T,
    /// Level of pretension λ/√3, N per tendon at the vertical pose. It may lie outside the feasible range.
    pub level_n: T,
    /// Lowest tension allowed, N.
    pub tension_floor_n: T,
    /// Highest tension allowed, N.
    pub tension_ceiling_n: T,
    /// The tendons.
    pub tendons: [Tendon<T>; 3],
    /// At which tension their stiffness is read.
    pub stiffness_at: StiffnessAt,
    /// The central support.
    pub support: Support<T>,
}

/// What the model says of a [`Query`] on a mechanism with three tendons. SI units, frame {A}, matrices by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize, postcard_schema::Schema)
)]
pub struct Evaluation<T> {
    /// Geometric length of each tendon, m (Eq. 4).
    pub lengths_m: [T; 3],
    /// A: column i is the moment of a unit tension in tendon i, m.
    pub moment_map_m: [[T; 3]; 3],
    /// h: the unit vector of tensions that loads no free axis.
    pub pretension_direction: [T; 3],
    /// Moment of the weights about the joint centre, N·m.
    pub load_moment_nm: [T; 3],
    /// Moment of the bent and twisted joint on the leg, N·m.
    pub joint_moment_nm: [T; 3],
    /// Tensions at the asked level, N.
    pub tensions_n: [T; 3],
    /// Tensions at the lowest level that keeps the bounds, N.
    pub tensions_min_n: [T; 3],
    /// Lowest and highest level inside the tension bounds, N; lowest above highest when there is none.
    pub level_range_n: [T; 2],
    /// What ends that range below and above.
    pub level_limits: [Limit; 2],
    /// Whether any level keeps every tension inside its bounds.
    pub feasible: bool,
    /// K₁ + exact K₂ + that of the joint, N·m/rad.
    pub stiffness_nm_per_rad: [[T; 3]; 3],
    /// Stiffness of the joint, N·m/rad.
    pub stiffness_joint_nm_per_rad: [[T; 3]; 3],
    /// Exact K₂, N·m/rad.
    pub stiffness_k2_exact_nm_per_rad: [[T; 3]; 3],
    /// K₂ as Eq. (15) prints it, N·m/rad: for comparison only.
    pub stiffness_k2_printed_nm_per_rad: [[T; 3]; 3],
    /// The smallest and the largest stiffness against a tilt, the load's own stiffness included, N·m/rad; zeros if
    /// the leg would buckle.
    pub bending_stiffness_nm_per_rad: [T; 2],
    /// How much longer joint and shaft become under the load, m.
    pub axial_stretch_m: T,
    /// Linear deviation of the tip under the whole load, m.
    pub deviation_m: T,
    /// The same with the load's own stiffness, m.
    pub deviation_with_load_stiffness_m: T,
    /// Lengths of the tendons without tension that hold this pose, m.
    pub unstretched_m: [T; 3],
    /// Twist of the leg about its own axis, rad.
    pub torsion_rad: T,
}

/// Evaluates the whole model at one pose.
///
/// # Errors
/// A parameter or a part of the query that is refused, by name; what the model cannot solve at this pose.
pub fn evaluate<T: Scalar>(
    parameters: &RigParameters<T, 3>,
    query: &Query<T>,
) -> Result<Evaluation<T>, Error> {
    let state = State::new(parameters, query)?;
    let distribution = &state.distribution;
    let tensions = distribution.tensions(query.level_n);
    let stiffness = state.stiffness(query, &tensions)?;
    let load_stiffness = state.load.stiffness(&state.direction);
    let sag = state.sag(&stiffness.total, &stiffness)?;
    let sag_with_load = state.sag(&(stiffness.total + load_stiffness), &stiffness)?;
    let mut unstretched = state.kinematics.lengths;
    for (i, tendon) in query.tendons.iter().enumerate() {
        unstretched[i] -= tendon.elongation(tensions[i])?;
    }
    Ok(Evaluation {
        lengths_m: state.kinematics.lengths.into(),
        moment_map_m: rows(&state.kinematics.moment_map),
        pretension_direction: (distribution.per_level * T::FRAC_1_SQRT_3).into(),
        load_moment_nm: state.load_moment.into(),
        joint_moment_nm: state.joint_moment.into(),
        tensions_n: tensions.into(),
        tensions_min_n: distribution.tensions(distribution.lowest_level).into(),
        level_range_n: [distribution.lowest_level, distribution.highest_level],
        level_limits: distribution.limits(&state.bounds),
        feasible: distribution.feasible(),
        stiffness_nm_per_rad: rows(&stiffness.total),
        stiffness_joint_nm_per_rad: rows(&stiffness.joint),
        stiffness_k2_exact_nm_per_rad: rows(&stiffness.k2_exact),
        stiffness_k2_printed_nm_per_rad: rows(&stiffness.k2_printed),
        bending_stiffness_nm_per_rad: state.bending(&(stiffness.total + load_stiffness)),
        axial_stretch_m: sag_with_load.axial_stretch,
        deviation_m: sag.deviation,
        deviation_with_load_stiffness_m: sag_with_load.deviation,
        unstretched_m: unstretched.into(),
        torsion_rad: state.torsion,
    })
}

/// The mechanism at the pose of a query, balanced.
struct State<T> {
    rig: Rig<T, 3>,
    support: Support<T>,
    geometry: Geometry<T, 3>,
    direction: Direction<T>,
    /// Of the leg, the joint's own twist included.
    torsion: T,
    elastic_torsion: T,
    plane: FreePlane<T>,
    load: Load<T>,
    load_moment: Vector3<T>,
    joint_moment: Vector3<T>,
    bounds: TensionBounds<T>,
    kinematics: Kinematics<T, 3>,
    distribution: Distribution<T, 3>,
}

struct Stiffness<T> {
    total: Matrix3<T>,
    joint: Matrix3<T>,
    k2_exact: Matrix3<T>,
    k2_printed: Matrix3<T>,
    /// Of each tendon, N/m.
    tendons: SVector<T, 3>,
    /// At which that is, N.
    tensions: SVector<T, 3>,
}

/// How the leg gives way under its load.
struct Sag<T> {
    deviation: T,
    axial_stretch: T,
}

impl<T: Scalar> State<T> {
    fn new(parameters: &RigParameters<T, 3>, query: &Query<T>) -> Result<Self, Error> {
        let rig = Rig::new(parameters)?;
        let direction = Direction::from_angles(query.azimuth_rad, query.tilt_rad)?;
        check_magnitude(query.level_n, TENSION_MAX, Quantity::Level)?;
        let bounds = TensionBounds::new(query.tension_floor_n, query.tension_ceiling_n)?;
        let load = Load::new(&rig, query.payload_kg)?;
        let load_moment = load.moment(&direction);
        let (support, level) = (query.support, query.level_n);
        let elastic = elastic_torsion(&rig, &support, &direction, &load_moment, &bounds, level)?;
        let twist = support.twist(&direction).and(&Twist::from_torsion(elastic));
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

    fn stiffness(&self, query: &Query<T>, tensions: &SVector<T, 3>) -> Result<Stiffness<T>, Error> {
        let mut tendons = SVector::zeros();
        for (i, tendon) in query.tendons.iter().enumerate() {
            let at = match query.stiffness_at {
                StiffnessAt::Pretension => query.level_n,
                StiffnessAt::Tension => tensions[i],
            };
            tendons[i] = tendon.stiffness(at)?;
        }
        let k1 = tendon_stiffness(&self.kinematics.moment_map, &tendons);
        let k2_exact = structural_stiffness(&self.geometry, &self.direction, tensions);
        let k2_printed = structural_stiffness_printed(&self.geometry, &self.direction, tensions);
        let joint = self
            .support
            .joint_stiffness(&self.direction, self.elastic_torsion);
        Ok(Stiffness {
            total: k1 + k2_exact + joint,
            joint,
            k2_exact,
            k2_printed,
            tendons,
            tensions: *tensions,
        })
    }

    fn sag(&self, k: &Matrix3<T>, stiffness: &Stiffness<T>) -> Result<Sag<T>, Error> {
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
    fn axial_stretch(&self, rotation: &Vector3<T>, stiffness: &Stiffness<T>) -> T {
        let (geometry, direction, kinematics) = (&self.geometry, &self.direction, &self.kinematics);
        let lengthening = -kinematics.moment_map.tr_mul(rotation);
        let tension_change = stiffness.tendons.component_mul(&lengthening);
        let turning = geometry.along_leg_change(direction, kinematics, rotation, &lengthening);
        let pull = geometry
            .along_leg(direction, kinematics)
            .dot(&tension_change)
            + turning.dot(&stiffness.tensions);
        let compliance = self.support.joint.axial_compliance_m_per_n;
        compliance * (self.load.along_leg_n(direction) - pull)
    }

    fn bending(&self, k: &Matrix3<T>) -> [T; 2] {
        let k = Symmetric3::symmetric_part(k);
        let bending = if self.support.twists() {
            Bending::twisting(&k, &self.direction)
        } else {
            Ok(Bending::guided(&k, &self.plane))
        };
        bending
            .and_then(|bending| bending.extremes())
            .unwrap_or([T::zero(); 2])
    }
}

fn rows<T: Scalar>(matrix: &Matrix3<T>) -> [[T; 3]; 3] {
    core::array::from_fn(|i| core::array::from_fn(|j| matrix[(i, j)]))
}
