//! Where the loops are broken: between the firmware and the simulated leg, so that the firmware needs no hook.

use super::frequency_response::{ClosedLoop, Sides};
use crate::stand::Stand;
use leg_firmware::drive::Drive;
use leg_firmware::sensors::{CODE_MAX, Sensors};
use leg_firmware::supervisor::State;
use leg_sim::emulated_leg::SignalChange;

/// A break point.
#[derive(Clone, Debug)]
pub(super) enum BreakPoint {
    /// The duty of a motor, as its voltage at the nominal supply, V.
    Motor { motor: usize, supply_v: f64 },
    /// A sum of what the load cells show.
    Cells(CellBreak),
}

/// A break point at the load cells: what is added comes to all three in fixed parts, and the loop is broken for one sum of
/// their tensions.
#[derive(Clone, Debug)]
pub(super) struct CellBreak {
    /// Tension of each cell by what is added, N.
    pub per_added_n: [f64; 3],
    /// The sum: part of the tension of each cell. By what is added it is 1.
    pub weights: [f64; 3],
    /// Part of the length without tension of each tendon in the same sum: zero where the tensions alone are looked at.
    pub length_weights: [f64; 3],
    pub n_per_code: [f64; 3],
}

/// A leg with a break point.
#[derive(Clone)]
pub(super) struct BrokenLoop {
    pub stand: Stand,
    pub at: BreakPoint,
}

impl ClosedLoop for BrokenLoop {
    fn tick(&mut self, added: f64) -> Result<Sides, String> {
        let mut tap = Tap {
            at: &self.at,
            added,
            unstretched_m: self.stand.truth.unstretched_m,
            sides: Sides {
                returned: 0.0,
                injected: 0.0,
            },
        };
        self.stand.tick_through(&mut tap)?;
        let sides = tap.sides;
        self.stand.require_no_fault()?;
        if self.stand.state() == State::Active {
            Ok(sides)
        } else {
            Err("the leg does not stay active".into())
        }
    }
}

struct Tap<'a> {
    at: &'a BreakPoint,
    added: f64,
    unstretched_m: [f64; 3],
    sides: Sides,
}

impl SignalChange for Tap<'_> {
    fn sensors(&mut self, sensors: &mut Sensors) {
        let BreakPoint::Cells(cells) = self.at else {
            return;
        };
        self.sides = Sides {
            returned: 0.0,
            injected: 0.0,
        };
        for (i, code) in sensors.cell_codes.iter_mut().enumerate() {
            let by_code = cells.weights[i] * cells.n_per_code[i];
            let length = cells.length_weights[i] * self.unstretched_m[i];
            self.sides.returned += by_code * f64::from(*code) + length;
            let added = (cells.per_added_n[i] * self.added / cells.n_per_code[i]).round();
            *code = (f64::from(*code) + added).clamp(0.0, f64::from(CODE_MAX)) as u16;
            // What was really added: whole codes.
            self.sides.injected += by_code * f64::from(*code) + length;
        }
    }

    fn motors(&mut self, motors: &mut Drive<f32>) {
        let &BreakPoint::Motor { motor, supply_v } = self.at else {
            return;
        };
        let duty = &mut motors.duty[motor];
        let returned = f64::from(*duty) * supply_v;
        *duty = (*duty + (self.added / supply_v) as f32).clamp(-1.0, 1.0);
        self.sides = Sides {
            returned,
            injected: f64::from(*duty) * supply_v,
        };
    }
}
