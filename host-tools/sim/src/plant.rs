//! The simulated leg: rigid body, tendons, motors, gears, screws and sensors, as the board sees them through its raw
//! interface.
//!
//! A step of the integration is symmetric and of second order: half a step of the positions ("drift"), half of currents
//! and speeds ("kick"), a whole kick of the leg's rotation, and the same halves in reverse order. Everything is f64 and
//! follows from the seed, and no tick allocates.

mod advance;
mod build;
mod cell_defects;
mod configuration;
pub(crate) mod defect;
mod dynamics;
mod encoder;
mod energy;
mod hand;
mod inertia;
mod leg;
mod motor;
mod noise;
mod payload;
mod push;
mod screw;
mod sensing;
mod start;
mod supply;
mod tendon_pull;
mod truth;

#[cfg(test)]
mod tests;

pub use defect::Defect;
pub use start::Start;
pub use truth::Truth;

use defect::Defects;
use dynamics::Dynamics;
use encoder::Encoder;
use energy::Work;
use fastrand::Rng;
use hand::Hand;
use inertia::Inertia;
use leg::LegState;
use leg_base::tick_time::tick_s;
use leg_firmware::sensors::Sensors;
use leg_rig::actuator::Actuator;
use motor::{Motor, MotorType};
use nalgebra::Vector3;
use payload::Payload;
use push::Push;
use sensing::{Cells, code};
use supply::Supply;

/// A simulated leg with its actuators and sensors.
#[derive(Clone, Debug)]
pub struct Plant {
    actuators: [Actuator; 3],
    dynamics: Dynamics,
    /// The leg without a payload.
    bare: Inertia,
    leg: LegState,
    motor_types: [MotorType; 3],
    motors: [Motor; 3],
    supply: Supply,
    /// Temperature of all drivers, °C.
    temperature_c: f64,
    ambient_c: f64,
    encoders: [Encoder; 3],
    cells: Cells,
    /// What each current sensor shows without a current, A.
    current_offset_a: [f64; 3],
    defects: Defects,
    /// Of the defects that are random, but for those of the cells.
    rng: Rng,
    /// Whether each motor's plug makes contact.
    contacts: [bool; 3],
    emergency_stop: bool,
    payload: Payload,
    push: Push,
    hand: Hand,
    unstretched_at_zero_m: [f64; 3],
    /// Tension of each tendon now, N.
    tensions_n: [f64; 3],
    work: Work,
    /// Ticks since the start.
    pub(crate) ticks: u64,
    substeps: u32,
}

/// What a defective current sensor reads too much, A.
const CURRENT_OFFSET_A: f64 = 10.0;

/// What a dry screw takes at the motor, N·m; play of a worn gear, rad of the screw.
const DRY_NM: f64 = 0.05;
const WORN_RAD: f64 = 1.0;

/// How far a tendon slips at its clamp, m.
const SLIP_M: f64 = 5e-3;

impl Plant {
    /// Reads every sensor.
    pub fn sense(&mut self) -> Sensors {
        let pulls_n = self.hand.pulls_n(self.tensions_n);
        let duties = self.motors.map(|motor| motor.duty);
        let cell_codes = self.cells.read(pulls_n, duties, &self.defects, self.ticks);
        let defects = &self.defects;
        // The supply and the temperature are the board's, so every actuator says the same of them.
        let [actuator, ..] = &self.actuators;
        let current_code =
            |i: usize| code(self.current_shown_a(i), self.actuators[i].current_ends_a());
        Sensors {
            encoder_counts: self.encoder_counts(),
            cell_codes,
            current_codes: std::array::from_fn(current_code),
            supply_code: code(
                self.supply.voltage_v(&self.motors),
                [0.0, actuator.supply_range_v],
            ),
            temperature_code: code(self.temperature_c, actuator.temperature_range_c),
            cell_fresh: defects.affected(Defect::CellStale).map(|stale| !stale),
            driver_fault: defects.affected(Defect::DriverFault),
            emergency_stop: self.emergency_stop,
            late: defects.has(Defect::LateTicks),
            settings_corrupt: defects.has(Defect::SettingsCorrupt),
        }
    }

    /// What the sensor of a motor's current shows, A.
    fn current_shown_a(&self, i: usize) -> f64 {
        let (defects, motor) = (&self.defects, &self.motors[i]);
        let [lowest_a, _] = self.actuators[i].current_ends_a();
        let current_a = sensing::output_a(self.actuators[i].current_output, motor);
        let disabled = motor.open && defects.has(Defect::CurrentFullScaleDisabled(i));
        if defects.has(Defect::CurrentFullScale(i)) || disabled {
            self.actuators[i].current_range_a
        } else if defects.has(Defect::CurrentDead(i)) {
            lowest_a
        } else if defects.has(Defect::CurrentZero(i)) {
            self.current_offset_a[i]
        } else if defects.has(Defect::CurrentOffset(i)) {
            current_a + self.current_offset_a[i] + CURRENT_OFFSET_A
        } else {
            current_a + self.current_offset_a[i]
        }
    }

    /// Lets the payload at the tip change linearly to `target_kg` (at least zero) in `over_s`; 0 is at once.
    pub fn set_payload(&mut self, target_kg: f64, over_s: f64) {
        self.payload.set(target_kg, over_s);
    }

    /// Presses or releases the emergency stop. It only signals the board, which has to switch the drivers off.
    pub fn press_emergency_stop(&mut self, pressed: bool) {
        self.emergency_stop = pressed;
    }

    /// Lets a defect begin or end.
    pub fn set_defect(&mut self, defect: Defect, on: bool) {
        let before_j = self.energy_j();
        let changed = self.defects.set(defect, on, self.ticks);
        if changed {
            self.begin_or_end(defect, on);
        }
        self.dynamics.cut = self.defects.affected(Defect::TendonCut);
        if let (Defect::TendonCut(tendon), true, false) = (defect, changed, on) {
            self.replace_tendon(tendon);
        }
        self.work.cut_j += before_j - self.energy_j();
        self.tensions_n = self.pulls_n();
    }

    /// Each defect that has begun and not ended.
    pub fn defects(&self) -> impl Iterator<Item = Defect> + '_ {
        self.defects.all()
    }

    /// What a defect does once, when it begins or ends.
    fn begin_or_end(&mut self, defect: Defect, on: bool) {
        match defect {
            Defect::TendonSlips(i) if on => self.unstretched_at_zero_m[i] += SLIP_M,
            Defect::EncoderSlipsQuarter(i) if on => {
                let quarter = (0.25 * self.actuators[i].counts_per_turn) as u16;
                let counter = &mut self.encoders[i].counter;
                *counter = counter.wrapping_add(quarter);
            }
            Defect::ScrewDry(i) => self.motors[i].dry_nm = if on { DRY_NM } else { 0.0 },
            Defect::GearPlay(i) => {
                let actuator = &self.actuators[i];
                let play_rad = if on { WORN_RAD } else { actuator.backlash_rad };
                self.motors[i].screw.set_play(actuator, play_rad);
            }
            Defect::LegGrasped => self.hand.grasped_m = on.then(|| self.tip_m()),
            _ => {}
        }
    }

    fn encoder_counts(&self) -> [u16; 3] {
        let [first, second, third] = self.encoders.map(|encoder| encoder.counter);
        if self.defects.has(Defect::EncodersSwapped) {
            [second, first, third]
        } else {
            [first, second, third]
        }
    }

    /// Length of each tendon without tension when its encoder has counted to zero, m: what a perfect homing finds. The
    /// gear then touches as after reeling in.
    #[must_use]
    pub fn unstretched_at_zero_m(&self) -> [f64; 3] {
        self.unstretched_at_zero_m
    }

    /// The state as it is.
    #[must_use]
    pub fn truth(&self) -> Truth {
        Truth {
            time_s: self.time_s(),
            direction: self.leg.direction,
            torsion_rad: self.leg.torsion_rad,
            rate_rad_per_s: self.leg.rate,
            tip_m: self.tip_m(),
            tensions_n: self.tensions_n,
            unstretched_m: self.unstretched_m(),
            payload_kg: self.payload.now_kg,
            currents_a: self.motors.map(|motor| motor.current_a),
            speeds_rad_per_s: self.motors.map(|motor| motor.speed),
            supply_v: self.supply.voltage_v(&self.motors),
        }
    }

    /// Time since the start, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.ticks as f64 * tick_s()
    }

    fn tip_m(&self) -> Vector3<f64> {
        self.dynamics.tip_m(&self.leg)
    }

    fn unstretched_m(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.unstretched_at_zero_m[i] - self.motors[i].screw.slider_m)
    }
}
