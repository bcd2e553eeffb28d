//! The rig file: a leg with its actuators, its sensors and its controller's settings, in a human's units, read into SI.

mod buckling;
mod consistency;
pub mod derived;
mod reading;
mod support;
mod tendon;
mod whole_leg;

pub use buckling::Buckling;
pub use tendon::{ELONGATION_FACTOR, MEASURED_TENDON};

use crate::actuator::Actuator;
use crate::calibration::Calibration;
use crate::plant_settings::PlantSettings;
use crate::ready_rigs::{self, READY_RIGS};
use crate::support_name::SupportName;
use derived::GivenGains;
use leg_base::failure::Failure;
use leg_base::text_input::{self, FILE_BYTES_MAX};
use leg_firmware::settings::Gains;
use leg_firmware::settings::SignalSet;
use leg_model::{Elasticity, Query, RigParameters, StiffnessAt, Support, Tendon};
use std::path::Path;

/// A leg and how it is used, as its file describes them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigFile {
    /// The geometry and the masses.
    pub parameters: RigParameters<f64, 3>,
    /// The tendons: the file's curve or stiffness, by `elongation_factor`.
    pub tendons: [Tendon<f64>; 3],
    /// Their elongation over that by the file's curve or stiffness: 0.5 to 2, 1 where the leg has not measured it.
    pub elongation_factor: f64,
    /// At which tension their stiffness is read.
    pub stiffness_at: StiffnessAt,
    /// Lowest tension allowed, N.
    pub f_min_n: f64,
    /// Highest tension allowed, N.
    pub f_max_n: f64,
    /// Pretension, N per tendon at the vertical pose.
    pub pretension_n: f64,
    /// How far the leg leans at most, degrees.
    pub tilt_deg: f64,
    /// The central support's name.
    pub support_name: SupportName,
    /// The central support.
    pub support: Support<f64>,
    /// The load along the leg under which its flexures buckle, N; none where the file does not give their geometry.
    pub critical_n: Option<f64>,
    /// Motor, gear, screw and sensors of each tendon by their data sheets.
    pub actuators: [Actuator; 3],
    /// What was measured of the sensors.
    pub calibration: Calibration,
    /// Whether the leg may keep station after a command.
    pub keeps_station: bool,
    /// What the board's recorder keeps of the last ticks.
    pub recorded: SignalSet,
    /// Gains and limits of the control law.
    pub gains: Gains,
    /// Which of them the file gives; the others follow from the motors, or are at their defaults.
    pub given_gains: GivenGains,
    /// What else the simulated leg is.
    pub plant: PlantSettings,
}

impl RigFile {
    /// The rig of a file or, where there is no such file, the ready rig of that name; the paper's rig when neither is
    /// given. Notes on it are left out: [`RigText::read`] gives them.
    ///
    /// # Errors
    /// A [`Failure`] with the place.
    pub fn load(path: Option<&Path>) -> Result<Self, Failure> {
        let (rig, _) = RigText::load(path)?.read()?;
        Ok(rig)
    }

    /// The text of a rig file; `file` is its name in messages. Notes on it are left out, too.
    ///
    /// # Errors
    /// A [`Failure`] with the place.
    pub fn parse(file: &str, text: &str) -> Result<Self, Failure> {
        let [name, text] = [file, text].map(str::to_owned);
        let (rig, _) = RigText { name, text }.read()?;
        Ok(rig)
    }

    /// Stiffness of each tendon at the pretension, N/m.
    #[must_use]
    pub fn stiffnesses_n_per_m(&self) -> [f64; 3] {
        // The file was refused if a curve does not reach the pretension.
        let at_pretension =
            |tendon: Tendon<f64>| tendon.stiffness(self.pretension_n).unwrap_or(f64::NAN);
        self.tendons.map(at_pretension)
    }

    /// The pose at an azimuth and a tilt with a payload, everything else as the file says.
    #[must_use]
    pub fn query(&self, azimuth_deg: f64, tilt_deg: f64, payload_kg: f64) -> Query<f64> {
        Query {
            azimuth_rad: azimuth_deg.to_radians(),
            tilt_rad: tilt_deg.to_radians(),
            payload_kg,
            pretension_n: self.pretension_n,
            f_min_n: self.f_min_n,
            f_max_n: self.f_max_n,
            tendons: self.tendons,
            stiffness_at: self.stiffness_at,
            support: self.support,
            demand: None,
        }
    }
}

/// The text of a rig file and its name in messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RigText {
    /// The file, as the user named it, or a ready rig.
    pub name: String,
    /// Its text.
    pub text: String,
}

impl RigText {
    /// The rig that it describes, with notes on what it should say otherwise.
    ///
    /// # Errors
    /// A [`Failure`] with the place.
    pub fn read(&self) -> Result<(RigFile, Vec<String>), Failure> {
        let Self { name, text } = self;
        let (rig, notes) = reading::parse(text).map_err(|error| error.failure(name, text))?;
        let notes = notes.iter().map(|note| format!("{name}: {note}"));
        Ok((rig, notes.collect()))
    }

    /// The text that [`RigFile::load`] reads.
    ///
    /// # Errors
    /// A [`Failure`]: no such file, and no ready rig of that name.
    pub fn load(path: Option<&Path>) -> Result<Self, Failure> {
        let path = path.unwrap_or(Path::new(READY_RIGS[0].name));
        let name = path.display().to_string();
        match text_input::read_file(path, FILE_BYTES_MAX) {
            Ok(text) => Ok(Self { name, text }),
            Err(error) => match ready_rigs::named(&name) {
                Some(ready) => Ok(Self {
                    name: format!("rigs/{name}.toml"),
                    text: ready.text.into(),
                }),
                None => Err(Failure::refused(
                    format!("cannot read the rig file {name}: {error}"),
                    "give a file that exists and may be read, or a name from `leg rig list`",
                )),
            },
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::RigFile;
    use crate::ready_rigs::READY_RIGS;
    use leg_model::{CurvePoint, RigParameters, SupportKind, Tendon};

    #[test]
    fn the_bundled_file_is_the_models_table_1() {
        let file = RigFile::load(None).unwrap();
        assert_eq!(file.parameters, RigParameters::<f64, 3>::TABLE_1);
        assert_eq!(file.support, SupportKind::TorsionFree.into());
        let tendon = Tendon::curve(&CurvePoint::<f64>::PAPER).unwrap();
        assert_eq!(file.tendons, [tendon; 3]);
        assert_eq!(Some(file), RigFile::load(None).ok());
    }

    /// At the edge of the workspace such a leg leaves its tendons' curve, which is refused of a pose, and not of a file.
    #[test]
    fn a_pretension_above_the_highest_tension_is_refused() {
        for above in ["151", "199"] {
            let given = format!("pretension_n = {above}");
            let text = READY_RIGS[0].text.replace("pretension_n = 70", &given);
            let failure = RigFile::parse("above", &text).unwrap_err();
            assert!(failure.render(false).contains(&given), "{failure}");
        }
    }

    /// What is commented out at the end of the default rig is what there is without it.
    #[test]
    fn the_sections_that_may_be_left_out_are_shown_at_their_defaults() {
        let text = READY_RIGS[0].text;
        let shown: Vec<_> = text.lines().map(uncommented).collect();
        let given = RigFile::parse("shown", &shown.join("\n")).unwrap();
        let left_out = RigFile::parse("left out", text).unwrap();
        let nominal = left_out.calibration;
        assert_ne!(given.calibration.cell_n_per_code, nominal.cell_n_per_code);
        assert_ne!(given.given_gains, left_out.given_gains);
        let with_nominal = RigFile {
            calibration: nominal,
            given_gains: left_out.given_gains,
            ..given
        };
        assert_eq!(with_nominal, left_out);
    }

    /// Prose has a space after its #.
    fn uncommented(line: &str) -> &str {
        match line.strip_prefix('#') {
            Some(code) if !code.starts_with(' ') => code,
            _ => line,
        }
    }
}
