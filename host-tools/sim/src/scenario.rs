//! A scenario: how a simulated leg starts, what is done to it, and what must come out.

mod check;
mod step;

pub use step::{Quantity, Step};

use crate::plant::Start;
use crate::ready_scenarios;
use leg_base::failure::{Failure, Place};
use leg_firmware::supervisor::Fault;
use leg_rig::control_section;
use leg_rig::gains::GainChange;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use leg_rig::toml_section::Section;
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer};
use std::ops::Range;
use std::path::Path;
use toml::de::DeTable;

/// A scenario as its file describes it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// One sentence: what it shows.
    pub title: String,
    /// Seed of the noise.
    #[serde(default)]
    pub seed: u64,
    /// The rig unless the command names another: a ready rig.
    #[serde(default = "table_1")]
    pub rig: String,
    /// How the leg is at first.
    #[serde(default)]
    start: StartText,
    /// What the simulated leg is beside its rig.
    #[serde(default)]
    plant: PlantText,
    /// Gains and limits in the place of the rig's.
    #[serde(default, deserialize_with = "read_later")]
    pub control: Vec<GainChange>,
    /// Faults that may come beside those that a step waits for; any other one fails the scenario.
    #[serde(default)]
    pub expected: Vec<Fault>,
    /// What happens, one after the other.
    pub steps: Vec<Step>,
}

/// [`control_section::read`] reads `[control]`: of what is wrong it tells more than serde does.
fn read_later<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<GainChange>, D::Error> {
    IgnoredAny::deserialize(deserializer)?;
    Ok(Vec::new())
}

fn table_1() -> String {
    "table1".into()
}

/// How the leg starts. Held, it knows its zero; slack, it has to be homed.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum StartText {
    Slack {
        slack_mm: f64,
    },
    Held {
        azimuth_deg: f64,
        tilt_deg: f64,
        pretension_n: f64,
        payload_kg: f64,
    },
}

impl Default for StartText {
    fn default() -> Self {
        Self::Held {
            azimuth_deg: 0.0,
            tilt_deg: 0.0,
            pretension_n: 70.0,
            payload_kg: 0.0,
        }
    }
}

/// What the simulated leg is beside its rig; zero what is left out, but for the cells' noise, which is then the rig's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct PlantText {
    cell_gain_error_percent: [f64; 3],
    cell_offset_n: [f64; 3],
    cell_noise_n: Option<f64>,
    curve_error_percent: f64,
}

impl Scenario {
    /// The scenario of a file or, where there is no such file, the ready one of that name.
    ///
    /// # Errors
    /// A [`Failure`] with the place.
    pub fn load(path: &Path) -> Result<Self, Failure> {
        let name = path.display().to_string();
        match std::fs::read_to_string(path) {
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
        let refused = |error: toml::de::Error| {
            Failure::refused_at(
                error.message().to_string(),
                "see the ready scenarios for what there is",
                place(file, text, error.span().unwrap_or(0..0)),
            )
        };
        let scenario: Self = toml::from_str(text).map_err(refused)?;
        check::check(&scenario).map_err(|refused| {
            Failure::refused(
                format!("{file}: {refused}"),
                "see the ready scenarios for what there is",
            )
        })?;
        let table = DeTable::parse(text).map_err(refused)?;
        let root = Section::unchecked(table.get_ref());
        let control = control_section::read(&root).map_err(|fault| {
            let problem = &fault.problem;
            let place = place(file, text, fault.span);
            Failure::refused_at(problem.to_string(), problem.fix(), place)
        })?;
        Ok(Self {
            control,
            ..scenario
        })
    }

    /// How the leg starts.
    #[must_use]
    pub fn start(&self) -> Start {
        match self.start {
            StartText::Slack { slack_mm } => Start::Slack {
                slack_m: slack_mm / 1000.0,
            },
            StartText::Held {
                azimuth_deg,
                tilt_deg,
                pretension_n,
                payload_kg,
            } => Start::Held {
                azimuth_deg,
                tilt_deg,
                pretension_n,
                payload_kg,
            },
        }
    }

    /// The same with load cells that are off by a percentage, its sign changing from one to the next, and tendons that
    /// stretch farther than by their curves.
    #[must_use]
    pub fn with_errors(&self, cell_percent: f64, curve_percent: f64) -> Self {
        let plant = PlantText {
            cell_gain_error_percent: [cell_percent, -cell_percent, cell_percent],
            curve_error_percent: curve_percent,
            ..self.plant
        };
        Self {
            plant,
            ..self.clone()
        }
    }

    /// Whether the leg has to be homed.
    #[must_use]
    pub fn starts_slack(&self) -> bool {
        matches!(self.start, StartText::Slack { .. })
    }

    /// What the simulated leg is beside its rig's mechanism and actuator: as the rig file says, with the scenario's
    /// errors.
    #[must_use]
    pub fn plant(&self, rig: &RigFile) -> PlantSettings {
        let text = self.plant;
        PlantSettings {
            cell_gain_error: text.cell_gain_error_percent.map(|percent| percent / 100.0),
            cell_offset_n: text.cell_offset_n,
            cell_noise_n: text.cell_noise_n.unwrap_or(rig.plant.cell_noise_n),
            curve_error: text.curve_error_percent / 100.0,
            ..rig.plant
        }
    }
}

fn place(file: &str, text: &str, span: Range<usize>) -> Place {
    Place {
        file: file.into(),
        text: text.into(),
        span,
    }
}
