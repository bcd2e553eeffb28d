//! The simulated leg at its start.

use super::defect::Defects;
use super::dynamics::Dynamics;
use super::encoder::Encoder;
use super::energy::Work;
use super::hand::Hand;
use super::inertia::Inertia;
use super::motor::{Motor, MotorType};
use super::noise::defect_rng;
use super::payload::Payload;
use super::push::Push;
use super::sensing::Cells;
use super::supply::Supply;
use super::tendon_pull::RealTendon;
use super::{Plant, Start};
use leg_base::tick_time::tick_s;
use leg_model::{Error, Load, Quantity, Reason, Rig};
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

impl Plant {
    /// A leg at its start. Its actuators and sensors are as the rig's actuator data say, whatever calibrations the rig
    /// has besides: only the signs of the encoders' counts are those of the calibration, as they are wired.
    ///
    /// # Errors
    /// A rig without inertia; a start that the model refuses or at which a tension leaves the rig's bounds.
    pub fn new(
        rig: &RigFile,
        settings: &PlantSettings,
        start: Start,
        seed: u64,
    ) -> Result<Self, Error> {
        let bare = bare_body(rig, settings)?;
        let mut dynamics = dynamics(rig, settings, bare)?;
        let started = start.started(rig, &dynamics.rig, &dynamics.tendons)?;
        dynamics.load = Load::new(&dynamics.rig, started.payload_kg)?;
        dynamics.inertia = bare.loaded(started.payload_kg, dynamics.rig.tip_m());
        let [actuator, ..] = &rig.actuators;
        let substeps = settings.substeps.max(1);
        let half_s = 0.5 * tick_s() / f64::from(substeps);
        let mut plant = Self {
            actuators: rig.actuators,
            dynamics,
            bare,
            leg: started.leg,
            motor_types: rig
                .actuators
                .each_ref()
                .map(|actuator| MotorType::new(actuator, half_s)),
            motors: rig.actuators.each_ref().map(Motor::new),
            supply: Supply {
                open_v: actuator.supply_v,
                resistance_ohm: settings.supply_resistance_ohm,
            },
            temperature_c: settings.ambient_c,
            ambient_c: settings.ambient_c,
            encoders: std::array::from_fn(|i| Encoder::new(i, rig.calibration.counts_sign[i])),
            cells: Cells::new(&rig.actuators, settings, seed),
            current_offset_a: settings.current_offset_a,
            defects: Defects::default(),
            rng: defect_rng(seed.wrapping_add(1)),
            contacts: [true; 3],
            emergency_stop: false,
            payload: Payload::new(started.payload_kg),
            push: Push::default(),
            hand: Hand::default(),
            unstretched_at_zero_m: started.unstretched_m,
            tensions_n: [0.0; 3],
            work: Work::default(),
            ticks: 0,
            substeps,
        };
        plant.tensions_n = plant.pulls_n();
        Ok(plant)
    }
}

fn bare_body(rig: &RigFile, settings: &PlantSettings) -> Result<Inertia, Error> {
    let inertia = Inertia {
        transverse_kg_m2: settings.transverse_inertia_kg_m2(&rig.parameters),
        axial_kg_m2: settings.leg_axial_inertia_kg_m2,
    };
    if inertia.transverse_kg_m2 > 0.0 && inertia.axial_kg_m2 > 0.0 {
        return Ok(inertia);
    }
    Err(Error::Refused {
        quantity: Quantity::LegMass,
        reason: Reason::NotPositive,
    })
}

/// Without a payload.
fn dynamics(file: &RigFile, settings: &PlantSettings, inertia: Inertia) -> Result<Dynamics, Error> {
    let [first, second, third] = &file.tendons;
    let real = |tendon| RealTendon::new(tendon, settings.curve_error);
    let rig = Rig::new(&file.parameters)?;
    Ok(Dynamics {
        rig,
        support: file.support,
        tendons: [real(first)?, real(second)?, real(third)?],
        cut: [false; 3],
        inertia,
        load: Load::new(&rig, 0.0)?,
        push_n: Vector3::zeros(),
        joint_damping_nm_s_per_rad: settings.joint_damping_nm_s_per_rad,
        tendon_damping_n_s_per_m: settings.tendon_damping_n_s_per_m,
    })
}
