//! One tick of the simulated leg.

use super::Plant;
use super::configuration::Configuration;
use super::defect::Defect;
use leg_base::tick_time::tick_s;
use leg_firmware::drive::Drive;
use leg_model::Load;

/// The supply when it sags, V.
const SAGGED_V: f64 = 11.0;

/// The supply while it dips, V, and how long it does, s.
const DIPPED_V: f64 = 12.0;
const DIP_S: f64 = 5e-3;

/// How long a loose plug makes contact or not, ticks.
const CONTACT_TICKS: u64 = 80;

/// How fast a tendon creeps, m/s.
const CREEP_M_PER_S: f64 = 1e-4;

/// A supply that surges, V.
const SURGED_V: f64 = 32.0;

/// How fast the drivers' temperature rises in overheating, and falls after it, K/s.
const RISE_K_PER_S: f64 = 20.0;

impl Plant {
    /// Advances by one tick under a drive.
    pub fn step(&mut self, drive: &Drive<f32>) {
        self.wire(drive);
        self.change_payload();
        self.turn_by_hand();
        self.creep();
        self.dynamics.push_n = self.push.force_n(self.time_s()) + self.grasp_n();
        for _ in 0..self.substeps {
            self.substep();
        }
        let turned = self.motors.iter().zip(&self.actuators);
        for (encoder, (motor, actuator)) in self.encoders.iter_mut().zip(turned) {
            encoder.follow(motor.angle_rad, actuator.counts_per_turn, &self.defects);
            encoder.jump(&self.defects, &mut self.rng);
        }
        self.cells.advance(tick_s(), &self.defects);
        let heating_k = RISE_K_PER_S * tick_s();
        self.temperature_c = if self.defects.has(Defect::Overheating) {
            self.temperature_c + heating_k
        } else {
            (self.temperature_c - heating_k).max(self.ambient_c)
        };
        self.tensions_n = self.pulls_n();
        self.ticks += 1;
    }

    /// What the drive and the defects make of motors and supply.
    fn wire(&mut self, drive: &Drive<f32>) {
        let jammed = self.defects.affected(Defect::MotorJammed);
        let failed = self.defects.affected(Defect::DriverFault);
        let inwards = self.defects.affected(Defect::HalfBridgeOpen);
        let outwards = self.defects.affected(Defect::HalfBridgeOpenOutwards);
        let full = self.defects.affected(Defect::DriverFullOn);
        let stuck = self.defects.affected(Defect::DirectionStuck);
        let apart = self.loose_plugs();
        for (i, motor) in self.motors.iter_mut().enumerate() {
            let asked = f64::from(drive.duty[i]).clamp(-1.0, 1.0);
            let duty = match (full[i], stuck[i]) {
                (true, _) => 1.0,
                (false, true) => asked.abs(),
                (false, false) => asked,
            };
            let undriven = (inwards[i] && duty > 0.0) || (outwards[i] && duty < 0.0);
            motor.open = failed[i] || undriven || apart[i] || !drive.enabled || duty.is_nan();
            motor.duty = if motor.open { 0.0 } else { duty };
            motor.jammed = jammed[i];
        }
        self.supply.open_v = if self.defects.has(Defect::SupplySag) {
            SAGGED_V
        } else if self.dips() {
            DIPPED_V
        } else if self.defects.has(Defect::SupplySurge) {
            SURGED_V
        } else {
            let [actuator, ..] = &self.actuators;
            actuator.supply_v
        };
    }

    /// Which motors' plugs make no contact.
    fn loose_plugs(&mut self) -> [bool; 3] {
        let loose = self.defects.affected(Defect::MotorIntermittent);
        if self.ticks.is_multiple_of(CONTACT_TICKS) && loose.contains(&true) {
            self.contacts = std::array::from_fn(|_| self.rng.bool());
        }
        std::array::from_fn(|i| loose[i] && !self.contacts[i])
    }

    /// What gives way a little in every tick.
    fn creep(&mut self) {
        let creeping = self.defects.affected(Defect::TendonCreeps);
        for (unstretched_m, creeps) in self.unstretched_at_zero_m.iter_mut().zip(creeping) {
            *unstretched_m += if creeps {
                CREEP_M_PER_S * tick_s()
            } else {
                0.0
            };
        }
    }

    /// Whether the supply's dip is not over.
    fn dips(&self) -> bool {
        let began = self.defects.first_tick(Defect::SupplyDip);
        began.is_some_and(|began| ((self.ticks - began) as f64) * tick_s() < DIP_S)
    }

    /// Lets the payload change; the leg keeps its rotation.
    fn change_payload(&mut self) {
        let before_kg = self.payload.now_kg;
        self.payload.advance(tick_s());
        let payload_kg = self.payload.now_kg;
        if payload_kg == before_kg {
            return;
        }
        let before_j = self.energy_j();
        let tip_m = self.dynamics.rig.tip_m();
        self.dynamics.inertia = self.bare.loaded(payload_kg, tip_m);
        self.dynamics.load =
            Load::new(&self.dynamics.rig, payload_kg).unwrap_or(self.dynamics.load);
        self.work.payload_j += self.energy_j() - before_j;
    }

    fn substep(&mut self) {
        let [first, ..] = &self.motor_types;
        let half_s = first.half_s;
        self.drift(half_s);
        self.supply.drive(&mut self.motors, &self.motor_types);
        let configuration = self.dynamics.configuration(&self.leg, self.unstretched_m());
        self.kick_motors(&configuration);
        let sliders = self.motors.map(|motor| motor.slider_m_per_s());
        let work = &mut self.work;
        self.dynamics
            .kick(&mut self.leg, &configuration, sliders, 2.0 * half_s, work);
        self.kick_motors(&configuration);
        self.supply.drive(&mut self.motors, &self.motor_types);
        self.drift(half_s);
    }

    fn drift(&mut self, half_s: f64) {
        let (support, inertia) = (&self.dynamics.support, &self.dynamics.inertia);
        self.work.stop_j += self.leg.drift(support, inertia, half_s);
        for motor in &mut self.motors {
            motor.turn(motor.speed * half_s);
        }
    }

    fn kick_motors(&mut self, configuration: &Configuration) {
        let sliders = self.motors.map(|motor| motor.slider_m_per_s());
        let pulls = self
            .dynamics
            .pulls_n(configuration, &self.leg.rate, sliders);
        let kinds = self.motor_types.iter().zip(pulls);
        for (motor, (kind, pull)) in self.motors.iter_mut().zip(kinds) {
            motor.kick(kind, pull);
        }
    }

    /// Tension of each tendon now, N.
    pub(super) fn pulls_n(&self) -> [f64; 3] {
        let configuration = self.dynamics.configuration(&self.leg, self.unstretched_m());
        let sliders = self.motors.map(|motor| motor.slider_m_per_s());
        self.dynamics
            .pulls_n(&configuration, &self.leg.rate, sliders)
    }
}
