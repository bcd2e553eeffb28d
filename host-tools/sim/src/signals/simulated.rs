//! What is true of a simulated leg, and what it is compared with.

use super::{Origin, Signal, Values, signals};
use crate::hosted_leg::Comparison;
use crate::plant::Truth;
use leg_base::angles::angles_deg;
use leg_firmware::drive::Drive;

/// A simulated leg at a time.
#[derive(Clone, Copy, Debug)]
pub struct Simulated {
    /// How it is.
    pub truth: Truth,
    /// What its motors got in the last tick.
    pub motors: Drive<f32>,
    /// Where it was sent, and where it is.
    pub comparison: Comparison,
}

impl Simulated {
    fn angles_deg(&self) -> [f64; 2] {
        let along = self.truth.direction.vector();
        angles_deg([along.x, along.y])
    }
}

signals! {
    /// What is known of a simulated leg.
    SIMULATED_SIGNALS of Simulated;
    True Three tip_true_mm "Where the tip is, mm."
        = |at| at.comparison.tip_true_mm;
    True Number tip_error_mm "Distance of the true tip from where it was sent, mm."
        = |at| at.comparison.commanded_error_mm();
    True Number reference_error_mm "Distance of the true tip from where the trajectory has it, mm."
        = |at| at.comparison.reference_error_mm();
    True Number path_error_mm "Distance of the true tip from where a streamed path has it at that time, mm; none where none is followed."
        = |at| at.comparison.path_error_mm.unwrap_or(f64::NAN);
    True Number azimuth_true_deg "Where the leg leans, 0 to 360°."
        = |at| at.angles_deg()[0];
    True Number tilt_true_deg "How far it leans, degrees."
        = |at| at.angles_deg()[1];
    True Number torsion_true_deg "How far it is twisted beyond what its joint does, degrees."
        = |at| at.truth.torsion_rad.to_degrees();
    True Three rate_true_rad_per_s "How fast it turns about x, y and z, rad/s."
        = |at| at.truth.rate_rad_per_s.into();
    True Three tensions_true_n "Tension of each tendon, N."
        = |at| at.truth.tensions_n;
    True Three unstretched_true_m "Length of each tendon without tension, m."
        = |at| at.truth.unstretched_m;
    True Number payload_true_kg "Mass at the tip, kg."
        = |at| at.truth.payload_kg;
    True Three motor_currents_true_a "Current of each motor, A."
        = |at| at.truth.currents_a;
    True Three motor_speeds_true_rad_per_s "Speed of each rotor, rad/s."
        = |at| at.truth.speeds_rad_per_s;
    True Number supply_true_v "Voltage at the drivers, V."
        = |at| at.truth.supply_v;
    Commanded Three duties "What each motor gets, as a part of the supply's voltage, -1 to 1; 0 while the drivers are off."
        = |at| if at.motors.enabled { at.motors.duty.map(f64::from) } else { [0.0; 3] };
}
