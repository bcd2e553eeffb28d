//! What a leg asks of a file as a whole, beyond what its mechanism does.

mod lean;

use super::RigFile;
use super::consistency::{Warning, own_path, place_of};
use crate::actuator::ACTUATOR;
use crate::calibration::CALIBRATION;
use crate::gains::CONTROL;
use crate::mechanism_keys::key_of;
use crate::number::{decimal, plain};
use crate::plant_settings::{SIMULATION, TRANSVERSE_INERTIA};
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::TendonParameters;
use leg_model::{Error, Rig};
use std::fmt::Display;

/// Refuses a file of a leg with which none runs, and warns of one that may describe no more than a mechanism.
pub(super) fn check(file: &RigFile, root: &Section<'_>) -> Result<Option<Warning>, TomlError> {
    let Err(error) = check_leg(file, root) else {
        return Ok(lean::warning(file, root));
    };
    if [ACTUATOR, CALIBRATION, CONTROL, SIMULATION]
        .iter()
        .any(|section| root.has(section))
    {
        return Err(error);
    }
    let TomlError {
        span,
        sentence,
        help,
    } = error;
    let text = format!("no leg runs with it: {sentence}; {help}");
    Ok(Some(Warning { span, text }))
}

fn check_leg(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    check_inertia(file, root)?;
    check_bands(file, root)?;
    check_hanging(file, root)?;
    check_rounded(file).map_err(|error| refused(error, root))
}

/// The firmware has its mechanism in f32, in which a small number may be none and two that are near may be one.
fn check_rounded(file: &RigFile) -> Result<(), Error> {
    let round = |value: f64| value as f32;
    Rig::new(&file.parameters.map(round))?;
    let rounded = |tendon| TendonParameters::from_tendon(tendon, round);
    TendonParameters::validated_all::<f32>(&file.tendons.each_ref().map(rounded))?;
    Ok(())
}

/// A leg without inertia, in the firmware's f32, has no motion.
fn check_inertia(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    let inertia = file.plant.transverse_inertia_kg_m2(&file.parameters);
    if inertia as f32 > 0.0 {
        return Ok(());
    }
    let key = if file.parameters.leg_mass_kg > 0.0 {
        "centroid_mm"
    } else {
        "leg_kg"
    };
    Err(TomlError::new(
        root.place(&["mass", key]).unwrap_or(0..0),
        format!(
            "`{key}` is too small: the leg's inertia about its joint, 4/3 of `leg_kg` by the square of `centroid_mm`, is no \
             more than {} kg·m²",
            plain(inertia)
        ),
        format!(
            "give a greater one, or the inertia as `{}` in `[{SIMULATION}]`",
            TRANSVERSE_INERTIA.name
        ),
    ))
}

/// A leg hangs straight down when it is homed and armed, without a payload.
fn check_hanging(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    let hanging = leg_model::evaluate(&file.parameters, &file.query(0.0, 0.0, 0.0));
    let refused = |why: &dyn Display| {
        TomlError::new(
            root.place(&["tendon", "pretension_n"]).unwrap_or(0..0),
            format!(
                "the leg is not held straight down at `pretension_n` ({}): {why}",
                plain(file.pretension_n)
            ),
            "see the units of `[geometry]`, `[mass]` and of the tendon's stiffness, and look at `leg eval`",
        )
    };
    match hanging {
        // Said elsewhere, at its own place.
        Err(Error::Refused { .. }) => Ok(()),
        Err(error) => Err(refused(&error)),
        Ok(pose) if !pose.feasible => Err(refused(&Error::Infeasible)),
        Ok(_) => Ok(()),
    }
}

/// Pretensions keep off the highest tension by the band in which a motor is slowed down.
fn check_bands(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    // As the firmware judges it, in f32.
    let (f_min_n, f_max_n) = (file.f_min_n as f32, file.f_max_n as f32);
    for (motor, servo) in file.gains.servos.iter().enumerate() {
        if f_max_n - servo.f_max_band_n < f_min_n {
            let band = place_of(&["control", "servo", "f_max_band_n"], motor, root);
            let place = band.or_else(|| root.place(&["tendon", "f_max_n"]));
            return Err(TomlError::new(
                place.unwrap_or(0..0),
                format!(
                    "`f_max_band_n` ({}) leaves no tension between `tendon.f_min_n` ({}) and `tendon.f_max_n` ({})",
                    plain(decimal(servo.f_max_band_n)),
                    plain(file.f_min_n),
                    plain(file.f_max_n)
                ),
                "give a smaller band, or a higher `f_max_n`",
            ));
        }
    }
    // The firmware keeps all targets off by the greatest.
    let bands = file.gains.servos.map(|servo| servo.f_max_band_n);
    let greatest_n = bands.into_iter().fold(0.0, f32::max);
    let highest_n = f_max_n - greatest_n;
    if file.pretension_n as f32 <= highest_n {
        return Ok(());
    }
    let motor = bands.iter().position(|band| *band == greatest_n);
    let band = own_path("control.servo.f_max_band_n", motor.unwrap_or(0), root);
    Err(TomlError::new(
        root.place(&["tendon", "pretension_n"]).unwrap_or(0..0),
        format!(
            "no pretension is led nearer to `tendon.f_max_n` ({}) than `{band}` ({}), so `pretension_n` ({}) is not reached",
            plain(file.f_max_n),
            plain(decimal(greatest_n)),
            plain(file.pretension_n)
        ),
        format!("give at most {}", plain(decimal(highest_n))),
    ))
}

/// What is refused in f32, at its place.
fn refused(error: Error, root: &Section<'_>) -> TomlError {
    if let Error::Refused { quantity, reason } = error
        && let Some((section, key)) = key_of(quantity)
    {
        let span = root.place(&[section, key]).unwrap_or(0..0);
        return TomlError::refused(span, key, reason);
    }
    TomlError::new(
        root.place(&["tendon"]).unwrap_or(0..0),
        format!("the tendons with the digits of the firmware's f32: {error}"),
        "give fewer points, or some that are farther from each other",
    )
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::{RigFile, RigText};

    /// What makes a file that of a leg.
    const LEG: &str = "\n[simulation]\ncell_noise_n = 0.1\n";

    /// The paper's rig with other lines, and with more at its end.
    fn changed(lines: &[(&str, &str)], more: &str) -> String {
        let mut text = READY_RIGS[0].text.to_owned();
        for (line, other) in lines {
            assert!(text.contains(line), "{line}");
            text = text.replace(line, other);
        }
        text + more
    }

    #[track_caller]
    fn assert_refused(text: &str, at: &str, sentence: &str, help: &str) {
        let failure = RigFile::parse("a.toml", text).unwrap_err();
        let message = failure.render(false);
        for part in [at, sentence, help] {
            assert!(message.contains(part), "{part}: {message}");
        }
    }

    fn notes(text: &str) -> Vec<String> {
        let [name, text] = ["a.toml", text].map(str::to_owned);
        let (_, notes) = RigText { name, text }.read().unwrap();
        notes
    }

    /// One that may be no more than a mechanism is taken, with a warning.
    #[track_caller]
    fn assert_warned(text: &str, sentence: &str, help: &str) {
        let [note] = &notes(text)[..] else {
            panic!("{:?}", notes(text));
        };
        for part in [
            "a.toml: warning: no leg runs with it: ",
            sentence,
            help,
            " (line ",
        ] {
            assert!(note.contains(part), "{part}: {note}");
        }
    }

    #[test]
    fn a_leg_without_inertia_is_refused_unless_the_file_gives_it() {
        let help = "`leg_transverse_inertia_kg_m2` in `[simulation]`";
        for (line, other, key) in [
            ("leg_kg = 1.5", "leg_kg = 0", "leg_kg"),
            ("leg_kg = 1.5", "leg_kg = 1e-300", "centroid_mm"),
            ("centroid_mm = 91", "centroid_mm = 0", "centroid_mm"),
        ] {
            let text = changed(&[(line, other)], "");
            let sentence = format!("`{key}` is too small: the leg's inertia");
            let leg = text.clone() + LEG;
            assert_refused(&leg, &format!("{key} = "), &sentence, help);
            assert_warned(&text, &sentence, help);
            let given = "\n[simulation]\nleg_transverse_inertia_kg_m2 = 0.02\n";
            RigFile::parse("a.toml", &(text + given)).unwrap();
        }
        // 5 g with their centroid at 30 mm are a leg.
        let light = [
            ("leg_kg = 1.5", "leg_kg = 0.005"),
            ("centroid_mm = 91", "centroid_mm = 30"),
        ];
        RigFile::parse("a.toml", &changed(&light, "")).unwrap();
    }

    #[test]
    fn a_pretension_within_the_band_is_refused() {
        let text = |pretension_n| {
            let line = format!("pretension_n = {pretension_n}");
            changed(&[("pretension_n = 70", &line)], LEG)
        };
        // What is offered is taken, as the firmware's f32 rounds it, too.
        let odd = |pretension_n| {
            let lines = [
                ("f_max_n = 150", String::from("f_max_n = 22.8")),
                (
                    "pretension_n = 70",
                    format!("pretension_n = {pretension_n}"),
                ),
            ];
            let lines = lines
                .each_ref()
                .map(|(line, other)| (*line, other.as_str()));
            changed(&lines, "\n[control.servo]\nf_max_band_n = 3.7\n")
        };
        let error = RigFile::parse("a.toml", &odd("20"))
            .unwrap_err()
            .render(false);
        let (_, offered) = error.split_once("give at most ").unwrap();
        RigFile::parse("a.toml", &odd(offered.trim())).unwrap();
        let sentence = "so `pretension_n` (147) is not reached";
        assert_refused(
            &text(147),
            "pretension_n = 147",
            sentence,
            "give at most 146",
        );
        RigFile::parse("a.toml", &text(146)).unwrap();
        // The greatest of three bands counts, and is named.
        let bands = |pretension_n| {
            let own =
                "\n[control.servo.1]\nf_max_band_n = 6\n[control.servo.3]\nf_max_band_n = 10\n";
            text(pretension_n) + own
        };
        let named = "`control.servo.3.f_max_band_n` (10)";
        assert_refused(&bands(148), named, "(148)", "give at most 140");
        RigFile::parse("a.toml", &bands(140)).unwrap();
    }

    /// Where the units of one section are other ones, there is no leg.
    #[test]
    fn a_leg_that_cannot_be_held_is_refused_or_warned_of() {
        let tilt = notes(&changed(&[("tilt_deg = 30", "tilt_deg = 60")], LEG));
        let [note] = &tilt[..] else {
            panic!("{tilt:?}");
        };
        assert!(note.contains("at `tilt_deg` (60): 57 would do"), "{note}");
        // What is offered is taken.
        for (pretension_n, words) in [("20", "(20) is raised"), ("140", "(140) is lowered")] {
            let line = format!("pretension_n = {pretension_n}");
            let leaning = notes(&changed(&[("pretension_n = 70", &line)], LEG));
            let [note] = &leaning[..] else {
                panic!("{leaning:?}");
            };
            assert!(note.contains(words), "{note}");
            let (_, offered) = note.split_once("limit: ").unwrap();
            let (offered, _) = offered.split_once(' ').unwrap();
            let line = format!("pretension_n = {offered}");
            let better = notes(&changed(&[("pretension_n = 70", &line)], LEG));
            assert!(better.is_empty(), "{offered}: {better:?}");
        }
        assert_refused(
            &changed(
                &[(
                    "[[24, 0], [-12, 20.784609690826528], [-12, -20.784609690826528]]",
                    "[[0.024, 0], [-0.012, 0.0208], [-0.012, -0.0208]]",
                )],
                LEG,
            ),
            "pretension_n = 70",
            "the leg is not held straight down at `pretension_n` (70)",
            "see the units of `[geometry]`",
        );
    }

    #[test]
    fn a_band_that_leaves_no_tension_is_refused() {
        let sentence = "`f_max_band_n` (143) leaves no tension";
        let help = "give a smaller band, or a higher `f_max_n`";
        for section in ["control.servo", "control.servo.2"] {
            let more = |band_n| format!("\n[{section}]\nf_max_band_n = {band_n}\n");
            let text = changed(&[], &more(143));
            assert_refused(&text, "f_max_band_n = 143", sentence, help);
            let low = [("pretension_n = 70", "pretension_n = 8")];
            RigFile::parse("a.toml", &changed(&low, &more(142))).unwrap();
        }
        // By its default, too.
        let narrow = changed(
            &[
                ("f_max_n = 150", "f_max_n = 72"),
                ("f_min_n = 8", "f_min_n = 69"),
            ],
            "",
        );
        assert_warned(&narrow, "(4) leaves no tension", "a smaller band");
    }

    /// In f64 these leave 3.9999999999999996 N.
    #[test]
    fn a_band_is_judged_as_by_the_firmware() {
        let exact = [
            ("f_max_n = 150", "f_max_n = 9.7"),
            ("f_min_n = 8", "f_min_n = 5.7"),
            ("pretension_n = 70", "pretension_n = 5.7"),
        ];
        let text = changed(&exact, "");
        let bands = notes(&text)
            .into_iter()
            .filter(|note| note.contains("band"));
        assert_eq!(bands.count(), 0);
    }

    #[test]
    fn what_is_nothing_in_the_firmware_s_f32_is_named() {
        let text = changed(&[("joint_mm = 29", "joint_mm = 1e-300")], "");
        let sentence = "`joint_mm` must be greater than zero";
        assert_warned(&text, sentence, "correct the value");
        let leg = text + LEG;
        assert_refused(&leg, "joint_mm = 1e-300", sentence, "correct the value");
    }
}
