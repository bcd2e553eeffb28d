//! One line of `leg eval`'s input.

use crate::json_entries::{self, Entries};
use crate::line_error::LineError;
use leg_base::suggest;
use leg_model::{Query, RigParameters, StiffnessAt, StiffnessDemand, Support, Tendon};
use leg_rig::rig_file::RigFile;
use leg_rig::support_name::SupportName;

/// The keys that a line has to give.
const REQUIRED: [&str; 3] = ["azimuth_deg", "tilt_deg", "payload_kg"];

/// All keys.
const KEYS: [&str; 13] = [
    "azimuth_deg",
    "tilt_deg",
    "payload_kg",
    "level_n",
    "stiffness_n_per_m",
    "stiffness_at",
    "f_min_n",
    "f_max_n",
    "leg_mass_kg",
    "l_upper_m",
    "support",
    "demand_nm_per_rad",
    "demand_towards_deg",
];

/// The shortest line that has a result.
pub const EXAMPLE: &str = r#"{"azimuth_deg":30,"tilt_deg":20,"payload_kg":1}"#;

/// What a line asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseLine {
    /// The rig file's mechanism with the line's changes.
    pub rig: RigParameters<f64, 3>,
    /// The pose, the load and what holds it.
    pub query: Query<f64>,
}

/// What the keys of a line have said so far.
struct Draft {
    rig: RigParameters<f64, 3>,
    query: Query<f64>,
    demand_nm_per_rad: Option<f64>,
    demand_towards_deg: Option<f64>,
}

impl PoseLine {
    /// Reads one line; what it leaves out comes from the rig file.
    ///
    /// # Errors
    /// A [`LineError`] that names the key and the fix.
    pub fn parse(text: &[u8], defaults: &RigFile) -> Result<Self, LineError> {
        let Entries(entries) = json_entries::parse(text).map_err(LineError::NotAnObject)?;
        let mut draft = Draft {
            rig: defaults.parameters,
            query: defaults.query(0.0, 0.0, 0.0),
            demand_nm_per_rad: None,
            demand_towards_deg: None,
        };
        for (index, (key, value)) in entries.iter().enumerate() {
            if entries[..index].iter().any(|(earlier, _)| earlier == key) {
                return Err(LineError::Repeated(key.clone()));
            }
            draft.set(key, value.get(), defaults)?;
        }
        let given = |key: &str| entries.iter().any(|(given, _)| given == key);
        match REQUIRED.iter().find(|key| !given(key)) {
            Some(key) => Err(LineError::MissingKey(key)),
            None => draft.line(),
        }
    }
}

impl Draft {
    fn line(self) -> Result<PoseLine, LineError> {
        let demand = match (self.demand_nm_per_rad, self.demand_towards_deg) {
            (None, None) => None,
            (None, Some(_)) => return Err(LineError::NoDemand),
            (Some(stiffness_nm_per_rad), towards_deg) => Some(StiffnessDemand {
                stiffness_nm_per_rad,
                towards_rad: towards_deg.map(f64::to_radians),
            }),
        };
        Ok(PoseLine {
            rig: self.rig,
            query: Query {
                demand,
                ..self.query
            },
        })
    }

    fn set(&mut self, key: &str, value: &str, defaults: &RigFile) -> Result<(), LineError> {
        let Some(key) = KEYS.into_iter().find(|known| *known == key) else {
            return Err(LineError::UnknownKey {
                key: key.into(),
                remedy: suggest::key_remedy(key, &KEYS),
            });
        };
        let query = &mut self.query;
        match key {
            "azimuth_deg" => query.azimuth_rad = number(key, value)?.to_radians(),
            "tilt_deg" => query.tilt_rad = number(key, value)?.to_radians(),
            "payload_kg" => query.payload_kg = number(key, value)?,
            "level_n" => query.pretension_n = number(key, value)?,
            "stiffness_n_per_m" => query.tendons = [Tendon::constant(number(key, value)?)?; 3],
            "stiffness_at" => query.stiffness_at = stiffness_at(value)?,
            "f_min_n" => query.f_min_n = number(key, value)?,
            "f_max_n" => query.f_max_n = number(key, value)?,
            "leg_mass_kg" => self.rig.leg_mass_kg = number(key, value)?,
            "demand_nm_per_rad" => self.demand_nm_per_rad = Some(number(key, value)?),
            "demand_towards_deg" => self.demand_towards_deg = Some(number(key, value)?),
            "l_upper_m" => self.rig.upper_length_m = number(key, value)?,
            _ => query.support = support(value, defaults)?,
        }
        Ok(())
    }
}

fn number(key: &'static str, value: &str) -> Result<f64, LineError> {
    match kind(value) {
        "a number" => {}
        found => return Err(LineError::NotANumber { key, found }),
    }
    match value.parse() {
        Ok(number) if f64::is_finite(number) => Ok(number),
        _ => Err(LineError::NotFinite(key, value.into())),
    }
}

/// A rigid support, or the elastic one that the rig file describes.
fn support(value: &str, defaults: &RigFile) -> Result<Support<f64>, LineError> {
    let name = SupportName::parse(&word("support", value)?).map_err(LineError::Support)?;
    if name == defaults.support_name {
        Ok(defaults.support)
    } else if name.elastic() {
        Err(LineError::NotInRigFile {
            asked: name.word(),
            described: defaults.support_name.word(),
        })
    } else {
        Ok(name.kind().into())
    }
}

fn stiffness_at(value: &str) -> Result<StiffnessAt, LineError> {
    match word("stiffness_at", value)?.as_str() {
        "pretension" => Ok(StiffnessAt::Pretension),
        "tension" => Ok(StiffnessAt::Tension),
        other => Err(LineError::StiffnessAt(other.into())),
    }
}

fn word(key: &'static str, value: &str) -> Result<String, LineError> {
    let found = kind(value);
    serde_json::from_str(value).map_err(|_| LineError::NotAWord { key, found })
}

/// The kind of a JSON value, which its first character shows.
fn kind(value: &str) -> &'static str {
    match value.as_bytes().first() {
        Some(b'"') => "a string",
        Some(b'[') => "an array",
        Some(b'{') => "an object",
        Some(b't' | b'f') => "a truth value",
        Some(b'n') => "null",
        _ => "a number",
    }
}
