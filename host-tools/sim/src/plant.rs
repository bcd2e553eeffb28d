//! The simulated leg: rigid body, tendons, motors, gears, screws and sensors, as the board sees them through its raw
//! interface.
//!
//! A step of the integration is symmetric and of second order: half a step of the ways, half of currents and speeds, a
//! whole one of the leg's rotation, and the same halves back. Everything is f64 and follows from the seed, and no tick
//! allocates.

mod advance;
mod body;
mod build;
mod encoder;
pub mod faults;
mod hand;
mod leg;
mod mechanism;
mod motor;
mod outside;
mod scene;
mod screw;
mod sensing;
mod start;
mod supply;
mod temperature;
mod tendon_pull;
mod truth;
mod work;

#[cfg(test)]
mod tests;

pub use faults::Fault;
pub use start::Start;
pub use truth::{Energy, Truth};
pub use work::Work;

use body::Body;
use encoder::Encoder;
use faults::Faults;
use hand::Hand;
use leg::Leg;
use leg_base::tick_time::tick_s;
use leg_firmware::sensors::Sensors;
use leg_rig::actuator::Actuator;
use mechanism::Mechanism;
use motor::{Motor, MotorType};
use outside::{Payload, Push};
use sensing::{Cells, code, code_around_none};
use supply::Supply;
use temperature::Temperature;

/// A simulated leg with its actuators and sensors.
#[derive(Clone, Debug)]
pub struct Plant {
    actuator: Actuator,
    mechanism: Mechanism,
    /// The leg without a payload.
    bare: Body,
    leg: Leg,
    motor_type: MotorType,
    motors: [Motor; 3],
    supply: Supply,
    temperature: Temperature,
    encoders: [Encoder; 3],
    cells: Cells,
    faults: Faults,
    emergency_stop: bool,
    payload: Payload,
    push: Push,
    hand: Hand,
    unstretched_at_zero_m: [f64; 3],
    /// Tension of each tendon now, N.
    tensions_n: [f64; 3],
    work: Work,
    ticks: u64,
    substeps: u32,
}

/// What a faulty current sensor shows too much, A.
const CURRENT_OFFSET_A: f64 = 10.0;

impl Plant {
    /// Reads every sensor.
    pub fn sense(&mut self) -> Sensors {
        let (actuator, faults) = (&self.actuator, self.faults);
        let offset = faults.of_three(Fault::CurrentOffset);
        let current_code = |i: usize| {
            let off = if offset[i] { CURRENT_OFFSET_A } else { 0.0 };
            code_around_none(self.motors[i].current_a + off, actuator.current_range_a)
        };
        Sensors {
            encoder_counts: self.encoders.map(|encoder| encoder.counter),
            cell_codes: self.cells.read(self.hand.pulls_n(self.tensions_n), faults),
            current_codes: std::array::from_fn(current_code),
            supply_code: code(
                self.supply.voltage_v(&self.motors),
                [0.0, actuator.supply_range_v],
            ),
            temperature_code: code(self.temperature.now_c, actuator.temperature_range_c),
            cell_fresh: faults.of_three(Fault::CellStale).map(|stale| !stale),
            driver_fault: faults.of_three(Fault::DriverFault),
            emergency_stop: self.emergency_stop,
            late: faults.has(Fault::LateTicks),
            settings_corrupt: faults.has(Fault::SettingsCorrupt),
        }
    }

    /// Lets the payload at the tip change linearly to `target_kg` (at least zero) in `over_s`; 0 is at once.
    pub fn set_payload(&mut self, target_kg: f64, over_s: f64) {
        self.payload.set(target_kg, over_s);
    }

    /// Pushes at the tip for `over_s`, with a force in N in frame {A}; it ends an earlier push.
    pub fn push(&mut self, force_n: [f64; 3], over_s: f64) {
        self.push = Push::new(force_n, over_s);
    }

    /// Presses the emergency stop or lets it go. It only tells the board, which has to switch the drivers off.
    pub fn press_emergency_stop(&mut self, pressed: bool) {
        self.emergency_stop = pressed;
    }

    /// Lets a fault begin or end.
    pub fn set_fault(&mut self, fault: Fault, on: bool) {
        let before_j = self.energy().tendons_j;
        self.faults.set(fault, on);
        self.mechanism.cut = self.faults.of_three(Fault::TendonCut);
        self.work.cut_j += before_j - self.energy().tendons_j;
        self.tensions_n = self.pulls_n();
    }

    /// Length of each tendon without tension when its encoder has counted to zero, m: what a perfect homing finds. The
    /// play of the gear is then taken up as after pulling in.
    #[must_use]
    pub fn unstretched_at_zero_m(&self) -> [f64; 3] {
        self.unstretched_at_zero_m
    }

    /// The state as it is.
    #[must_use]
    pub fn truth(&self) -> Truth {
        Truth {
            time_s: self.ticks as f64 * tick_s(),
            direction: self.leg.direction,
            torsion_rad: self.leg.torsion_rad,
            rate_rad_per_s: self.leg.rate,
            tip_m: self.mechanism.tip_m(&self.leg),
            tensions_n: self.tensions_n,
            unstretched_m: self.unstretched_m(),
            payload_kg: self.payload.now_kg,
            currents_a: self.motors.map(|motor| motor.current_a),
            speeds_rad_per_s: self.motors.map(|motor| motor.speed),
            supply_v: self.supply.voltage_v(&self.motors),
            energy: self.energy(),
            work: self.work,
        }
    }

    fn energy(&self) -> Energy {
        let (mechanism, leg) = (&self.mechanism, &self.leg);
        let support = &mechanism.support;
        Energy {
            kinetic_j: mechanism.body.kinetic_j(&leg.direction, &leg.rate),
            tendons_j: mechanism.springs_j(leg, self.unstretched_m()),
            joint_j: support.joint_energy(&leg.direction, leg.torsion_rad),
            weights_j: mechanism.load.energy(&leg.direction),
        }
    }

    fn unstretched_m(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.unstretched_at_zero_m[i] - self.motors[i].screw.slider_m)
    }
}
