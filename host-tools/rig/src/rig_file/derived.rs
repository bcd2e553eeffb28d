//! Gains and limits that follow from the motors: each by a formula, unless the file gives it.
//!
//! The rules are applied in their order, so that a formula may use what stands above it, derived or given. What comes out has
//! two digits: no data sheet gives friction and efficiencies better. For the default actuator the rules give the defaults.

mod basis;
pub(crate) mod rules;
mod servo_loop;

pub(super) use basis::stretch_m;
pub(crate) use basis::{Basis, HOMING_MAX_N, TOUCH_N};
pub(crate) use servo_loop::ServoLoop;

use crate::gains::{CONTROL, GainChange, index_of, widened};
use crate::motor_sections::motor_section;
use crate::number::{decimal, plain, significant};
use crate::rig_file::RigFile;
use leg_firmware::settings::{Gains, Homing, Limits, Motion, SECTIONS, Servo};
use rules::{OfAll, RULES, Rule};
use serde::Serialize;

/// The gains that a rule of one motor uses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotorGains {
    pub servo: Servo,
    pub limits: Limits,
    pub homing: Homing,
    pub motion: Motion,
}

impl MotorGains {
    /// Of a motor, from 0.
    pub fn new(gains: &Gains, motor: usize) -> Self {
        Self {
            servo: gains.servos[motor],
            limits: gains.limits,
            homing: gains.homing,
            motion: gains.motion,
        }
    }
}

/// Which gains a file gives, one bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GivenGains(u128);

impl GivenGains {
    /// Those of the changes.
    pub(crate) fn new(changes: &[GainChange]) -> Self {
        let bits = changes.iter().map(|change| 1_u128 << change.index());
        Self(bits.fold(0, |all, bit| all | bit))
    }

    /// Whether the file gives this one, of a motor, from 0, where each has its own.
    pub(crate) fn has(self, section: &str, motor: usize, key: &str) -> bool {
        index_of(section, motor, key).is_some_and(|index| self.0 & (1 << index) != 0)
    }
}

/// The gains of a file: the given ones, those that follow from its motors, and the defaults.
pub(crate) fn gains(bases: &[Basis; 3], given: &Gains, which: GivenGains) -> Gains {
    let mut gains = *given;
    for rule in RULES {
        let values = rule.values(bases, &gains);
        for (motor, value) in values.into_iter().enumerate() {
            let index = index_of(rule.section, motor, rule.key).unwrap_or(usize::MAX);
            if !which.has(rule.section, motor, rule.key)
                && let Some(place) = gains.values_mut().nth(index)
            {
                *place = value as f32;
            }
        }
    }
    gains
}

/// A gain that can be derived.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DerivedGain {
    /// The section of the rig file.
    pub section: String,
    /// Its key, which ends with its unit.
    pub key: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The value in use.
    pub value: f64,
    /// What the formula gives.
    pub derived: f64,
    /// Whether the file gives the value in use.
    pub given: bool,
    /// The formula, by the keys that it uses.
    pub formula: String,
}

/// What follows from the motors of a file, in the order in which it is derived: for each motor where they differ.
#[must_use]
pub fn derived_gains(file: &RigFile) -> Vec<DerivedGain> {
    let bases = Basis::new_all(file);
    let mut all = Vec::new();
    for rule in RULES {
        let values = rule.values(&bases, &file.gains);
        let gain = |motor: usize| derived_gain(file, rule, motor, values[motor]);
        let [first, second, third] = [0, 1, 2].map(gain);
        if first == second && second == third {
            all.push(first);
            continue;
        }
        let own = [first, second, third].into_iter().enumerate();
        all.extend(own.map(|(motor, gain)| DerivedGain {
            section: motor_section(&gain.section, motor),
            ..gain
        }));
    }
    all
}

fn derived_gain(file: &RigFile, rule: &Rule, motor: usize, derived: f64) -> DerivedGain {
    let index = index_of(rule.section, motor, rule.key).unwrap_or(usize::MAX);
    let differ = file
        .actuators
        .iter()
        .any(|other| *other != file.actuators[0]);
    let formula = match rule.of_all.words() {
        Some(words) if differ => format!("{}; {words}", rule.formula),
        _ => rule.formula.into(),
    };
    DerivedGain {
        section: format!("{CONTROL}.{}", rule.section),
        key: rule.key,
        unit: rule.unit(),
        value: file.gains.values().nth(index).map_or(f64::NAN, decimal),
        derived: decimal(derived as f32),
        given: file.given_gains.has(rule.section, motor, rule.key),
        formula,
    }
}

/// The same as a table for people.
#[must_use]
pub fn table(gains: &[DerivedGain]) -> String {
    let mut table = format!(
        "\n{:<36} {:>9}  {:<7} {:<8}  formula\n",
        "follows from the motors", "value", "unit", ""
    );
    for gain in gains {
        let path = format!("{}.{}", gain.section, gain.key);
        let (origin, instead) = if gain.given {
            ("given", format!("instead of {}: ", plain(gain.derived)))
        } else {
            ("derived", String::new())
        };
        let value = plain(gain.value);
        table += &format!(
            "{path:<36} {value:>9}  {:<7} {origin:<8}  {instead}{}\n",
            gain.unit, gain.formula
        );
    }
    table
}

impl Rule {
    fn unit(&self) -> &'static str {
        self.field().unit
    }

    fn field(&self) -> leg_firmware::settings::Field<f64> {
        let sections = SECTIONS.iter().filter(|(name, _)| *name == self.section);
        let fields = sections.flat_map(|(_, fields)| *fields);
        let mut fields = fields.filter(|field| field.name == self.key);
        fields.next().map_or(rules::NO_FIELD, widened)
    }

    /// What the formula gives for each motor: the same where the motors have it together.
    pub fn values(&self, bases: &[Basis; 3], gains: &Gains) -> [f64; 3] {
        let value = |motor: usize| self.value(&bases[motor], &MotorGains::new(gains, motor));
        let values = [0, 1, 2].map(value);
        match self.of_all {
            OfAll::Each => values,
            OfAll::Least => [values.into_iter().fold(f64::INFINITY, f64::min); 3],
            OfAll::Greatest => [values.into_iter().fold(f64::NEG_INFINITY, f64::max); 3],
        }
    }

    /// What the formula gives for a motor, with two digits and within the range of the key.
    fn value(&self, basis: &Basis, gains: &MotorGains) -> f64 {
        let [low, high] = self.field().range;
        let value = (self.formula_value)(basis, gains);
        let value = if self.exact { value } else { two_digits(value) };
        value.clamp(low, high)
    }
}

/// The nearest number of two digits.
pub(crate) fn two_digits(value: f64) -> f64 {
    significant(value, 2)
}

/// A number of two digits that is not greater: one that would do where no more than `value` does.
pub(crate) fn two_digits_below(value: f64) -> f64 {
    let near = two_digits(value);
    if near <= value {
        return near;
    }
    let unit = 10_f64.powf(value.abs().log10().floor() - 1.0);
    two_digits(near - unit)
}

/// The same where no less does.
pub(crate) fn two_digits_above(value: f64) -> f64 {
    let near = two_digits(value);
    if near >= value {
        return near;
    }
    let unit = 10_f64.powf(value.abs().log10().floor() - 1.0);
    two_digits(near + unit)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Basis, derived_gains, rules::RULES, two_digits_above, two_digits_below};
    use crate::gains::index_of;
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::RigFile;
    use leg_firmware::settings::Gains;

    /// The defaults are those of the default actuator: its rules lead there again.
    #[test]
    fn the_default_actuator_derives_the_default_gains() {
        let rig = RigFile::load(None).unwrap();
        let bases = Basis::new_all(&rig);
        let defaults: Vec<f32> = Gains::default().values().collect();
        for (motor, rule) in (0..3).flat_map(|motor| RULES.iter().map(move |rule| (motor, rule))) {
            let default = defaults[index_of(rule.section, motor, rule.key).unwrap()];
            let derived = rule.values(&bases, &Gains::default())[motor] as f32;
            if rule.exact {
                assert!((derived / default - 1.0).abs() < 1e-3, "{}", rule.key);
            } else {
                assert_eq!(derived, default, "{}", rule.key);
            }
        }
    }

    #[test]
    fn a_given_value_stays_and_what_follows_from_it_changes() {
        let more = "[control.servo]\nfriction_a = 0.2\n[control.limits]\ncurrent_a = 9\n";
        let rig = RigFile::parse("more", &[READY_RIGS[0].text, more].concat()).unwrap();
        let found = derived_gains(&rig);
        let gain = |section: &str, key: &str| {
            let mut found = found.iter();
            found
                .find(|gain| gain.section == section && gain.key == key)
                .unwrap()
                .clone()
        };
        let friction = gain("control.servo", "friction_a");
        assert!(friction.given && friction.value == 0.2 && friction.derived == 0.1);
        let current = gain("control.servo", "current_a");
        assert!(!current.given && current.value == 4.4 && current.derived == 4.4);
        let limit = gain("control.limits", "current_a");
        assert!(limit.given && limit.value == 9.0 && limit.derived == 8.8);
    }

    #[test]
    fn numbers_that_would_do_have_two_digits_on_the_right_side() {
        for value in [0.0316, 99.6, 1.04, 0.0999, 12.0, 1005.0] {
            let (below, above) = (two_digits_below(value), two_digits_above(value));
            assert!(below <= value && value <= above, "{below} {value} {above}");
            assert!(above - below <= 0.1001 * value);
        }
    }
}
