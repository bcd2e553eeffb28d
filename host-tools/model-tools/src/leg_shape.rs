//! Sizes and inertias of a leg, for the models of other programs.

use leg_rig::plant_settings::TRANSVERSE_INERTIA;
use leg_rig::rig_file::RigFile;
use std::f64::consts::PI;
use std::fmt::{self, Display, Formatter};

/// Density of the payload, kg/m³: steel.
const PAYLOAD_DENSITY_KG_PER_M3: f64 = 7850.0;

/// Inertia of a payload that is a point, as a part of the leg's along its axis: other programs want some.
const POINT_INERTIA_RATIO: f64 = 1e-4;

/// Several legs on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// How many, evenly spread.
    pub legs: u32,
    /// From the body's centre to each joint centre, m.
    pub radius_m: f64,
    /// Without the legs, kg: a disc.
    pub mass_kg: f64,
}

impl Body {
    /// One of so many legs of a rig, with a mass of its own or with that of its legs together.
    ///
    /// # Errors
    /// [`ShapeError::MasslessBody`]: it has none, and the rig's leg has none either.
    pub fn new(
        rig: &RigFile,
        legs: u32,
        radius_m: f64,
        mass_kg: Option<f64>,
    ) -> Result<Self, ShapeError> {
        let of_legs = f64::from(legs) * rig.parameters.leg_mass_kg;
        let mass_kg = mass_kg.unwrap_or(of_legs);
        let body = Self {
            legs,
            radius_m,
            mass_kg,
        };
        (mass_kg > 0.0)
            .then_some(body)
            .ok_or(ShapeError::MasslessBody)
    }
}

impl Display for Body {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        let Self {
            legs,
            radius_m,
            mass_kg,
        } = self;
        write!(
            to,
            "{legs} legs, their joint centres {radius_m} m from the centre of a body of {mass_kg} kg."
        )
    }
}

/// Why a leg is no body for other programs.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// Nothing has a mass.
    #[error(
        "neither the leg nor the payload has a mass, and other programs move no body without: give a payload"
    )]
    Massless,
    /// The mass of a body would be that of its legs, which have none.
    #[error(
        "the rig's leg has no mass, from which that of the body would follow: give the body's mass"
    )]
    MasslessBody,
    /// No body has these inertias: those about three axes keep the triangle's inequality.
    #[error(
        "no body of the leg's mass and centroid has {across_kg_m2:.2e} kg·m² across its axis at the centroid and {along_kg_m2:.2e} \
         along it: in [simulation] give `{transverse}` at least {lowest_kg_m2:.2e}, or a smaller `{AXIAL_INERTIA}`",
        transverse = TRANSVERSE_INERTIA.name
    )]
    Inertia {
        /// Across, at the centroid, kg·m².
        across_kg_m2: f64,
        /// Along, kg·m².
        along_kg_m2: f64,
        /// The lowest across at the joint that would do, kg·m².
        lowest_kg_m2: f64,
    },
}

/// The key of the inertia along the leg.
const AXIAL_INERTIA: &str = "leg_axial_inertia_kg_m2";

/// Sizes of what the eye sees, which no rig file gives, and inertias: those of the simulated leg, whose payload is a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LegShape {
    /// From the joint centre to the tip, m.
    pub tip: f64,
    /// Radius of the ring of the leg's anchors, m.
    pub ring: f64,
    /// Radius of the leg, m.
    pub rod: f64,
    /// Inertia of the leg across and along its axis, about its centroid, kg·m².
    pub inertia: [f64; 2],
    /// Radius of the payload, m.
    pub payload: f64,
    /// Inertia of the payload about its centre, kg·m²: next to none, as a point; that of the ball where the leg has none itself.
    pub payload_inertia: f64,
}

impl LegShape {
    /// Of a rig with a payload.
    ///
    /// # Errors
    /// [`ShapeError`].
    pub fn new(rig: &RigFile, payload_kg: f64) -> Result<Self, ShapeError> {
        let parameters = &rig.parameters;
        let mass = parameters.leg_mass_kg;
        if mass + payload_kg <= 0.0 {
            return Err(ShapeError::Massless);
        }
        let radii = parameters.leg_anchors_m.map(|[x, y]| x.hypot(y));
        let ring = radii.iter().copied().fold(0.0, f64::max);
        let (tip, rod) = (
            parameters.joint_length_m + parameters.leg_length_m,
            ring / 4.0,
        );
        let volume = payload_kg / PAYLOAD_DENSITY_KG_PER_M3;
        let payload = (3.0 * volume / (4.0 * PI)).cbrt();
        let inertia = inertia(rig)?;
        let payload_inertia = if mass > 0.0 {
            POINT_INERTIA_RATIO * inertia[1]
        } else {
            0.4 * payload_kg * payload * payload
        };
        Ok(Self {
            tip,
            ring,
            rod,
            inertia,
            payload,
            payload_inertia,
        })
    }
}

/// Of the simulated leg, about its centroid; none of a leg without a mass.
fn inertia(rig: &RigFile) -> Result<[f64; 2], ShapeError> {
    let (mass, centroid) = (rig.parameters.leg_mass_kg, rig.parameters.leg_centroid_m);
    if mass <= 0.0 {
        return Ok([0.0; 2]);
    }
    let along = rig.plant.leg_axial_inertia_kg_m2;
    let at_joint = rig.plant.transverse_inertia_kg_m2(&rig.parameters);
    let across = at_joint - mass * centroid * centroid;
    if across < along / 2.0 {
        return Err(ShapeError::Inertia {
            across_kg_m2: across,
            along_kg_m2: along,
            lowest_kg_m2: mass * centroid * centroid + along / 2.0,
        });
    }
    Ok([across, along])
}
