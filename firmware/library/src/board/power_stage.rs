//! The three bridges and what switches them on and off.

use super::{Bridge, BridgeOutput, Gate, GateAction};
use crate::drive::Drive;

/// The pins and registers of a power stage.
pub trait PowerPins {
    /// Sets the pulse width and the direction of a motor, 0 to 2; the width takes effect at the timer's next update.
    fn set(&mut self, motor: usize, half: BridgeOutput);

    /// Lets the drivers' enable line follow, and the timer's outputs; a break that is present keeps the latter off.
    fn switch(&mut self, on: bool);

    /// Whether the timer's outputs are on: hardware may have switched them off.
    fn is_on(&self) -> bool;
}

/// The power stage of three motors.
#[derive(Clone, Debug)]
pub struct PowerStage<P> {
    pins: P,
    top: u16,
    gate: Gate,
    bridges: [Bridge; 3],
}

impl<P: PowerPins> PowerStage<P> {
    /// Off, on pins whose timer counts to `top`.
    pub fn new(pins: P, top: u16) -> Self {
        let mut stage = Self {
            pins,
            top,
            gate: Gate::Closed,
            bridges: [Bridge::new(); 3],
        };
        stage.rest();
        stage
    }

    /// Passes on what a tick asks of the motors.
    #[inline(always)]
    pub fn drive(&mut self, drive: &Drive<f32>) {
        match self.gate.step(drive.enabled, self.pins.is_on()) {
            GateAction::Open => {
                self.pins.switch(true);
                self.set(drive);
            }
            GateAction::Keep => self.set(drive),
            GateAction::Close => self.rest(),
        }
    }

    /// Off at once, and until a drive is not enabled.
    pub fn cut(&mut self) {
        self.gate.cut();
        self.rest();
    }

    /// Whether the outputs are off although the leg drives.
    #[inline(always)]
    pub fn lost(&self) -> bool {
        self.gate.lost(self.pins.is_on())
    }

    /// What the pins are.
    pub fn pins(&mut self) -> &mut P {
        &mut self.pins
    }

    #[inline(always)]
    fn set(&mut self, drive: &Drive<f32>) {
        for (motor, (bridge, &duty)) in self.bridges.iter_mut().zip(&drive.duty).enumerate() {
            self.pins.set(motor, bridge.convert(duty, self.top));
        }
    }

    #[inline(always)]
    fn rest(&mut self) {
        self.pins.switch(false);
        for (motor, bridge) in self.bridges.iter_mut().enumerate() {
            self.pins.set(motor, bridge.rest());
        }
    }
}
