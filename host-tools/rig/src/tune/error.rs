//! Why a leg was not measured to the end.

use leg_base::failure::Failure;
use leg_base::jog_report::Finding;
use leg_firmware::jog::JOG_TRAVEL_MAX_M;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;

/// Why a leg did not do what it was asked, as its host knows it.
pub trait LegError {
    /// A fault has ended it; `asked` is what was asked.
    fn faulted(asked: &'static str, telemetry: &Telemetry<f32>) -> Self;

    /// Another host or its user has ended it, and the leg is in that state.
    fn stopped(asked: &'static str, state: State) -> Self;

    /// The same for the user.
    fn failure(&self) -> Failure;
}

/// Why a leg was not measured to the end. It rests then.
#[derive(Debug)]
pub enum TuneError<E> {
    /// The leg did not do what it was asked.
    Leg(E),
    /// A jog showed what does not fit, as counts the wrong way.
    Finding(Finding),
    /// What was seen does not determine a number.
    Undetermined {
        /// What could not be found.
        what: String,
        /// What to do.
        help: &'static str,
    },
    /// The same, and a tendon is not where it was.
    Displaced {
        /// Why.
        error: Box<Self>,
        /// The motor, from 1.
        motor: u8,
        /// How far its tendon is pulled in beyond where it was, m.
        by_m: f32,
    },
}

impl<E> TuneError<E> {
    pub(super) fn undetermined(what: impl Into<String>, help: &'static str) -> Self {
        Self::Undetermined {
            what: what.into(),
            help,
        }
    }
}

impl<E: LegError> TuneError<E> {
    /// The same for the user.
    #[must_use]
    pub fn failure(&self) -> Failure {
        match self {
            Self::Leg(error) => error.failure(),
            Self::Finding(finding) => Failure::failed(finding.what.clone(), finding.remedy.clone()),
            Self::Undetermined { what, help } => Failure::failed(what.clone(), *help),
            Self::Displaced { error, motor, by_m } => {
                let mut failure = error.failure();
                let (Failure::Failed(message) | Failure::Refused(message)) = &mut failure;
                let help = message.help.take().unwrap_or_default();
                message.help = Some(format!("{help}; {}", displaced(*motor, *by_m)));
                failure
            }
        }
    }
}

fn displaced(motor: u8, by_m: f32) -> String {
    let by_mm = 1000.0 * by_m;
    let way = if by_m < 0.0 { "out" } else { "in" };
    // A jog turns by no more.
    let back_mm = (-by_mm).clamp(-1000.0 * JOG_TRAVEL_MAX_M, 1000.0 * JOG_TRAVEL_MAX_M);
    format!(
        "tendon {motor} is {:.1} mm farther {way} than it was: `leg jog {motor} --travel {back_mm:.1}` turns it back",
        by_mm.abs()
    )
}

impl<E> From<E> for TuneError<E> {
    fn from(error: E) -> Self {
        Self::Leg(error)
    }
}

impl<E: LegError> From<TuneError<E>> for Failure {
    fn from(error: TuneError<E>) -> Self {
        error.failure()
    }
}

impl<E: LegError> std::fmt::Display for TuneError<E> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.failure().fmt(f)
    }
}

impl<E: LegError + std::fmt::Debug> std::error::Error for TuneError<E> {}
