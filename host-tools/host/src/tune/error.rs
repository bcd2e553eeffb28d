//! Why a leg was not measured to the end.

use crate::jog_report::Finding;
use crate::operator::OperatorError;
use leg_base::failure::Failure;

/// Why a leg was not measured to the end. It rests then, and nothing is written.
#[derive(Debug)]
pub enum TuneError {
    /// The leg did not do what it was asked.
    Operator(OperatorError),
    /// A jog showed what does not fit, as counts the wrong way.
    Finding(Finding),
    /// What was seen does not determine a number.
    Undetermined {
        /// What could not be found.
        what: String,
        /// What to do.
        help: &'static str,
    },
}

impl TuneError {
    pub(super) fn undetermined(what: impl Into<String>, help: &'static str) -> Self {
        Self::Undetermined {
            what: what.into(),
            help,
        }
    }

    /// The same for the user.
    #[must_use]
    pub fn failure(&self) -> Failure {
        match self {
            Self::Operator(error) => error.failure(),
            Self::Finding(finding) => Failure::failed(finding.what.clone(), finding.remedy.clone()),
            Self::Undetermined { what, help } => Failure::failed(what.clone(), *help),
        }
    }
}

impl From<OperatorError> for TuneError {
    fn from(error: OperatorError) -> Self {
        Self::Operator(error)
    }
}

impl From<TuneError> for Failure {
    fn from(error: TuneError) -> Self {
        error.failure()
    }
}

impl std::fmt::Display for TuneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.failure().fmt(f)
    }
}

impl std::error::Error for TuneError {}
