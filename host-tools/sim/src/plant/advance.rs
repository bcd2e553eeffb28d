//! One tick of the simulated leg.

use super::Plant;
use super::defect::Defect;
use super::encoder::EncoderDefect;
use super::energy::Work;
use super::motor::Wiring;
use super::scene::Scene;
use leg_base::tick_time::tick_s;
use leg_firmware::drive::Drive;
use leg_model::Load;

/// The supply when it sags, V.
const SAGGED_V: f64 = 11.0;

/// A supply that surges, V.
const SURGED_V: f64 = 32.0;

impl Plant {
    /// Advances by one tick under a drive.
    pub fn step(&mut self, drive: &Drive<f32>) {
        self.wire(drive);
        self.change_payload();
        self.turn_by_hand();
        self.mechanism.push_n = self.push.force_n(self.time_s());
        for _ in 0..self.substeps {
            self.substep();
        }
        self.count();
        self.cells.drift(tick_s(), &self.defects);
        let heating = self.defects.has(Defect::Overheating);
        self.temperature.advance(tick_s(), heating);
        self.tensions_n = self.pulls_n();
        self.ticks += 1;
    }

    /// What the drive and the defects make of motors and supply.
    fn wire(&mut self, drive: &Drive<f32>) {
        let jammed = self.defects.of_three(Defect::MotorJammed);
        let failed = self.defects.of_three(Defect::DriverFault);
        for (i, motor) in self.motors.iter_mut().enumerate() {
            let open = failed[i] || !drive.enabled || drive.duty[i].is_nan();
            motor.wiring = Wiring {
                duty: if open {
                    0.0
                } else {
                    f64::from(drive.duty[i]).clamp(-1.0, 1.0)
                },
                open,
                jammed: jammed[i],
            };
        }
        self.supply.open_v = if self.defects.has(Defect::SupplySag) {
            SAGGED_V
        } else if self.defects.has(Defect::SupplySurge) {
            SURGED_V
        } else {
            self.actuator.supply_v
        };
    }

    /// Lets the payload change; the leg keeps its rotation.
    fn change_payload(&mut self) {
        let before_kg = self.payload.now_kg;
        self.payload.advance(tick_s());
        let payload_kg = self.payload.now_kg;
        if payload_kg == before_kg {
            return;
        }
        let before_j = self.energy().total_j();
        let tip_m = self.mechanism.rig.tip_m();
        self.mechanism.body = self.bare.loaded(payload_kg, tip_m);
        self.mechanism.load =
            Load::new(&self.mechanism.rig, payload_kg).unwrap_or(self.mechanism.load);
        self.work.payload_j += self.energy().total_j() - before_j;
    }

    fn substep(&mut self) {
        let half_s = self.motor_type.half_s();
        self.drift(half_s);
        self.supply.drive(&mut self.motors, &self.motor_type);
        let scene = self.mechanism.scene(&self.leg, self.unstretched_m());
        self.kick_motors(&scene);
        let sliders = self.motors.map(|motor| motor.slider_m_per_s());
        self.work += self
            .mechanism
            .kick(&mut self.leg, &scene, sliders, 2.0 * half_s);
        self.kick_motors(&scene);
        self.supply.drive(&mut self.motors, &self.motor_type);
        self.drift(half_s);
    }

    fn drift(&mut self, half_s: f64) {
        let (support, body) = (&self.mechanism.support, &self.mechanism.body);
        self.work += Work {
            stop_j: self.leg.drift(support, body, half_s),
            ..Work::default()
        };
        for motor in &mut self.motors {
            motor.drift(&self.motor_type);
        }
    }

    fn kick_motors(&mut self, scene: &Scene) {
        let sliders = self.motors.map(|motor| motor.slider_m_per_s());
        let pulls = self.mechanism.pulls_n(scene, &self.leg.rate, sliders);
        for (motor, pull) in self.motors.iter_mut().zip(pulls) {
            motor.kick(&self.motor_type, pull);
        }
    }

    fn count(&mut self) {
        let [lost, slipping, reversed] = [
            Defect::EncoderLost,
            Defect::EncoderSlipping,
            Defect::EncoderReversed,
        ]
        .map(|kind| self.defects.of_three(kind));
        for (i, encoder) in self.encoders.iter_mut().enumerate() {
            let defect = EncoderDefect {
                lost: lost[i],
                slipping: slipping[i],
                reversed: reversed[i],
            };
            encoder.follow(
                self.motors[i].angle_rad,
                self.actuator.counts_per_turn,
                defect,
            );
        }
    }

    /// Tension of each tendon now, N.
    pub(super) fn pulls_n(&self) -> [f64; 3] {
        let scene = self.mechanism.scene(&self.leg, self.unstretched_m());
        let sliders = self.motors.map(|motor| motor.slider_m_per_s());
        self.mechanism.pulls_n(&scene, &self.leg.rate, sliders)
    }
}
