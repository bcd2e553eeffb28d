//! Why an operator did not get what it asked for.

use super::refusal;
use crate::leg_report::pose_words;
use leg_base::description;
use leg_base::failure::Failure;
use leg_firmware::frame::FrameError;
use leg_firmware::host_link::{HOST_SCHEMA, HostRefusal};
use leg_firmware::supervisor::{FaultSet, State};
use std::io;
use std::time::Duration;

/// Shortest command timeout of a leg that is driven, s: a busy machine and a line by USB take some milliseconds each.
pub(super) const COMMAND_TIME_MIN_S: f32 = 0.02;

/// Why an operator did not get what it asked for. `asked` is what the leg was asked to do.
#[derive(Debug, thiserror::Error)]
pub enum OperatorError {
    /// The transport failed.
    #[error("the connection to {name} is lost: {source}")]
    ConnectionLost {
        /// What is at the other end.
        name: String,
        /// The error of the system.
        source: io::Error,
    },
    /// Nothing answers; this is what should.
    #[error("{0} does not answer")]
    NoAnswer(String),
    /// The firmware was built from other sources.
    #[error(
        "the firmware at {name} speaks another protocol (schema {}, this program {})",
        description::hex(.firmware), description::hex(&HOST_SCHEMA)
    )]
    OtherSchema {
        /// What is at the other end.
        name: String,
        /// The firmware's schema.
        firmware: [u8; 8],
    },
    /// The leg refuses.
    #[error("the leg does not {asked}: {}", refusal::description(.refusal)[0])]
    Refused {
        /// What it was asked to do.
        asked: &'static str,
        /// Why.
        refusal: HostRefusal,
    },
    /// Faults have to be cleared first.
    #[error("the leg does not {asked} before its faults are cleared ({})", description::causes(*.faults))]
    Faulted {
        /// What it was asked to do.
        asked: &'static str,
        /// The faults.
        faults: FaultSet,
    },
    /// These faults cannot be cleared yet.
    #[error("the leg keeps its faults while the cause of one is still present ({})", description::causes(*.0))]
    NotCleared(FaultSet),
    /// Faults ended what the leg was doing.
    #[error(
        "the leg did not {asked}{}, it is {} ({})",
        at_tendon(*.failed_tendon), description::state(*.state), description::causes(*.faults)
    )]
    Failed {
        /// What it was asked to do.
        asked: &'static str,
        /// Tendon at which homing failed, from 1; 0 for none.
        failed_tendon: u8,
        /// What it does now.
        state: State,
        /// The faults.
        faults: FaultSet,
    },
    /// The leg goes on, but something limits it.
    #[error("the leg did not {asked} as demanded ({})", description::causes(*.faults))]
    Limited {
        /// What it was asked to do.
        asked: &'static str,
        /// What limits it.
        faults: FaultSet,
        /// The stiffness that it reached, N·m/rad.
        stiffness_nm_per_rad: f32,
        /// The pretension that it reached, N.
        pretension_n: f32,
    },
    /// Another host ended what the leg was doing.
    #[error("the leg did not {asked}: another host stopped it, and it is {}", description::state(*.state))]
    StoppedByOtherHost {
        /// What it was asked to do.
        asked: &'static str,
        /// What it does now.
        state: State,
    },
    /// The leg came to rest at another pose: horizontal components of its direction.
    #[error("the leg did not move there: it came to rest at {}", pose_words(*.0))]
    OtherPose([f32; 2]),
    /// It is not known whether the leg does what it was asked to do.
    #[error("the leg did not acknowledge that it will {0}")]
    Unacknowledged(&'static str),
    /// No stop was acknowledged by what is at the other end.
    #[error("{0} did not acknowledge the stop")]
    NotStopped(String),
    /// The reply to what the leg was asked to do is of another kind.
    #[error("the leg sends a reply of another kind when asked to {0}")]
    WrongReply(&'static str),
    /// It takes too long.
    #[error(
        "the leg did not {asked} within {} s; it is {}, faults: {}",
        .timeout.as_secs_f64(), description::state(*.state), description::faults(*.faults)
    )]
    TimedOut {
        /// What it was asked to do.
        asked: &'static str,
        /// How long was waited.
        timeout: Duration,
        /// What it does now.
        state: State,
        /// Its faults.
        faults: FaultSet,
    },
    /// The settings read back differ in these from those that were sent.
    #[error("the leg has other settings than were sent: {}", .0.join(", "))]
    ReadBack(Vec<String>),
    /// The leg's command timeout, s, is shorter than this host can keep.
    #[error(
        "the leg's command timeout is {0} s, and this program sends every few milliseconds at best"
    )]
    CommandTimeTooShort(f32),
    /// The user ended it.
    #[error("ended by Ctrl-C")]
    Cancelled,
    /// A request is too long for a frame.
    #[error("a message cannot be sent: {0}")]
    Frame(#[from] FrameError),
}

impl OperatorError {
    /// What to do about it.
    #[must_use]
    pub fn remedy(&self) -> String {
        let remedy = match self {
            Self::Refused { refusal, .. } => return refusal::description(refusal)[1].clone(),
            Self::Faulted { faults, .. }
            | Self::NotCleared(faults)
            | Self::Failed { faults, .. } => {
                return format!("{}; then `leg clear`", description::remedies(*faults));
            }
            Self::Limited {
                faults,
                stiffness_nm_per_rad,
                pretension_n,
                ..
            } => {
                return format!(
                    "{}; it is held at pretension {pretension_n:.1} N, stiffness {stiffness_nm_per_rad:.1} N·m/rad",
                    description::remedies(*faults)
                );
            }
            Self::CommandTimeTooShort(_) => {
                return format!(
                    "give command_time_s in [control.limits] of the rig file {COMMAND_TIME_MIN_S} or more, then `leg settings set`"
                );
            }
            Self::ConnectionLost { .. } => {
                "plug the board in again; without its host an armed leg holds by itself"
            }
            Self::NoAnswer(_) => {
                "see that the board is powered and flashed (`leg flash`), that this is its port, and \
                 that no other `leg` that has it is suspended"
            }
            Self::OtherSchema { .. } | Self::WrongReply(_) => {
                "build and flash the firmware from the sources of this program: `leg flash`"
            }
            Self::StoppedByOtherHost { .. } => "find out why, then command again",
            Self::OtherPose(_) => "go there by way of other poses",
            Self::Unacknowledged(_) => {
                "look at the cable, and with `leg monitor` at what the leg does"
            }
            Self::NotStopped(_) => {
                "press the emergency stop; without its host an armed leg holds by itself"
            }
            Self::TimedOut { .. } => "look with `leg monitor` at what the leg does",
            Self::ReadBack(_) => "set them again; if that does not help, flash anew",
            Self::Cancelled => {
                "the leg is in hold if it was driven; one that was being disarmed goes on to relax"
            }
            Self::Frame(_) => "give shorter settings: fewer points of a tendon's curve",
        };
        remedy.into()
    }

    /// Whether nothing was done because of what was asked, or of what is missing.
    fn refuses(&self) -> bool {
        !matches!(
            self,
            Self::Failed { .. }
                | Self::Limited { .. }
                | Self::StoppedByOtherHost { .. }
                | Self::OtherPose(_)
                | Self::NotStopped(_)
                | Self::TimedOut { .. }
                | Self::ReadBack(_)
                | Self::Cancelled
        )
    }
}

impl From<OperatorError> for Failure {
    fn from(error: OperatorError) -> Self {
        let (sentence, remedy) = (error.to_string(), error.remedy());
        if error.refuses() {
            Self::refused(sentence, remedy)
        } else {
            Self::failed(sentence, remedy)
        }
    }
}

fn at_tendon(tendon: u8) -> String {
    match tendon {
        0 => String::new(),
        tendon => format!(" with tendon {tendon}"),
    }
}
