//! What a host says to the firmware on its test bench, and the hash by which the two know that they mean the same.

use crate::kernels::{Kernel, KernelInput, KernelOutput};
use crate::query::QueryMessage;
use heapless::Vec;
use leg_firmware::drive::Drive;
use leg_firmware::host_link::{BoardKind, Hello};
use leg_firmware::linked_leg::LINK_BYTES_MAX;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware::telemetry::Telemetry;
use leg_model::{Error, Evaluation, RigParameters};
use postcard_schema::{Schema, key::Key};
use serde::{Deserialize, Serialize};

/// A request from the host. The first one on a link is [`Request::Hello`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
#[allow(
    clippy::large_enum_variant,
    reason = "a message is kept in place: there is no allocation on the board"
)]
pub enum Request {
    /// Introduces the host; the firmware answers with what it is.
    Hello(Hello),
    /// Evaluates the whole model at one pose.
    Evaluate(EvaluateRequest),
    /// Runs one kernel and returns what it computed.
    Run(KernelRequest),
    /// Counts the instructions of one kernel.
    Count(KernelRequest),
    /// Makes a leg with these settings; one that was there is dropped.
    Start(Settings),
    /// One tick of the leg.
    Tick(TickRequest),
    /// One tick of the leg, its instructions counted.
    CountTick(TickRequest),
    /// One step of the leg's board, without the leg.
    Board(BoardStep),
}

/// The firmware's answer to a [`Request`].
///
/// The order of the variants is part of the format: [`Reply::Hello`] and [`Reply::Refused`] stay in front, so that
/// two sides of different age can still tell each other so.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum Reply {
    /// The firmware speaks the same language.
    Hello(BoardInfo),
    /// Nothing was done.
    Refused(Refusal),
    /// The model at the pose.
    Evaluation(Evaluation<f32>),
    /// What a kernel computed.
    Ran(KernelOutput),
    /// Instructions that a kernel took.
    Counted(u32),
    /// The leg is made.
    Started,
    /// What a tick asks of the motors, and what the leg tells of itself.
    Ticked(TickReply),
    /// What the board reads and does.
    Board(BoardReply),
}

/// What the firmware is and found at boot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct BoardInfo {
    /// Which board layer answers.
    pub board: BoardKind,
    /// What the board measured of itself at boot; `None` in the host's own process.
    pub boot: Option<BootCheck>,
}

/// What a board measured of itself at boot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct BootCheck {
    /// How long an alarm set to 1 000 µs took by the board's other timer, µs.
    pub alarm_us: u32,
    /// What the instruction counter read for 100 `nop`s; it counts only where this is 100.
    pub nops_counted: u32,
}

/// A pose to evaluate on a rig.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct EvaluateRequest {
    /// The mechanism.
    pub rig: RigParameters<f32, 3>,
    /// The pose, the load and what holds it.
    pub query: QueryMessage,
}

/// A kernel and what it works on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct KernelRequest {
    /// Which kernel.
    pub kernel: Kernel,
    /// Its arguments.
    pub input: KernelInput,
}

/// What a tick gets.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct TickRequest {
    /// What the sensors read.
    pub sensors: Sensors,
    /// The bytes that came from the user's host since the last tick: see [`HostLink`](leg_firmware::host_link::HostLink).
    pub link: Vec<u8, LINK_BYTES_MAX>,
}

/// What a tick gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct TickReply {
    /// What the leg asks of the motors.
    pub drive: Drive<f32>,
    /// What the board gives them: whole steps of its timer, no turn under a pulse, nothing behind a break.
    pub motors: Drive<f32>,
    /// For the host.
    pub telemetry: Telemetry<f32>,
    /// Instructions that the tick took, if they were counted.
    pub instructions: Option<u32>,
    /// Instructions that its recording took, if they were counted.
    pub recorder_instructions: Option<u32>,
    /// The bytes for the user's host.
    pub link: Vec<u8, LINK_BYTES_MAX>,
}

/// What is done to a leg's board.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum BoardStep {
    /// The sensors read this from now on.
    Read(Sensors),
    /// A tick asks this of the motors.
    Drive(Drive<f32>),
    /// The outputs are switched off.
    Cut,
}

/// What a board does after a [`BoardStep`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub struct BoardReply {
    /// What the sensors read in a tick.
    pub sensors: Sensors,
    /// What the motors get.
    pub motors: Drive<f32>,
}

/// Why the firmware did nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Schema)]
pub enum Refusal {
    /// The host has not said [`Request::Hello`] yet.
    NoHello,
    /// The host's schema is another one; the firmware's own is given.
    SchemaMismatch {
        /// [`BENCH_SCHEMA`] of the firmware.
        schema: [u8; 8],
    },
    /// The frame could not be read.
    BadFrame(leg_firmware::frame::FrameError),
    /// The frame is whole but holds no request.
    BadRequest,
    /// The model gives no result for the arguments.
    Model(Error),
    /// The board cannot count instructions.
    NoCounter,
    /// The settings of a leg are refused.
    Settings(SettingsError),
    /// There is no leg yet: [`Request::Start`] has to come first.
    NoLeg,
}

/// Hash of the bench's messages: it changes when the shape of one of them changes. What a flashed board speaks has a hash of
/// its own, [`HOST_SCHEMA`](leg_firmware::host_link::HOST_SCHEMA).
pub const BENCH_SCHEMA: [u8; 8] = Key::for_path::<(Request, Reply)>("leg bench").to_bytes();
