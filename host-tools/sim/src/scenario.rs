//! A scenario: how a simulated leg starts, what is done to it, and what must come out.

mod board_start;
mod command_step;
mod follow_step;
mod measurand;
mod reading;
mod step;
mod test_step;

pub use board_start::BOARD_EXCEPTIONS;
pub use command_step::CommandStep;
pub use follow_step::{CircleStep, FollowStep};
pub use measurand::Measurand;
pub use step::Step;
pub use test_step::{PushTest, TestStep};

use crate::plant::Start;
use crate::range;
use crate::ready_scenarios;
use leg_base::failure::Failure;
use leg_base::text_input::{self, FILE_BYTES_MAX};
use leg_firmware::supervisor::Fault;
use leg_rig::gains::GainChange;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use leg_rig::toml_error::TomlError;
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer};
use std::ops::Range;
use std::path::Path;

/// A scenario as its file describes it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// One sentence: what it shows.
    #[serde(deserialize_with = "range::title")]
    pub title: String,
    /// Seed of the noise.
    #[serde(default)]
    pub seed: u64,
    /// The rig unless the command names another: a ready rig.
    #[serde(default = "table_1")]
    pub rig: String,
    /// How the leg is at first.
    #[serde(default)]
    pub start: Start,
    /// The errors of the simulated leg.
    #[serde(default)]
    plant: PlantErrors,
    /// Gains and limits in the place of the rig's.
    #[serde(default, deserialize_with = "read_later")]
    pub control: Vec<GainChange>,
    /// Faults that may come beside those that a step waits for; any other one fails the scenario.
    #[serde(default)]
    pub expected: Vec<Fault>,
    /// What happens, one after the other.
    #[serde(deserialize_with = "read_sequence_later")]
    pub steps: Vec<Step>,
    /// Keys of the file that have new names, one sentence each.
    #[serde(skip)]
    pub notes: Vec<String>,
}

/// [`leg_rig::gains::read`] reads `[control]`, whose messages say more than serde's, and [`Step::read`] the steps.
fn read_later<'de, D: Deserializer<'de>, T>(deserializer: D) -> Result<Vec<T>, D::Error> {
    IgnoredAny::deserialize(deserializer)?;
    Ok(Vec::new())
}

/// The same, of which at least the form is checked here.
fn read_sequence_later<'de, D: Deserializer<'de>, T>(deserializer: D) -> Result<Vec<T>, D::Error> {
    Vec::<IgnoredAny>::deserialize(deserializer)?;
    Ok(Vec::new())
}

fn table_1() -> String {
    "table1".into()
}

/// The section `[plant]`. What is left out is zero; the cells' noise is then the rig's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct PlantErrors {
    #[serde(deserialize_with = "range::cell_gain_error_percent")]
    cell_gain_error_percent: [f64; 3],
    #[serde(deserialize_with = "range::cell_offset_n")]
    cell_offset_n: [f64; 3],
    #[serde(deserialize_with = "range::cell_noise_n")]
    cell_noise_n: Option<f64>,
    #[serde(deserialize_with = "range::curve_error_percent")]
    curve_error_percent: f64,
}

/// What is wrong with a piece of the text.
fn refused(sentence: String, span: Option<Range<usize>>) -> TomlError {
    let help = "see the ready scenarios for what there is";
    TomlError::new(span.unwrap_or_default(), sentence, help)
}

impl Scenario {
    /// The scenario of a file or, where there is no such file, the ready one of that name.
    ///
    /// # Errors
    /// A [`Failure`] with the place.
    pub fn load(path: &Path) -> Result<Self, Failure> {
        let name = path.display().to_string();
        match text_input::read_file(path, FILE_BYTES_MAX) {
            Ok(text) => Self::parse(&name, &text),
            Err(error) => match ready_scenarios::named(&name) {
                Some(ready) => Self::parse(&format!("scenarios/{name}.toml"), ready.text),
                None => Err(Failure::refused(
                    format!("cannot read the scenario {name}: {error}"),
                    format!("give a file, or one of: {}", ready_scenarios::names()),
                )),
            },
        }
    }

    /// The text of a scenario; `file` is its name in messages.
    ///
    /// # Errors
    /// A [`Failure`] with the place.
    pub fn parse(file: &str, text: &str) -> Result<Self, Failure> {
        reading::read(text).map_err(|error| error.failure(file, text))
    }

    /// The same with load cells that are off by a percentage, its sign changing from one to the next, and tendons that
    /// stretch farther than by their curves.
    #[must_use]
    pub fn with_errors(&self, cell_percent: f64, curve_percent: f64) -> Self {
        let mut scenario = self.clone();
        scenario.plant.cell_gain_error_percent = [cell_percent, -cell_percent, cell_percent];
        scenario.plant.curve_error_percent = curve_percent;
        scenario
    }

    /// The simulated leg beside its rig's mechanism and actuator: as the rig file says, with the scenario's errors.
    #[must_use]
    pub fn plant(&self, rig: &RigFile) -> PlantSettings {
        let errors = self.plant;
        PlantSettings {
            cell_gain_error: errors
                .cell_gain_error_percent
                .map(|percent| percent / 100.0),
            cell_offset_n: errors.cell_offset_n,
            cell_noise_n: errors.cell_noise_n.unwrap_or(rig.plant.cell_noise_n),
            curve_error: errors.curve_error_percent / 100.0,
            ..rig.plant
        }
    }
}
