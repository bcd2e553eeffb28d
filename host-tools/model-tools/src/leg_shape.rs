//! Sizes and inertias of a leg that its rig file does not give, for the models of other programs.

use leg_model::RigParameters;
use std::f64::consts::PI;

/// Density of the payload, kg/m³: steel.
const PAYLOAD_DENSITY_KG_PER_M3: f64 = 7850.0;

/// Sizes of what the eye sees, and the inertia that follows from them: the leg's is that of a solid cylinder from the joint
/// to the tip, the payload's that of a steel ball.
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
    /// Inertia of the payload about its centre, kg·m².
    pub payload_inertia: f64,
}

impl LegShape {
    /// Of a rig with a payload; none where neither has a mass.
    pub fn new(rig: &RigParameters<f64, 3>, payload_kg: f64) -> Option<Self> {
        let mass = rig.leg_mass_kg;
        if mass + payload_kg <= 0.0 {
            return None;
        }
        let radii = rig.leg_anchors_m.map(|[x, y]| x.hypot(y));
        let ring = radii.iter().copied().fold(0.0, f64::max);
        let (tip, rod) = (rig.joint_length_m + rig.leg_length_m, ring / 4.0);
        let volume = payload_kg / PAYLOAD_DENSITY_KG_PER_M3;
        let payload = (3.0 * volume / (4.0 * PI)).cbrt();
        Some(Self {
            tip,
            ring,
            rod,
            inertia: [
                mass * (3.0 * rod * rod + tip * tip) / 12.0,
                mass * rod * rod / 2.0,
            ],
            payload,
            payload_inertia: 0.4 * payload_kg * payload * payload,
        })
    }
}
