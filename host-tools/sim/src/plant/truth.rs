//! The true state of the simulated leg, of which the sensors report a part.

use leg_model::Direction;
use nalgebra::Vector3;

/// The state of the simulated leg as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Time since the start, s.
    pub time_s: f64,
    /// Where the leg points.
    pub direction: Direction<f64>,
    /// Its torsion beyond that which the joint itself gives it, rad.
    pub torsion_rad: f64,
    /// Its rotation in frame {A}, rad/s.
    pub rate_rad_per_s: Vector3<f64>,
    /// The tip in frame {A}, m, without the stretch of joint and shaft along the leg.
    pub tip_m: Vector3<f64>,
    /// Tension of each tendon, N.
    pub tensions_n: [f64; 3],
    /// Length of each tendon without tension, m.
    pub unstretched_m: [f64; 3],
    /// kg.
    pub payload_kg: f64,
    /// Current of each motor, A.
    pub currents_a: [f64; 3],
    /// Speed of each rotor, rad/s.
    pub speeds_rad_per_s: [f64; 3],
    /// Voltage at the drivers, V.
    pub supply_v: f64,
}

impl Truth {
    /// Whether place, rotation and tensions are numbers still. The joint's stop holds a leg whose place is lost, straight down: its
    /// rotation shows that.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let places = self.tip_m.iter().chain(&self.rate_rad_per_s);
        let mut numbers = places.chain(&self.tensions_n).copied();
        numbers.all(f64::is_finite)
    }
}
