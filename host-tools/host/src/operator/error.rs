//! Why an operator did not get what it asked for.

use super::alive::PATIENCE_MIN_S;
use super::refusal;
use crate::leg_report::pose_words;
use leg_base::failure::Failure;
use leg_base::words;
use leg_firmware::frame::FrameError;
use leg_firmware::host_link::HOST_SCHEMA;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::supervisor::{FaultSet, State};
use std::io;
use std::time::Duration;

/// Why an operator did not get what it asked for.
#[derive(Debug, thiserror::Error)]
pub enum OperatorError {
    /// The transport failed.
    #[error("the line to {name} is gone: {source}")]
    Broken {
        /// What is at its other end.
        name: String,
        /// What the system says.
        source: io::Error,
    },
    /// Nothing answers.
    #[error("{name} does not answer")]
    Silent {
        /// What should.
        name: String,
    },
    /// The firmware was built from other sources.
    #[error(
        "the firmware at {name} speaks another protocol (schema {}, this program {})",
        words::hex(.firmware), words::hex(&HOST_SCHEMA)
    )]
    OtherSchema {
        /// What is at the other end.
        name: String,
        /// The firmware's schema.
        firmware: [u8; 8],
    },
    /// The leg refuses.
    #[error("the leg does not {asked}: {}", refusal::words(.refusal)[0])]
    Refused {
        /// What it was asked to do.
        asked: &'static str,
        /// Why.
        refusal: HostRefusal,
    },
    /// Faults have to be cleared first.
    #[error("the leg does not {asked} before its faults are cleared ({})", words::causes(*.faults))]
    Faulted {
        /// What it was asked to do.
        asked: &'static str,
        /// The faults.
        faults: FaultSet,
    },
    /// Faults cannot be cleared yet.
    #[error("the leg keeps its faults while one of them still has its cause ({})", words::causes(*.faults))]
    NotCleared {
        /// The faults.
        faults: FaultSet,
    },
    /// Faults ended what the leg was doing.
    #[error(
        "the leg did not {asked}{}, it is {} ({})",
        at_tendon(*.failed_tendon), words::state(*.state), words::causes(*.faults)
    )]
    Failed {
        /// What it was to do.
        asked: &'static str,
        /// Tendon at which homing failed, from 1; 0 for none.
        failed_tendon: u8,
        /// What it does now.
        state: State,
        /// The faults.
        faults: FaultSet,
    },
    /// The leg goes on, but something limits it.
    #[error("the leg did not {asked} as demanded ({})", words::causes(*.faults))]
    Limited {
        /// What it was to do.
        asked: &'static str,
        /// What limits it.
        faults: FaultSet,
        /// Its stiffness as far as it got, N·m/rad.
        stiffness_nm_per_rad: f32,
        /// Its pretension as far as it got, N.
        pretension_n: f32,
    },
    /// Another host ended what the leg was doing.
    #[error("the leg did not {asked}: another host stopped it, and it is {}", words::state(*.state))]
    Overtaken {
        /// What it was to do.
        asked: &'static str,
        /// What it does now.
        state: State,
    },
    /// The leg came to rest somewhere else.
    #[error("the leg did not move there: it came to rest at {}", pose_words(*.pose))]
    Elsewhere {
        /// Where it points: horizontal components.
        pose: [f32; 2],
    },
    /// It is not known whether the leg obeys.
    #[error("the leg did not say whether it will {asked}")]
    Unanswered {
        /// What it was asked to do.
        asked: &'static str,
    },
    /// No stop was acknowledged.
    #[error("{name} acknowledged no stop")]
    NotStopped {
        /// What is at the other end.
        name: String,
    },
    /// The reply is of another kind.
    #[error("the leg answers with something else when asked to {asked}")]
    WrongReply {
        /// What it was asked to do.
        asked: &'static str,
    },
    /// It takes too long.
    #[error(
        "the leg did not {what} within {} s; it is {}, faults: {}",
        .timeout.as_secs_f64(), words::state(*.state), words::faults(*.faults)
    )]
    Late {
        /// What was waited for.
        what: &'static str,
        /// How long.
        timeout: Duration,
        /// What the leg does.
        state: State,
        /// Its faults.
        faults: FaultSet,
    },
    /// The settings read back differ from those that were sent.
    #[error("the leg has other settings than were sent: {}", .names.join(", "))]
    ReadBack {
        /// Those that differ.
        names: Vec<String>,
    },
    /// The leg misses its host sooner than this one can speak.
    #[error(
        "the leg misses its host after {command_time_s} s of silence, and this program speaks every few milliseconds at best"
    )]
    Impatient {
        /// What the leg waits, s.
        command_time_s: f32,
    },
    /// The user ended it.
    #[error("ended by Ctrl-C")]
    Interrupted,
    /// A message has no form.
    #[error("a message cannot be sent: {0}")]
    Frame(#[from] FrameError),
}

impl OperatorError {
    /// What to do about it.
    #[must_use]
    pub fn remedy(&self) -> String {
        match self {
            Self::Broken { .. } => {
                "plug the board in again; without its host an armed leg holds by itself".into()
            }
            Self::Silent { .. } => {
                "see that the board is powered and flashed (`leg flash`), that this is its port, and \
                 that no other `leg` that has it is suspended"
                    .into()
            }
            Self::OtherSchema { .. } | Self::WrongReply { .. } => {
                "build and flash the firmware from the sources of this program: `leg flash`".into()
            }
            Self::Refused { refusal, .. } => {
                let [_, remedy] = refusal::words(refusal);
                remedy
            }
            Self::Faulted { faults, .. }
            | Self::NotCleared { faults }
            | Self::Failed { faults, .. } => {
                format!("{}; then `leg clear`", words::remedies(*faults))
            }
            Self::Limited {
                faults,
                stiffness_nm_per_rad,
                pretension_n,
                ..
            } => format!(
                "{}; it is held at pretension {pretension_n:.1} N, stiffness {stiffness_nm_per_rad:.1} N·m/rad",
                words::remedies(*faults)
            ),
            Self::Overtaken { .. } => "look why, then command again".into(),
            Self::Elsewhere { .. } => "go there by way of other poses".into(),
            Self::Unanswered { .. } => {
                "look at the cable, and with `leg monitor` at what the leg does".into()
            }
            Self::NotStopped { .. } => {
                "press the emergency stop; without its host an armed leg holds by itself".into()
            }
            Self::Late { .. } => "look with `leg monitor` at what the leg does".into(),
            Self::ReadBack { .. } => "set them again; if that does not help, flash anew".into(),
            Self::Impatient { .. } => format!(
                "give command_time_s in [control.limits] of the rig file {PATIENCE_MIN_S} or more, then `leg settings set`"
            ),
            Self::Interrupted => {
                "the leg is in hold if it was driven; one that was being disarmed goes on to relax"
                    .into()
            }
            Self::Frame(_) => "give shorter settings: fewer points of a tendon's curve".into(),
        }
    }

    /// Whether nothing was done because of what was asked, or of what is missing.
    fn refuses(&self) -> bool {
        !matches!(
            self,
            Self::Failed { .. }
                | Self::Limited { .. }
                | Self::Overtaken { .. }
                | Self::Elsewhere { .. }
                | Self::NotStopped { .. }
                | Self::Late { .. }
                | Self::ReadBack { .. }
                | Self::Interrupted
        )
    }
}

impl From<OperatorError> for Failure {
    fn from(error: OperatorError) -> Self {
        let (sentence, remedy) = (error.to_string(), error.remedy());
        if error.refuses() {
            Self::refused(sentence, remedy)
        } else {
            Self::missed(sentence, remedy)
        }
    }
}

fn at_tendon(tendon: u8) -> String {
    match tendon {
        0 => String::new(),
        tendon => format!(" with tendon {tendon}"),
    }
}
