//! The paper's published numbers beside ours, its figures, and the errors of its print.

mod deviation;
mod errata;
mod figures;
mod kinematics;
mod report;
mod row;
mod statics;
mod tendon;
#[cfg(test)]
mod tests;
mod workspace;

pub use errata::Erratum;
pub use figures::{FigureError, draw};
pub use report::markdown;
pub use row::{PaperRow, Topic, Verdict};

use leg_base::failure::Failure;
use leg_model::Error;
use leg_rig::rig_file::RigFile;
use serde::Serialize;

/// Why the paper could not be compared with the model.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// The model has no result where the paper has a number.
    #[error(
        "the model has no result where the paper has a number: {0}; this is a fault in the model"
    )]
    Model(#[from] Error),
    /// The ready rig is damaged.
    #[error("the rig of Table 1 cannot be read: {0}; build the tool anew")]
    Rig(#[from] Failure),
}

/// Everything that the paper prints and the model computes.
#[derive(Clone, Debug, Serialize)]
pub struct Paper {
    /// Published numbers.
    pub rows: Vec<PaperRow>,
    /// Every printed entry of Eqs. (24) and (25): `rows` count those that agree.
    pub entries: Vec<PaperRow>,
    /// Errors of the print.
    pub errata: Vec<Erratum>,
}

impl Paper {
    /// Computes all of it on the rig of Table 1.
    ///
    /// # Errors
    /// A [`PaperError`].
    pub fn compute() -> Result<Self, PaperError> {
        let rig = RigFile::load(None)?;
        let rows = [
            kinematics::rows()?,
            statics::rows()?,
            tendon::rows(&rig)?,
            deviation::rows(&rig)?,
            workspace::rows(&rig)?,
        ];
        Ok(Self {
            rows: rows.concat(),
            entries: kinematics::entries()?,
            errata: errata::all(&rig)?,
        })
    }

    /// The rows whose verdict is not the one that is known.
    pub fn surprises(&self) -> impl Iterator<Item = &PaperRow> {
        self.rows.iter().filter(|row| row.verdict() != row.expected)
    }
}
