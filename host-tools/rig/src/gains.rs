//! Gains and limits of the control law, and changes to them key by key.

use crate::actuator::Actuator;
use leg_firmware::settings::{Estimation, Homing, Limits, Motion, Servo};

/// Gains and limits, by the sections of the settings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gains {
    /// How the leg moves.
    pub motion: Motion,
    /// How a motor follows.
    pub servo: Servo,
    /// How pose and load are estimated.
    pub estimation: Estimation,
    /// What is taken as a fault.
    pub limits: Limits,
    /// How the zero is found.
    pub homing: Homing,
}

/// One gain that is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainChange {
    /// The section's number, as in [`SECTIONS`](leg_firmware::settings::SECTIONS).
    pub section: usize,
    /// The field's number in the section.
    pub field: usize,
    /// Its value.
    pub value: f32,
}

impl Gains {
    /// The defaults, the resistance and the induced voltage being those of the motor. The currents that friction and a pull
    /// take are not computed: a data sheet does not tell them well, so another motor needs its own in `[control.servo]`.
    #[must_use]
    pub fn defaults(actuator: &Actuator) -> Self {
        Self {
            servo: Servo {
                back_emf_v_s_per_m: actuator.back_emf_v_s_per_m() as f32,
                resistance_ohm: actuator.resistance_ohm as f32,
                ..Servo::default()
            },
            ..Self::default()
        }
    }

    /// The same with other values where any are given.
    #[must_use]
    pub fn with(mut self, changes: &[GainChange]) -> Self {
        for change in changes {
            let mut sections = self.values_mut();
            let section = sections.get_mut(change.section);
            if let Some(value) = section.and_then(|fields| fields.get_mut(change.field)) {
                **value = change.value;
            }
        }
        self
    }

    /// Every value by section and field, in the order of [`SECTIONS`](leg_firmware::settings::SECTIONS).
    #[must_use]
    pub fn values(&self) -> [Vec<f32>; 5] {
        [
            self.motion.values().into(),
            self.servo.values().into(),
            self.estimation.values().into(),
            self.limits.values().into(),
            self.homing.values().into(),
        ]
    }

    fn values_mut(&mut self) -> [Vec<&mut f32>; 5] {
        [
            self.motion.values_mut().into(),
            self.servo.values_mut().into(),
            self.estimation.values_mut().into(),
            self.limits.values_mut().into(),
            self.homing.values_mut().into(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::{GainChange, Gains};
    use leg_firmware::settings::SECTIONS;

    #[test]
    fn every_gain_changes_alone() {
        for (section, (_, fields)) in SECTIONS.iter().enumerate() {
            for field in 0..fields.len() {
                let change = GainChange {
                    section,
                    field,
                    value: -1.0,
                };
                let mut expected = Gains::default().values();
                expected[section][field] = -1.0;
                assert_eq!(Gains::default().with(&[change]).values(), expected);
            }
        }
    }
}
