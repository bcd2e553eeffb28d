//! The whole model at one pose: what `leg eval` prints.

mod balanced_leg;
mod map;

pub use map::{MapEvaluation, evaluate_for_map};

use crate::range::check_magnitude;
use crate::{
    BendingAxis, Error, Limit, Quantity, Rig, RigParameters, Scalar, StiffnessAnswer, Support,
    Tendon, printed,
};
use balanced_leg::BalancedLeg;
use nalgebra::Matrix3;

/// At which tension the stiffness of a tendon is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub enum StiffnessAt {
    /// At the pretension: equal for equal tendons and independent of the load. The deviation then grows in
    /// proportion to the load, as the paper's does.
    Pretension,
    /// At the tension of each tendon under the load.
    Tension,
}

/// Ten turns, rad: as for the azimuth of a pose.
const AZIMUTH_MAX_RAD: f32 = 20.0 * core::f32::consts::PI;

/// A bending stiffness that the leg shall have.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub struct StiffnessDemand<T> {
    /// N·m/rad.
    pub stiffness_nm_per_rad: T,
    /// The azimuth towards which a push at the tip shall meet it, rad; the softest tilt's if there is none.
    pub towards_rad: Option<T>,
}

impl<T> StiffnessDemand<T> {
    /// The same numbers in another type, each by `convert`.
    #[must_use]
    pub fn map<U>(self, mut convert: impl FnMut(T) -> U) -> StiffnessDemand<U> {
        StiffnessDemand {
            stiffness_nm_per_rad: convert(self.stiffness_nm_per_rad),
            towards_rad: self.towards_rad.map(convert),
        }
    }
}

impl<T: Scalar> StiffnessDemand<T> {
    /// The tilt that is meant.
    ///
    /// # Errors
    /// An azimuth that is not finite or beyond ten turns.
    pub fn axis(&self) -> Result<BendingAxis<T>, Error> {
        let Some(azimuth) = self.towards_rad else {
            return Ok(BendingAxis::Softest);
        };
        check_magnitude(azimuth, AZIMUTH_MAX_RAD, Quantity::DemandAzimuth)?;
        let (sin, cos) = azimuth.sin_cos();
        Ok(BendingAxis::Towards([cos, sin]))
    }
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
    /// Pretension λ/√3, N per tendon at the vertical pose. It may lie outside the feasible range.
    pub pretension_n: T,
    /// Lowest tension allowed, N.
    pub f_min_n: T,
    /// Highest tension allowed, N.
    pub f_max_n: T,
    /// The tendons.
    pub tendons: [Tendon<T>; 3],
    /// At which tension their stiffness is read.
    pub stiffness_at: StiffnessAt,
    /// The central support.
    pub support: Support<T>,
    /// A stiffness to find the pretension for, if one is demanded. The rest of the evaluation stays at the asked pretension.
    pub demand: Option<StiffnessDemand<T>>,
}

/// What the model says of a [`Query`] on a mechanism with three tendons. SI units, frame {A}, matrices by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
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
    /// Tensions at the asked pretension, N.
    pub tensions_n: [T; 3],
    /// Tensions at the lowest pretension that keeps the bounds, N.
    pub tensions_min_n: [T; 3],
    /// Lowest and highest pretension inside the tension bounds, N; lowest above highest when there is none.
    #[cfg_attr(feature = "serde", serde(rename = "level_range_n"))]
    pub pretension_range_n: [T; 2],
    /// What ends that range below and above.
    #[cfg_attr(feature = "serde", serde(rename = "level_limits"))]
    pub pretension_limits: [Limit; 2],
    /// Whether any pretension keeps every tension inside its bounds.
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
    /// What answers the demanded stiffness; none without a demand. On a support with three freedoms the leg keeps the
    /// twist that it has at the asked pretension.
    pub commanded: Option<StiffnessAnswer<T>>,
}

/// Evaluates the whole model at one pose.
///
/// ```
/// use leg_model::{Query, RigParameters, StiffnessAt, StiffnessDemand, SupportKind, Tendon, evaluate};
///
/// let query = Query {
///     azimuth_rad: 0.0,
///     tilt_rad: 0.2,
///     payload_kg: 1.0,
///     pretension_n: 60.0,
///     f_min_n: 8.0,
///     f_max_n: 150.0,
///     tendons: [Tendon::constant(1e5)?; 3],
///     stiffness_at: StiffnessAt::Pretension,
///     support: SupportKind::Spherical.into(),
///     demand: Some(StiffnessDemand {
///         stiffness_nm_per_rad: 1e5,
///         towards_rad: None,
///     }),
/// };
/// let answer = evaluate(&RigParameters::<f64, 3>::TABLE_1, &query)?;
/// // A ball joint lets the leg twist until no torsion moment is left.
/// assert!(answer.torsion_rad.abs() < 0.03);
/// // So stiff a leg is out of reach: the nearest stiffness is the answer.
/// assert!(answer.commanded.is_some_and(|found| found.stiffness_nm_per_rad < 1e5));
/// # Ok::<(), leg_model::Error>(())
/// ```
///
/// # Errors
/// A parameter or a part of the query that is refused, by name; what the model cannot solve at this pose.
pub fn evaluate<T: Scalar>(
    parameters: &RigParameters<T, 3>,
    query: &Query<T>,
) -> Result<Evaluation<T>, Error> {
    let leg = BalancedLeg::new(Rig::new(parameters)?, query)?;
    let distribution = &leg.distribution;
    let tensions = distribution.tensions(query.pretension_n);
    let stiffness = leg.stiffness(query, &tensions)?;
    let k2_printed = printed::structural_stiffness(&leg.geometry, &leg.direction, &tensions);
    let load_stiffness = leg.load.stiffness(&leg.direction);
    let sag = leg.sag(&stiffness.total, &stiffness)?;
    let sag_with_load = leg.sag(&(stiffness.total + load_stiffness), &stiffness)?;
    let unstretched = leg.unstretched(&query.tendons, &tensions)?;
    let bending = leg.bending(&(stiffness.total + load_stiffness));
    let demand = query.demand.as_ref();
    let commanded = demand.map(|demand| leg.command(demand, &query.tendons));
    Ok(Evaluation {
        lengths_m: leg.kinematics.lengths.into(),
        moment_map_m: rows(&leg.kinematics.moment_map),
        pretension_direction: (distribution.per_pretension * T::FRAC_1_SQRT_3).into(),
        load_moment_nm: leg.load_moment.into(),
        joint_moment_nm: leg.joint_moment.into(),
        tensions_n: tensions.into(),
        tensions_min_n: distribution.tensions(distribution.pretension_min).into(),
        pretension_range_n: [distribution.pretension_min, distribution.pretension_max],
        pretension_limits: distribution.limits(&leg.bounds),
        feasible: distribution.feasible(),
        stiffness_nm_per_rad: rows(&stiffness.total),
        stiffness_joint_nm_per_rad: rows(&stiffness.joint),
        stiffness_k2_exact_nm_per_rad: rows(&stiffness.k2_exact),
        stiffness_k2_printed_nm_per_rad: rows(&k2_printed),
        bending_stiffness_nm_per_rad: bending.unwrap_or([T::zero(); 2]),
        axial_stretch_m: sag_with_load.axial_stretch,
        deviation_m: sag.deviation,
        deviation_with_load_stiffness_m: sag_with_load.deviation,
        unstretched_m: unstretched.into(),
        torsion_rad: leg.torsion,
        commanded: commanded.transpose()?,
    })
}

fn rows<T: Scalar>(matrix: &Matrix3<T>) -> [[T; 3]; 3] {
    core::array::from_fn(|i| core::array::from_fn(|j| matrix[(i, j)]))
}
