//! The arguments of every kernel, validated and prepared, so that only the kernel itself is counted.

use super::KernelInput;
use leg_model::{
    ConstantStiffness, CurvePoint, Direction, Distribution, Elasticity, Error, FreePlane,
    Kinematics, Load, Rig, Scalar, Support, SupportKind, TendonCurve, TendonStates, TensionBounds,
    Twist, distribute, inverse_kinematics,
};
use nalgebra::{SVector, Vector3};

/// Prepared arguments. The curves come last: a load reaches no further than 1 020 bytes, and an address that had to be
/// added up would be counted with the kernel.
#[repr(C)]
pub struct KernelArguments<T> {
    pub rig: Rig<T, 3>,
    pub direction: Direction<T>,
    pub load: Load<T>,
    pub plane: FreePlane<T>,
    pub states: TendonStates<T, 3>,
    pub start: Direction<T>,
    pub moment: Vector3<T>,
    pub bounds: TensionBounds<T>,
    pub pretension: T,
    pub angle: T,
    pub lengths: SVector<T, 3>,
    pub lengths_universal: SVector<T, 3>,
    pub kinematics: Kinematics<T, 3>,
    pub distribution: Distribution<T, 3>,
    pub tendons: [ConstantStiffness<T>; 3],
    pub demand: T,
    pub support: Support<T>,
    pub curves: [TendonCurve<T>; 3],
}

impl<T: Scalar> KernelArguments<T> {
    pub fn new(input: &KernelInput) -> Result<Self, Error> {
        let rig = Rig::new(&input.rig.map(T::from))?;
        let direction = Direction::from_angles(input.azimuth_rad.into(), input.tilt_rad.into())?;
        let bounds = TensionBounds::new(input.f_min_n.into(), input.f_max_n.into())?;
        let tendon = ConstantStiffness::new(input.stiffness_n_per_m.into())?;
        let load = Load::new(&rig, input.payload_kg.into())?;
        let moment = load.moment(&direction);
        let plane = FreePlane::torsion_free(&direction);
        let kinematics = inverse_kinematics(rig.geometry(), &direction)?;
        let distribution = distribute(&kinematics.moment_map, &plane, &moment, &bounds)?;
        let pretension = input.pretension_n.into();
        let states = TendonStates::new(
            distribution.tensions(pretension),
            SVector::repeat(tendon.stiffness_n_per_m()),
        )?;
        let start =
            Direction::from_angles(input.start_azimuth_rad.into(), input.start_tilt_rad.into())?;
        let twist = Twist::universal(&direction.half_tangent());
        let twisted = rig.geometry().twisted(&twist);
        let errors = SVector::from(input.length_errors_m.map(T::from));
        Ok(Self {
            angle: input.azimuth_rad.into(),
            rig,
            direction,
            start,
            plane,
            load,
            moment,
            bounds,
            pretension,
            support: SupportKind::TorsionFree.into(),
            tendons: [tendon; 3],
            curves: [curve(input.pretension_n, input.stiffness_n_per_m)?; 3],
            demand: input.demand_nm_per_rad.into(),
            kinematics,
            distribution,
            states,
            lengths: kinematics.lengths + errors,
            lengths_universal: inverse_kinematics(&twisted, &direction)?.lengths + errors,
        })
    }
}

/// The paper's tendon, scaled to a stiffness (N/m) at a pretension (N).
///
/// Scaled in f32 for every number type, as a board gets its settings: f32 and f64 then compute on the same points, and
/// their difference is that of the kernel alone.
fn curve<T: Scalar>(pretension: f32, stiffness: f32) -> Result<TendonCurve<T>, Error> {
    let points = CurvePoint::<f32>::PAPER;
    let softening = TendonCurve::new(&points)?.stiffness(pretension)? / stiffness;
    TendonCurve::new(&points.map(|point| point.scaled(softening, 1.0).map(T::from)))
}
