//! The whole model at one pose: what `leg eval` prints.

use crate::range::{TENSION_MAX, check_magnitude};
use crate::{
    Direction, Distribution, Error, FreePlane, Geometry, Kinematics, Limit, Load, Quantity, Rig,
    RigParameters, Scalar, SupportKind, Tendon, TensionBounds, Twist, ball_joint_torsion,
    deviation, distribute, inverse_kinematics, solve3, structural_stiffness,
    structural_stiffness_printed, tendon_stiffness, tip_displacement,
};
use nalgebra::{Matrix3, SVector, Vector3};

/// A pose, a load and the tendons that hold it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize, postcard_schema::Schema)
)]
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
    /// Stiffness of each tendon, N/m.
    pub stiffness_n_per_m: T,
    /// How the central support guides the leg.
    pub support: SupportKind,
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
    /// K₁ + exact K₂, N·m/rad.
    pub stiffness_nm_per_rad: [[T; 3]; 3],
    /// Exact K₂, N·m/rad.
    pub stiffness_k2_exact_nm_per_rad: [[T; 3]; 3],
    /// K₂ as Eq. (15) prints it, N·m/rad: for comparison only.
    pub stiffness_k2_printed_nm_per_rad: [[T; 3]; 3],
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
    let tensions = state.distribution.tensions(query.level_n);
    let stiffness = state.stiffness(&tensions);
    let deviation_under = |k: &Matrix3<T>| state.deviation(k);
    let tendon = state.tendon;
    let distribution = &state.distribution;
    Ok(Evaluation {
        lengths_m: state.kinematics.lengths.into(),
        moment_map_m: rows(&state.kinematics.moment_map),
        pretension_direction: (distribution.per_level * T::FRAC_1_SQRT_3).into(),
        load_moment_nm: state.moment.into(),
        tensions_n: tensions.into(),
        tensions_min_n: distribution.tensions(distribution.lowest_level).into(),
        level_range_n: [distribution.lowest_level, distribution.highest_level],
        level_limits: distribution.limits(&state.bounds),
        feasible: distribution.feasible(),
        stiffness_nm_per_rad: rows(&stiffness.total),
        stiffness_k2_exact_nm_per_rad: rows(&stiffness.k2_exact),
        stiffness_k2_printed_nm_per_rad: rows(&stiffness.k2_printed),
        deviation_m: deviation_under(&stiffness.total)?,
        deviation_with_load_stiffness_m: deviation_under(
            &(stiffness.total + state.load.stiffness(&state.direction)),
        )?,
        unstretched_m: core::array::from_fn(|i| {
            tendon.unstretched(state.kinematics.lengths[i], tensions[i])
        }),
        torsion_rad: state.torsion,
    })
}

/// The mechanism at the pose of a query, balanced.
struct State<T> {
    rig: Rig<T, 3>,
    geometry: Geometry<T, 3>,
    direction: Direction<T>,
    torsion: T,
    /// The free rotations; none for a ball joint, which is free about every axis.
    plane: Option<FreePlane<T>>,
    load: Load<T>,
    moment: Vector3<T>,
    bounds: TensionBounds<T>,
    tendon: Tendon<T>,
    kinematics: Kinematics<T, 3>,
    distribution: Distribution<T, 3>,
}

struct Stiffness<T> {
    total: Matrix3<T>,
    k2_exact: Matrix3<T>,
    k2_printed: Matrix3<T>,
}

impl<T: Scalar> State<T> {
    fn new(parameters: &RigParameters<T, 3>, query: &Query<T>) -> Result<Self, Error> {
        let rig = Rig::new(parameters)?;
        let direction = Direction::from_angles(query.azimuth_rad, query.tilt_rad)?;
        check_magnitude(query.level_n, TENSION_MAX, Quantity::Level)?;
        let bounds = TensionBounds::new(query.tension_floor_n, query.tension_ceiling_n)?;
        let tendon = Tendon::new(query.stiffness_n_per_m)?;
        let load = Load::new(&rig, query.payload_kg)?;
        let moment = load.moment(&direction);
        let q = direction.half_tangent();
        let bisector_plane = FreePlane::torsion_free(&direction);
        let (torsion, twist, plane) = match query.support {
            SupportKind::TorsionFree => (T::zero(), Twist::none(), Some(bisector_plane)),
            SupportKind::Universal => {
                let twist = Twist::universal(&q);
                (
                    twist.torsion(),
                    twist,
                    Some(FreePlane::universal(&direction)),
                )
            }
            SupportKind::Spherical => {
                let torsion = ball_joint_torsion(&rig, &direction, &load, &bounds, query.level_n)?;
                (torsion, Twist::from_torsion(torsion), None)
            }
        };
        let geometry = rig.geometry.twisted(&twist);
        let kinematics = inverse_kinematics(&geometry, &direction)?;
        let distribution = distribute(
            &kinematics.moment_map,
            &plane.unwrap_or(bisector_plane),
            &moment,
            &bounds,
        )?;
        Ok(Self {
            rig,
            geometry,
            direction,
            torsion,
            plane,
            load,
            moment,
            bounds,
            tendon,
            kinematics,
            distribution,
        })
    }

    fn stiffness(&self, tensions: &SVector<T, 3>) -> Stiffness<T> {
        let k = SVector::repeat(self.tendon.stiffness());
        let k1 = tendon_stiffness(&self.kinematics.moment_map, &k);
        let k2_exact = structural_stiffness(&self.geometry, &self.direction, tensions);
        let k2_printed = structural_stiffness_printed(&self.geometry, &self.direction, tensions);
        Stiffness {
            total: k1 + k2_exact,
            k2_exact,
            k2_printed,
        }
    }

    fn deviation(&self, k: &Matrix3<T>) -> Result<T, Error> {
        let rotation = match &self.plane {
            Some(plane) => plane.solve(k, &self.moment)?,
            None => solve3(k, &self.moment)?,
        };
        Ok(deviation(&tip_displacement(
            &rotation,
            &self.direction,
            self.rig.tip,
        )))
    }
}

fn rows<T: Scalar>(matrix: &Matrix3<T>) -> [[T; 3]; 3] {
    core::array::from_fn(|i| core::array::from_fn(|j| matrix[(i, j)]))
}
