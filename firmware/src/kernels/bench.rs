//! The arguments of every kernel, validated and prepared, so that only the kernel itself is counted.

use super::KernelInput;
use leg_model::{
    Direction, Distribution, Error, FreePlane, Kinematics, Load, Rig, Tendon, TendonStates,
    TensionBounds, Twist, distribute, inverse_kinematics,
};
use nalgebra::{SVector, Vector3};

/// Prepared arguments.
pub struct Bench {
    pub angle: f32,
    pub rig: Rig<f32, 3>,
    pub direction: Direction<f32>,
    pub start: Direction<f32>,
    pub plane: FreePlane<f32>,
    pub load: Load<f32>,
    pub moment: Vector3<f32>,
    pub bounds: TensionBounds<f32>,
    pub level: f32,
    pub tendon: Tendon<f32>,
    pub kinematics: Kinematics<f32, 3>,
    pub states: TendonStates<f32, 3>,
    pub lengths: SVector<f32, 3>,
    pub lengths_universal: SVector<f32, 3>,
}

impl Bench {
    pub fn new(input: &KernelInput) -> Result<Self, Error> {
        let rig = Rig::new(&input.rig.into())?;
        let direction = Direction::from_angles(input.azimuth_rad, input.tilt_rad)?;
        let bounds = TensionBounds::new(input.tension_floor_n, input.tension_ceiling_n)?;
        let tendon = Tendon::new(input.stiffness_n_per_m)?;
        let load = Load::new(&rig, input.payload_kg)?;
        let moment = load.moment(&direction);
        let plane = FreePlane::torsion_free(&direction);
        let kinematics = inverse_kinematics(rig.geometry(), &direction)?;
        let distribution: Distribution<f32, 3> =
            distribute(&kinematics.moment_map, &plane, &moment, &bounds)?;
        let states = TendonStates {
            tensions: distribution.tensions(input.level_n),
            stiffnesses: SVector::repeat(tendon.stiffness()),
        };
        let twisted = rig
            .geometry()
            .twisted(&Twist::universal(&direction.half_tangent()));
        let errors = SVector::from(input.length_errors_m);
        Ok(Self {
            angle: input.azimuth_rad,
            rig,
            direction,
            start: Direction::from_angles(input.start_azimuth_rad, input.start_tilt_rad)?,
            plane,
            load,
            moment,
            bounds,
            level: input.level_n,
            tendon,
            kinematics,
            states,
            lengths: kinematics.lengths + errors,
            lengths_universal: inverse_kinematics(&twisted, &direction)?.lengths + errors,
        })
    }
}
