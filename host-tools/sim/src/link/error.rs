//! Why a link gave no reply.

use leg_firmware::frame::FrameError;
use std::time::Duration;
use thiserror::Error;

/// Why a link gave no reply.
#[derive(Debug, Error)]
pub enum LinkError {
    /// The image to boot is not there.
    #[error("there is no firmware image at {0}; build it with `cargo image-qemu`")]
    ImageMissing(String),
    /// The image is no ELF file with the firmware's log table.
    #[error("{path} is no image of this firmware ({reason}); build it with `cargo image-qemu`")]
    ImageUnreadable {
        /// Where it is.
        path: String,
        /// What is wrong with it.
        reason: String,
    },
    /// QEMU could not be started.
    #[error("cannot start QEMU as `{program}`: {source}; run `leg setup`, or name it in LEG_QEMU")]
    QemuNotStarted {
        /// The program that was tried.
        program: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// The system refused something that the link needs.
    #[error("cannot {action}: {source}")]
    System {
        /// What was tried.
        action: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// QEMU or the firmware in it ended.
    #[error("{reason}; start again, and with -v to see all of its log{}", log_lines(.log))]
    Died {
        /// How it ended, as a sentence.
        reason: String,
        /// The last lines that it wrote.
        log: Vec<String>,
    },
    /// Nothing came in time.
    #[error(
        "the firmware did not {action} within {} s; is the machine overloaded?{}",
        .timeout.as_secs_f64(), log_lines(.log)
    )]
    TimedOut {
        /// What was waited for.
        action: &'static str,
        /// How long.
        timeout: Duration,
        /// The last lines that the firmware wrote.
        log: Vec<String>,
    },
    /// Host and firmware were built from different sources.
    #[error(
        "the firmware speaks another protocol (schema {}, this program {}); build and start both from the same sources",
        leg_base::description::hex(.firmware), leg_base::description::hex(.host)
    )]
    SchemaMismatch {
        /// Schema of this program.
        host: [u8; 8],
        /// Schema of the firmware.
        firmware: [u8; 8],
    },
    /// The emulated chip, or the image on it, does something wrong: what, as a sentence.
    #[error("{0}")]
    Chip(String),
    /// A frame cannot be made, or the reply's was damaged.
    #[error("a frame was damaged on the way from the firmware ({0}); start again")]
    Frame(#[from] FrameError),
    /// The firmware received something else than was sent.
    #[error("a frame was damaged on the way to the firmware ({0}); start again")]
    RequestDamaged(FrameError),
    /// The reply is of a kind that this program does not know.
    #[error(
        "the firmware's reply cannot be read; build and start both sides from the same sources"
    )]
    UnreadableReply,
    /// The reply belongs to another request.
    #[error("reply {received} came to request {sent}; start again")]
    OutOfStep {
        /// Sequence of the request.
        sent: u16,
        /// Sequence of the reply.
        received: u16,
    },
}

impl LinkError {
    /// The system refused `action`.
    pub fn system<E: Into<std::io::Error>>(action: &'static str) -> impl FnOnce(E) -> Self {
        move |error| Self::System {
            action,
            source: error.into(),
        }
    }
}

fn log_lines(log: &[String]) -> String {
    if log.is_empty() {
        return String::new();
    }
    format!("; its last lines were:\n  {}", log.join("\n  "))
}
