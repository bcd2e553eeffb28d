//! What is done to the simulated leg from outside: loads, pushes, defects.

use super::{Push, Simulation};
use leg_sim::action::Action;
use leg_sim::plant::Defect;

/// Time in which a payload is hung on, s.
const PAYLOAD_OVER_S: f64 = 0.4;

impl Simulation {
    /// Hangs a payload on the tip, kg.
    pub fn hang(&mut self, payload_kg: f64) {
        self.payload_kg = payload_kg;
        self.act(&Action::Payload {
            kg: payload_kg,
            over_s: PAYLOAD_OVER_S,
        });
    }

    /// Pushes at the tip.
    pub fn push(&mut self, azimuth_deg: f64, force_n: f64, for_s: f64) {
        self.push = Some(Push {
            azimuth_deg,
            force_n,
            until_s: self.leg.time_s() + for_s,
        });
        self.act(&Action::Push {
            azimuth_deg,
            force_n,
            for_s,
        });
    }

    /// Breaks something, or repairs it.
    pub fn set_defect(&mut self, defect: Defect, on: bool) {
        self.act(&if on {
            Action::Fault(defect)
        } else {
            Action::Repair(defect)
        });
    }

    fn act(&mut self, action: &Action) {
        action.apply(self.leg.leg_mut().plant_mut());
    }

    /// Repairs everything.
    pub fn repair(&mut self) {
        let defects: Vec<Defect> = self.defects().collect();
        for defect in defects {
            self.act(&Action::Repair(defect));
        }
    }

    /// What is broken.
    pub fn defects(&self) -> impl Iterator<Item = Defect> + '_ {
        self.leg.leg().plant().defects()
    }

    /// Whether the leg has a defect.
    #[must_use]
    pub fn has(&self, defect: Defect) -> bool {
        self.defects().any(|other| other == defect)
    }

    /// The push that is going on.
    #[must_use]
    pub const fn pushed(&self) -> Option<Push> {
        self.push
    }

    /// Hangs a weight on a load cell in the place of its tendon, N, or puts the tendon back. Cells are counted from 0.
    pub fn hang_on_cell(&mut self, cell: usize, weight_n: Option<f64>) {
        let plant = self.leg.leg_mut().plant_mut();
        plant.hang_on_cell(cell, weight_n);
    }

    /// Lets a hand turn a motor once, so that it reels its tendon in. Motors are counted from 0.
    pub fn turn_motor(&mut self, motor: usize) {
        self.leg.leg_mut().plant_mut().turn_motor(motor, 1.0);
    }
}
