//! The board under an emulated leg: the power stage of the real one, on pins that are only kept.

use leg_firmware::board::timing::PWM_TOP;
use leg_firmware::board::{BridgeOutput, FaultLines, LowerHalf, PowerPins, PowerStage};
use leg_firmware::drive::Drive;
use leg_firmware::sensors::Sensors;

/// A board whose sensors an emulator reads and whose pins it looks at.
#[derive(Clone, Debug)]
pub struct VirtualBoard {
    sensors: Sensors,
    stage: PowerStage<Pins>,
}

/// Pins that are kept, behind the break of a timer.
#[derive(Clone, Debug, Default)]
struct Pins {
    halves: [BridgeOutput; 3],
    on: bool,
    /// Whether a line holds the break now.
    broken: bool,
}

impl PowerPins for Pins {
    fn set(&mut self, motor: usize, half: BridgeOutput) {
        if let Some(kept) = self.halves.get_mut(motor) {
            *kept = half;
        }
    }

    fn switch(&mut self, on: bool) {
        self.on = on && !self.broken;
    }

    fn is_on(&self) -> bool {
        self.on
    }
}

impl Default for VirtualBoard {
    fn default() -> Self {
        Self {
            sensors: Sensors::default(),
            stage: PowerStage::new(Pins::default(), PWM_TOP),
        }
    }
}

impl VirtualBoard {
    /// Takes what the sensors read from now on. A raised fault line or a pressed emergency stop breaks the outputs, as the
    /// timer does it: at once, and not by the leg.
    pub fn read(&mut self, sensors: &Sensors) {
        self.sensors = *sensors;
        let pins = self.stage.pins();
        pins.broken = sensors.emergency_stop || sensors.driver_fault.contains(&true);
        pins.on &= !pins.broken;
    }

    /// What the motors get: the pulses' share of their period, and whether the outputs are on.
    pub fn motors(&mut self) -> Drive<f32> {
        let pins = self.stage.pins();
        Drive {
            duty: pins.halves.map(share),
            enabled: pins.on,
        }
    }
}

impl LowerHalf for VirtualBoard {
    fn sense(&mut self) -> Sensors {
        let lines = FaultLines {
            drivers: self.sensors.driver_fault,
            stop: self.sensors.emergency_stop,
            lost: self.stage.lost(),
            ..FaultLines::default()
        };
        let faults = lines.faults();
        Sensors {
            driver_fault: faults.drivers,
            emergency_stop: faults.stop,
            ..self.sensors
        }
    }

    fn drive(&mut self, drive: &Drive<f32>) {
        self.stage.drive(drive);
    }

    fn cut(&mut self) {
        self.stage.cut();
    }
}

fn share(half: BridgeOutput) -> f32 {
    let share = f32::from(half.compare) / f32::from(PWM_TOP);
    if half.forward { share } else { -share }
}
