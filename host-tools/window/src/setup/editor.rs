//! The settings while they are edited: every change is checked as a rig file is, and can be taken back.

use super::document;
use super::rows::{Row, rows, with_unit};
use leg_base::failure::Failure;
use leg_firmware::settings::Settings;
use leg_rig::control_settings;
use leg_rig::rig_file::{RigFile, RigText};
use toml_edit::{DocumentMut, Value};

/// Changes that can be taken back.
const UNDO_MAX: usize = 100;

/// A text that was accepted, and what it says.
#[derive(Clone, Debug)]
struct Version {
    document: DocumentMut,
    rig: RigFile,
    rows: Vec<Row>,
}

impl Version {
    fn new(name: &str, document: DocumentMut) -> Result<Self, Failure> {
        let source = RigText {
            name: name.into(),
            text: document.to_string(),
        };
        let (rig, _) = source.read()?;
        Ok(Self {
            rows: rows(&rig, &document),
            document,
            rig,
        })
    }
}

/// A change that was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// The section of what was to be changed.
    pub section: String,
    /// Its key.
    pub key: String,
    /// What is wrong, and what to do.
    pub words: String,
}

/// A setting that is not as it was loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// Section and key.
    pub name: String,
    /// As it was loaded, with its unit; none if it was not there.
    pub was: Option<String>,
    /// As it is, with its unit; none if it is not there any more.
    pub now: Option<String>,
    /// Whether it only follows from another one.
    pub follows: bool,
}

/// The settings of a leg.
#[derive(Clone, Debug)]
pub struct Editor {
    name: String,
    loaded: Version,
    now: Version,
    past: Vec<Version>,
    future: Vec<Version>,
    refused: Option<Refused>,
}

impl Editor {
    /// Those of a rig file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn new(source: &RigText) -> Result<Self, Failure> {
        // What is no TOML is refused with its place by the reader.
        source.read()?;
        let document = source.text.parse::<DocumentMut>();
        let document =
            document.map_err(|error| Failure::refused(error.to_string(), "save it as TOML 1.0"))?;
        let loaded = Version::new(&source.name, document)?;
        Ok(Self {
            name: source.name.clone(),
            now: loaded.clone(),
            loaded,
            past: Vec::new(),
            future: Vec::new(),
            refused: None,
        })
    }

    /// Gives a setting what was typed. Whether that was accepted; if not, [`Self::refused`] says why.
    pub fn set(&mut self, section: &str, key: &str, typed: &str) -> bool {
        let value = match self.parse(section, key, typed) {
            Ok(value) => value,
            Err(words) => return self.refuse(section, key, words),
        };
        let mut document = self.now.document.clone();
        if document::set(&mut document, section, key, value).is_none() {
            let words = format!("`{section}` is no section of this file");
            return self.refuse(section, key, words);
        }
        self.take(section, key, document)
    }

    /// A word may be typed without its quotes.
    fn parse(&self, section: &str, key: &str, typed: &str) -> Result<Value, String> {
        let typed = typed.trim();
        let is_word = |row: &Row| row.is(section, key) && row.value.starts_with('"');
        match typed.parse() {
            Ok(value) => Ok(value),
            Err(_) if self.now.rows.iter().any(is_word) => Ok(typed.into()),
            Err(_) => Err(format!(
                "`{key}` cannot be `{typed}`: write a number as 29 or 1.5e3, or several as [1, 2, 3]"
            )),
        }
    }

    /// Gives a setting the value that it was loaded with.
    pub fn reset_to_file(&mut self, section: &str, key: &str) -> bool {
        let loaded = document::value(&self.loaded.document, section, key);
        match loaded {
            Some(value) => self.set(section, key, &value),
            None => self.reset_to_default(section, key),
        }
    }

    /// Takes a setting out of the file: it is then what it is by default, or what follows from others.
    pub fn reset_to_default(&mut self, section: &str, key: &str) -> bool {
        let mut document = self.now.document.clone();
        document::remove(&mut document, section, key);
        self.take(section, key, document)
    }

    /// Gives everything the value that it was loaded with.
    pub fn all_to_file(&mut self) {
        self.go_to(self.loaded.clone());
    }

    fn take(&mut self, section: &str, key: &str, document: DocumentMut) -> bool {
        match Version::new(&self.name, document) {
            Ok(version) => {
                self.go_to(version);
                true
            }
            Err(failure) => {
                let (Failure::Failed(message) | Failure::Refused(message)) = failure;
                let help = message
                    .help
                    .map_or_else(String::new, |help| format!("; {help}"));
                self.refuse(section, key, message.sentence + &help)
            }
        }
    }

    fn refuse(&mut self, section: &str, key: &str, words: String) -> bool {
        self.refused = Some(Refused {
            section: section.into(),
            key: key.into(),
            words,
        });
        false
    }

    fn go_to(&mut self, version: Version) {
        self.refused = None;
        if version.document.to_string() == self.text() {
            return;
        }
        self.past.push(std::mem::replace(&mut self.now, version));
        if self.past.len() > UNDO_MAX {
            self.past.remove(0);
        }
        self.future.clear();
    }

    /// Takes the last change back.
    pub fn undo(&mut self) {
        if let Some(version) = self.past.pop() {
            self.future.push(std::mem::replace(&mut self.now, version));
            self.refused = None;
        }
    }

    /// Makes the change again that was taken back last.
    pub fn redo(&mut self) {
        if let Some(version) = self.future.pop() {
            self.past.push(std::mem::replace(&mut self.now, version));
            self.refused = None;
        }
    }

    /// Whether there is something to undo, and to redo.
    #[must_use]
    pub const fn steps(&self) -> [bool; 2] {
        [!self.past.is_empty(), !self.future.is_empty()]
    }

    /// Forgets why the last change was refused.
    pub fn forget_refusal(&mut self) {
        self.refused = None;
    }

    /// Why the last change was refused.
    #[must_use]
    pub const fn refused(&self) -> Option<&Refused> {
        self.refused.as_ref()
    }

    /// What the file is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The file as it stands now.
    #[must_use]
    pub fn text(&self) -> String {
        self.now.document.to_string()
    }

    /// The same with its name.
    #[must_use]
    pub fn source(&self) -> RigText {
        RigText {
            name: self.name.clone(),
            text: self.text(),
        }
    }

    /// Every setting.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.now.rows
    }

    /// What a board is to be set to.
    #[must_use]
    pub fn settings(&self) -> Settings {
        let rig = &self.now.rig;
        control_settings::settings(rig, &rig.gains, None)
    }

    /// What the file says.
    #[must_use]
    pub const fn rig(&self) -> &RigFile {
        &self.now.rig
    }

    /// Counts of each encoder in a turn of its motor.
    #[must_use]
    pub fn counts_per_turn(&self) -> [f64; 3] {
        self.rig()
            .actuators
            .map(|actuator| actuator.counts_per_turn)
    }

    /// The row of a setting as it was loaded.
    #[must_use]
    pub fn loaded(&self, row: &Row) -> Option<&Row> {
        let mut rows = self.loaded.rows.iter();
        rows.find(|loaded| loaded.is(&row.section, &row.key))
    }

    /// Whether a setting has another value than it was loaded with.
    #[must_use]
    pub fn is_changed(&self, row: &Row) -> bool {
        self.loaded(row)
            .is_none_or(|loaded| !loaded.same_value(row))
    }

    /// What differs from the file that was loaded.
    #[must_use]
    pub fn changes(&self) -> Vec<Change> {
        let name = |row: &Row| format!("{}.{}", row.section, row.key);
        let changed = self.now.rows.iter().filter(|row| self.is_changed(row));
        let changed = changed.map(|row| Change {
            name: name(row),
            was: self
                .loaded(row)
                .map(|loaded| with_unit(&loaded.value, &row.unit)),
            now: Some(with_unit(&row.value, &row.unit)),
            follows: !row.given && self.loaded(row).is_some_and(|loaded| !loaded.given),
        });
        let gone = self.loaded.rows.iter();
        let gone = gone.filter(|row| {
            !self
                .now
                .rows
                .iter()
                .any(|now| now.is(&row.section, &row.key))
        });
        let gone = gone.map(|row| Change {
            name: name(row),
            was: Some(with_unit(&row.value, &row.unit)),
            now: None,
            follows: false,
        });
        changed.chain(gone).collect()
    }
}

#[cfg(test)]
#[path = "editor_tests.rs"]
mod tests;
