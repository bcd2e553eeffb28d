//! The settings of a board as a rig file that gives the same bits again.

use crate::actuator::ACTUATOR;
use crate::current_output::{self, CURRENT_OUTPUT};
use crate::gains::{CONTROL, KEEPS_STATION, groups};
use crate::motor_sections::motor_section;
use crate::number::{decimal, exact, exact_mm, exact_through, plain};
use crate::recorded_signals::{self, RECORDED};
use crate::support_name::SupportName;
use leg_firmware::sensors::CODE_MAX;
use leg_firmware::settings::{
    AxisCalibration, CurrentOutput, CurrentOutputs, SERVO, Servo, Settings, TendonParameters,
};
use leg_model::SupportKind;

const HEADING: &str = "# What a board is set to, as a rig file. The geometry of an elastic joint is not on the board: its stiffness stands \
here as if it\n# had been measured.\n";

/// The text of a rig file.
#[must_use]
pub fn rig_file(settings: &Settings) -> String {
    [
        HEADING.into(),
        geometry(settings),
        mass(settings),
        tendon(settings),
        workspace(settings),
        support(settings),
        control(settings),
        actuator(settings),
        calibration(&settings.axes),
    ]
    .concat()
}

fn list(numbers: impl IntoIterator<Item = String>) -> String {
    let numbers: Vec<String> = numbers.into_iter().collect();
    format!("[{}]", numbers.join(", "))
}

fn geometry(settings: &Settings) -> String {
    let rig = &settings.rig;
    let anchors = |points: [[f32; 2]; 3]| list(points.map(|point| list(point.map(exact_mm))));
    format!(
        "\n[geometry]\nupper_mm = {}\njoint_mm = {}\nleg_mm = {}\nbase_anchors_mm = {}\nleg_anchors_mm = {}\n",
        exact_mm(rig.upper_length_m),
        exact_mm(rig.joint_length_m),
        exact_mm(rig.leg_length_m),
        anchors(rig.base_anchors_m),
        anchors(rig.leg_anchors_m),
    )
}

fn mass(settings: &Settings) -> String {
    let rig = &settings.rig;
    format!(
        "\n[mass]\nleg_kg = {}\ncentroid_mm = {}\ngravity_m_per_s2 = {}\n",
        exact(rig.leg_mass_kg),
        exact_mm(rig.leg_centroid_m),
        exact(rig.gravity_m_per_s2),
    )
}

fn tendon(settings: &Settings) -> String {
    let bounds = format!(
        "\n[tendon]\nf_min_n = {}\nf_max_n = {}\npretension_n = {}\n",
        exact(settings.f_min_n),
        exact(settings.f_max_n),
        exact(settings.pretension_n),
    );
    let curves = "# Where a tendon's stiffness is read for the linear deviation; the board has no use for it.\n\
                  stiffness_at = \"pretension\"\n";
    match &settings.tendons {
        [TendonParameters::Constant(stiffness), ..] => {
            format!("{bounds}stiffness_n_per_m = {}\n", exact(*stiffness))
        }
        [a, b, c] if a == b && b == c => [bounds, curves.into(), curve("curve", a)].concat(),
        tendons => {
            let each = ["curve_1", "curve_2", "curve_3"].into_iter().zip(tendons);
            let each: String = each.map(|(name, tendon)| curve(name, tendon)).collect();
            [bounds, curves.into(), each].concat()
        }
    }
}

fn curve(name: &str, tendon: &TendonParameters) -> String {
    let TendonParameters::Curve(points) = tendon else {
        return String::new();
    };
    format!(
        "\n[tendon.{name}]\ntension_n = {}\nelongation_mm = {}\nstiffness_n_per_m = {}\n",
        list(points.iter().map(|point| exact(point.tension_n))),
        list(points.iter().map(|point| exact_mm(point.elongation_m))),
        list(points.iter().map(|point| exact(point.stiffness_n_per_m))),
    )
}

fn workspace(settings: &Settings) -> String {
    let sine = settings.tilt_max_sine;
    let tilt_deg = exact_through(libm::asin(f64::from(sine)).to_degrees(), sine, |tilt_deg| {
        libm::sin(tilt_deg.to_radians())
    });
    format!("\n[workspace]\ntilt_deg = {tilt_deg}\n")
}

fn support(settings: &Settings) -> String {
    let joint = &settings.joint;
    let elastic = joint.bending_nm_per_rad > 0.0;
    let name = match (settings.support, elastic) {
        (SupportKind::TorsionFree, _) => SupportName::TorsionFree,
        (SupportKind::Universal, _) => SupportName::Universal,
        (SupportKind::Spherical, false) => SupportName::Spherical,
        (SupportKind::Spherical, true) => SupportName::CompliantPivot,
        (SupportKind::ElasticUniversal, _) => SupportName::ElasticRodUniversal,
    };
    let mut text = format!("\n[support]\nkind = \"{}\"\n", name.word());
    if elastic {
        text += &format!(
            "bending_nm_per_rad = {}\ntorsion_nm_per_rad = {}\n",
            exact(joint.bending_nm_per_rad),
            exact(joint.torsion_nm_per_rad)
        );
    }
    let compliance = joint.axial_compliance_m_per_n;
    if compliance > 0.0 {
        let stiffness = exact_through(f64::from(compliance).recip(), compliance, f64::recip);
        text += &format!("axial_n_per_m = {stiffness}\n");
    }
    text
}

fn control(settings: &Settings) -> String {
    let gains = settings.gains();
    let mut values = gains.values();
    let mut text = format!(
        "\n[{CONTROL}]\n{KEEPS_STATION} = {}\n{RECORDED} = {}\n",
        settings.keeps_station,
        list(recorded_signals::words(settings.recorded).map(|word| format!("\"{word}\""))),
    );
    for group in groups() {
        let values: Vec<f32> = values.by_ref().take(group.fields.len()).collect();
        match group.motor {
            Some(0) => text += &servos(settings),
            Some(_) => {}
            None => {
                let keys = group.fields.iter().map(|field| field.name);
                text += &section(group.section, keys.zip(values));
            }
        }
    }
    text
}

fn section<'a>(name: &str, keys: impl Iterator<Item = (&'a str, f32)>) -> String {
    let keys = keys.map(|(key, value)| format!("{key} = {}\n", exact(value)));
    format!("\n[{CONTROL}.{name}]\n{}", keys.collect::<String>())
}

/// What the motors have in common once, and what each has otherwise for itself.
fn servos(settings: &Settings) -> String {
    let [first, ..] = settings.servos.each_ref().map(Servo::values);
    let keys = || Servo::FIELDS.iter().map(|field| field.name);
    let mut text = section(SERVO, keys().zip(first));
    for (motor, servo) in settings.servos.iter().enumerate() {
        let all = keys().zip(servo.values()).zip(first);
        let mut own = all.filter(|((_, value), first)| value != first).peekable();
        if own.peek().is_some() {
            text += &section(&motor_section(SERVO, motor), own.map(|(own, _)| own));
        }
    }
    text
}

fn actuator(settings: &Settings) -> String {
    let codes = f64::from(CODE_MAX);
    let board = &settings.board;
    let supply_v = exact_through(
        f64::from(board.supply_v_per_code) * codes,
        board.supply_v_per_code,
        |range| range / codes,
    );
    let cold_c = exact(board.temperature_at_zero_c);
    let cold: f64 = cold_c.parse().unwrap_or_default();
    let hot_c = exact_through(
        cold + f64::from(board.temperature_c_per_code) * codes,
        board.temperature_c_per_code,
        |hot| (hot - cold) / codes,
    );
    let limits = &settings.limits;
    let nominal_v = plain(0.5 * (decimal(limits.supply_min_v) + decimal(limits.supply_max_v)));
    let [first, ..] = &settings.axes;
    let [output, ..] = settings.current_outputs.each();
    let codes_beyond = codes - f64::from(output.zero_code());
    let current_a = plain(codes_beyond * f64::from(first.current_a_per_code));
    let cell_n = [0.0, codes].map(|code| {
        let zero_code = f64::from(first.cell_zero_code);
        plain((code - zero_code) * f64::from(first.cell_n_per_code))
    });
    format!(
        "\n# Only what the board knows of its sensors and its supply; what else there is of the actuators is by default.\n\
         [actuator]\nsupply_v = {nominal_v}\nsupply_range_v = {supply_v}\ncurrent_range_a = {current_a}\n\
         cell_range_n = {}\ntemperature_range_c = [{cold_c}, {hot_c}]\n",
        list(cell_n)
    ) + &current_outputs(settings.current_outputs)
}

/// What the outputs show that show no more than magnitudes, each for itself.
fn current_outputs(outputs: CurrentOutputs) -> String {
    let others = outputs
        .each()
        .into_iter()
        .enumerate()
        .filter(|(_, output)| *output != CurrentOutput::Bidirectional);
    others
        .map(|(motor, output)| {
            let (section, word) = (motor_section(ACTUATOR, motor), current_output::word(output));
            format!("\n[{section}]\n{CURRENT_OUTPUT} = \"{word}\"\n")
        })
        .collect()
}

fn calibration(axes: &[AxisCalibration; 3]) -> String {
    let each = |value: &dyn Fn(&AxisCalibration) -> f32| {
        list(axes.each_ref().map(|axis| exact(value(axis))))
    };
    let mut text = String::from("\n[calibration]\n");
    for (index, field) in AxisCalibration::FIELDS.iter().enumerate() {
        // The sign of a count has a key of its own.
        let value = |axis: &AxisCalibration| axis.values()[index];
        if field.signed {
            let (magnitudes, signs) = (
                each(&|axis| value(axis).abs()),
                each(&|axis| value(axis).signum()),
            );
            text += &format!("{} = {magnitudes}\ncounts_sign = {signs}\n", field.name);
        } else {
            text += &format!("{} = {}\n", field.name, each(&value));
        }
    }
    text
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::rig_file;
    use crate::control_settings;
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::RigFile;
    use leg_firmware::settings::Settings;
    use leg_firmware::settings::{RECORDED_SIGNALS, SignalSet};

    fn settings(file: &str, text: &str) -> Settings {
        let rig = RigFile::parse(file, text).unwrap();
        control_settings::settings(&rig, &rig.gains, None)
    }

    #[test]
    fn the_text_gives_the_same_bits_again() {
        for rig in READY_RIGS {
            let before = settings(rig.name, rig.text);
            let text = rig_file(&before);
            assert_eq!(settings("text", &text), before, "{}:\n{text}", rig.name);
        }
    }

    /// A motor, a supply and a load cell beyond what the defaults allow.
    #[test]
    fn another_motor_gives_the_same_bits_again() {
        let text = READY_RIGS[0].text.replace("f_max_n = 150", "f_max_n = 200");
        let more = "[actuator]\nsupply_v = 48\nsupply_range_v = 72\ncurrent_range_a = 40\nresistance_ohm = 0.3\n\
                    torque_constant_nm_per_a = 0.05\nfriction_nm = 0.02\ninertia_kg_m2 = 1e-5\ncell_range_n = [-30, 400]\ncounts_per_turn = 64\n";
        let before = settings("other", &[&text, more].concat());
        assert_eq!(settings("text", &rig_file(&before)), before);
    }

    #[test]
    fn odd_numbers_give_the_same_bits_again() {
        let mut rng = fastrand::Rng::with_seed(7);
        for _ in 0..200 {
            let mut before = settings(READY_RIGS[0].name, READY_RIGS[0].text);
            before.keeps_station = rng.bool();
            let signals = RECORDED_SIGNALS.into_iter().filter(|_| rng.bool());
            before.recorded = SignalSet::new(&signals.collect::<Vec<_>>());
            let mut spread = |value: &mut f32| *value *= 1.0 + 0.01 * rng.f32();
            spread(&mut before.rig.leg_length_m);
            spread(&mut before.tilt_max_sine);
            spread(&mut before.limits.following_m);
            spread(&mut before.board.supply_v_per_code);
            spread(&mut before.board.temperature_c_per_code);
            for axis in &mut before.axes {
                axis.m_per_count = -axis.m_per_count;
                spread(&mut axis.m_per_count);
                spread(&mut axis.cell_zero_code);
            }
            assert_eq!(settings("text", &rig_file(&before)), before);
        }
    }
}
