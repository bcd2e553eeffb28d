//! Whether motors, sensors and limits go together.

use super::RigFile;
use super::actuator::ACTUATOR;
use crate::calibration::COUNT_RANGE_M;
use crate::control_section::CONTROL;
use crate::fields::{decimal, plain};
use crate::toml_problem::{Fault, Problem};
use crate::toml_section::Section;
use std::ops::Range;

/// What several values of `[actuator]` make up.
struct Outcome {
    what: &'static str,
    value: f64,
    range: [f64; 2],
    keys: &'static str,
}

/// Two values, the first of which has to be below the second.
struct Pair {
    low: Side,
    high: Side,
    reason: &'static str,
}

/// One of them, with the sections in which it stands.
struct Side {
    sections: &'static [&'static str],
    key: &'static str,
    value: f64,
}

/// Refuses what does not go together. A file without these sections may describe no more than a mechanism.
pub(super) fn check(file: &RigFile, root: &Section<'_>) -> Result<(), Fault> {
    if root.has(ACTUATOR) {
        outcomes(file).iter().try_for_each(|one| one.check(root))?;
    }
    if root.has(ACTUATOR) || root.has(CONTROL) {
        supply(file).iter().try_for_each(|pair| pair.check(root))?;
        current(file).iter().try_for_each(|pair| pair.check(root))?;
        others(file).iter().try_for_each(|pair| pair.check(root))?;
    }
    Ok(())
}

fn outcomes(file: &RigFile) -> [Outcome; 4] {
    let actuator = &file.actuator;
    [
        Outcome {
            what: "the way of a tendon in one encoder count, m,",
            value: actuator.m_per_count(),
            range: COUNT_RANGE_M,
            keys: "`lead_m`, `gear_ratio` and `counts_per_turn`",
        },
        Outcome {
            what: "the voltage that a motor induces by the speed of its tendon, V·s/m,",
            value: actuator.back_emf_v_s_per_m(),
            range: [0.0, 1e5],
            keys: "`torque_constant_nm_per_a`, `gear_ratio` and `lead_m`",
        },
        Outcome {
            what: "the motor's mechanical time constant, s,",
            value: actuator.mechanical_time_s(),
            range: [2e-4, 10.0],
            keys: "`resistance_ohm`, `inertia_kg_m2` and `torque_constant_nm_per_a`",
        },
        Outcome {
            what: "how fast viscous friction stops the rotor, 1/s,",
            value: actuator.viscous_nm_s_per_rad / actuator.inertia_kg_m2,
            range: [0.0, 1e4],
            keys: "`viscous_nm_s_per_rad` and `inertia_kg_m2`",
        },
    ]
}

impl Outcome {
    fn check(&self, root: &Section<'_>) -> Result<(), Fault> {
        let [low, high] = self.range;
        if (low..=high).contains(&self.value) {
            return Ok(());
        }
        let [value, low, high] = [self.value, low, high].map(plain);
        Err(Fault {
            span: root.span_of_key(ACTUATOR).unwrap_or(0..0),
            problem: Problem::Outcome {
                what: self.what,
                found: format!("{value}, outside {low} to {high}").into(),
                keys: self.keys,
            },
        })
    }
}

fn supply(file: &RigFile) -> [Pair; 3] {
    let (actuator, limits) = (&file.actuator, &file.gains.limits);
    let lowest = Side::limit("supply_min_v", limits.supply_min_v);
    let highest = || Side::limit("supply_max_v", limits.supply_max_v);
    let nominal = || Side::actuator("supply_v", actuator.supply_v);
    let range = Side::actuator("supply_range_v", actuator.supply_range_v);
    let from_start = "else the supply is a fault from the start";
    [
        Pair::new(lowest, nominal(), from_start),
        Pair::new(nominal(), highest(), from_start),
        Pair::new(highest(), range, "else no sensor sees too high a supply"),
    ]
}

fn current(file: &RigFile) -> [Pair; 2] {
    let gains = &file.gains;
    let servo = Side {
        sections: &[CONTROL, "servo"],
        key: "current_a",
        value: decimal(gains.servo.current_a),
    };
    let limit = || Side::limit("current_a", gains.limits.current_a);
    let range = Side::actuator("current_range_a", file.actuator.current_range_a);
    [
        Pair::new(servo, limit(), "else the servo drives more than the limit"),
        Pair::new(limit(), range, "else no sensor sees too much current"),
    ]
}

fn others(file: &RigFile) -> [Pair; 3] {
    let (actuator, limits) = (&file.actuator, &file.gains.limits);
    let [_, hot_c] = actuator.temperature_range_c;
    let [_, taut_n] = actuator.cell_range_n;
    [
        Pair::new(
            Side::limit("temperature_c", limits.temperature_c),
            Side::actuator("temperature_range_c", hot_c),
            "else no sensor sees that the drivers are too hot",
        ),
        Pair::new(
            Side::tendon("f_max_n", file.f_max_n),
            Side::actuator("cell_range_n", taut_n),
            "else no load cell sees too much tension",
        ),
        Pair::new(
            Side::limit("slack_n", limits.slack_n),
            Side::tendon("f_min_n", file.f_min_n),
            "else a tendon at the minimum tension is taken as slack",
        ),
    ]
}

impl Pair {
    fn new(low: Side, high: Side, reason: &'static str) -> Self {
        Self { low, high, reason }
    }

    /// The place is that of a value that is given.
    fn check(&self, root: &Section<'_>) -> Result<(), Fault> {
        let Self { low, high, reason } = self;
        if low.value < high.value {
            return Ok(());
        }
        Err(Fault {
            span: high.span(root).or(low.span(root)).unwrap_or(0..0),
            problem: Problem::NotBelow {
                low: low.words().into(),
                high: high.words().into(),
                reason,
            },
        })
    }
}

impl Side {
    fn limit(key: &'static str, value: f32) -> Self {
        Self {
            sections: &[CONTROL, "limits"],
            key,
            value: decimal(value),
        }
    }

    fn actuator(key: &'static str, value: f64) -> Self {
        Self {
            sections: &[ACTUATOR],
            key,
            value,
        }
    }

    fn tendon(key: &'static str, value: f64) -> Self {
        Self {
            sections: &["tendon"],
            key,
            value,
        }
    }

    fn words(&self) -> String {
        let section = self.sections.join(".");
        format!("`{section}.{}` ({})", self.key, plain(self.value))
    }

    /// Its place in the file, if it is given.
    fn span(&self, root: &Section<'_>) -> Option<Range<usize>> {
        match self.sections {
            [outer, inner] => root.any_section(outer).ok()?.span_of(inner, self.key),
            [section] => root.span_of(section, self.key),
            _ => None,
        }
    }
}
