//! The messages between a user's host and a leg, on every transport.

use crate::command::{Command, CommandRefusal};
use crate::frame::FrameError;
use crate::jog::JogReport;
use crate::recorder::{RecorderReply, RecorderRequest};
use crate::sensors::SensorReading;
use crate::settings::{Settings, SettingsError};
use crate::telemetry::Telemetry;
use heapless::String;
use postcard_schema::{Schema, key::Key};
use serde::{Deserialize, Serialize};

/// Longest crash report, bytes.
pub const CRASH_REPORT_MAX: usize = 96;

/// Hash of the messages between a host and a leg: it changes when the shape of one of them changes.
pub const HOST_SCHEMA: [u8; 8] = Key::for_path::<(HostRequest, HostReply)>("leg").to_bytes();

/// The hash of the sender's messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Hello {
    /// [`HOST_SCHEMA`] of the sender; on a test bench, the hash of the bench's messages.
    pub schema: [u8; 8],
}

/// The boards that there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum BoardKind {
    /// QEMU's mps2-an386.
    Qemu,
    /// NUCLEO-G474RE.
    Stm32g474,
    /// Inside the host's own process.
    InProcess,
}

/// Identifies a host: chosen at random when it starts.
pub type HostId = u32;

/// What a host asks. The first on a link is [`HostRequest::Identify`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[allow(
    clippy::large_enum_variant,
    reason = "a message is kept in place: there is no allocation on the board"
)]
pub enum HostRequest {
    /// Introduces the host; the leg answers with what it is.
    Identify(Hello),
    /// Commands the leg. The reply comes when a tick has obeyed or refused it.
    Command {
        /// Who commands: a driven leg obeys one host.
        host: HostId,
        /// The command.
        command: Command,
    },
    /// Asks for telemetry once.
    Telemetry,
    /// Asks for telemetry again and again, every so many ticks; 0 ends it.
    Stream(u16),
    /// Asks for the raw codes of the sensors, and for the zeros of the currents.
    Sensors,
    /// Asks for the settings in use.
    GetSettings,
    /// Replaces the settings while the drivers are off. The leg has to be homed then.
    SetSettings(Settings),
    /// Keeps the settings in use over a reset.
    SaveSettings,
    /// Asks for what the last jog measured.
    JogReport,
    /// Asks something of the recorder.
    Recorder(RecorderRequest),
}

/// What the leg answers, and sends by itself.
///
/// The order of the variants is part of the format: [`HostReply::Identified`] and [`HostReply::Refused`] stay in front,
/// so that two sides of different age still understand that.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[allow(
    clippy::large_enum_variant,
    reason = "a message is kept in place: there is no allocation on the board"
)]
pub enum HostReply {
    /// The leg has the same messages.
    Identified(Identity),
    /// Nothing was done.
    Refused(HostRefusal),
    /// It is done.
    Done,
    /// The telemetry.
    Telemetry(TelemetryReport),
    /// The raw codes of the sensors, and the zeros of the currents.
    Sensors(SensorReading),
    /// The settings in use.
    Settings(Settings),
    /// What the last jog measured; none since the start.
    Jog(Option<JogReport<f32>>),
    /// What the recorder holds.
    Recorder(RecorderReply),
}

/// Telemetry with its number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct TelemetryReport {
    /// Counts what was sent and what found no room on the line, so a gap shows what was lost.
    pub number: u32,
    /// The leg after a tick.
    pub telemetry: Telemetry<f32>,
}

/// What a leg's board is, and what it went through before it started.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Identity {
    /// Which board layer runs.
    pub board: BoardKind,
    /// Version of the firmware: major, minor, patch.
    pub version: [u8; 3],
    /// Why the board started.
    pub reset: ResetCause,
    /// Crash report of the last run; empty if it did not stop by itself.
    pub crash_report: String<CRASH_REPORT_MAX>,
}

/// Why a board started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum ResetCause {
    /// The power came.
    Power,
    /// The supply was too low for the chip.
    BrownOut,
    /// The reset pin, or a debugger.
    Pin,
    /// The firmware itself, after a panic or a hard fault.
    Software,
    /// The watchdog: a task had not checked in.
    Watchdog,
    /// The window watchdog: a control tick did not end, or did not come.
    HungTick,
    /// Something else.
    Other,
    /// It was started by an emulator or in the host's process.
    Emulated,
}

/// Why the leg did not do what it was asked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum HostRefusal {
    /// The host's schema is another one; the leg's own is given.
    SchemaMismatch {
        /// [`HOST_SCHEMA`] of the firmware.
        schema: [u8; 8],
    },
    /// The host has not said [`HostRequest::Identify`] yet.
    NotIdentified,
    /// The frame could not be read.
    BadFrame(FrameError),
    /// The frame is whole but holds no request.
    BadRequest,
    /// Too many commands wait for their tick, or settings are being kept.
    Busy,
    /// Another host drives the leg.
    OtherHost,
    /// The command is refused.
    Command(CommandRefusal),
    /// The settings can be replaced and saved only while the drivers are off.
    Driven,
    /// The settings are refused.
    Settings(SettingsError),
    /// The settings could not be kept.
    NotSaved,
    /// The recorder is recording: what it holds can be read when it has ended.
    Recording,
}
