//! Why an operator did not get what it asked for.

use crate::leg_report::pose_words;
use leg_base::description::{
    WITHOUT_HOST, causes, faults, hex, remedies, remedies_and_clear, state,
};
use leg_base::failure::Failure;
use leg_base::refusal;
use leg_base::settling::same_direction;
use leg_firmware::command::CommandRefusal;
use leg_firmware::frame::FrameError;
use leg_firmware::host_link::{HOST_SCHEMA, HostRefusal};
use leg_firmware::set_point::PointRefusal;
use leg_firmware::supervisor::{FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;
use std::{fmt, io};

/// Shortest command timeout of a leg that is driven, s: a busy machine and a line by USB take some milliseconds each.
pub(super) const COMMAND_TIME_MIN_S: f32 = 0.02;

/// The command that clears faults.
const CLEAR: &str = "`leg clear`";

/// Why an operator did not get what it asked for. A `&'static str` is what the leg was asked to do, telemetry what it does
/// now.
#[derive(Debug)]
pub enum OperatorError {
    /// The transport to what is named failed.
    ConnectionLost(String, io::Error),
    /// What is named does not answer.
    NoAnswer(String),
    /// The firmware of what is named was built from other sources, with this schema.
    OtherSchema(String, [u8; 8]),
    /// The leg refuses.
    Refused(&'static str, HostRefusal),
    /// Faults have to be cleared first.
    Faulted(&'static str, FaultSet),
    /// These faults cannot be cleared yet.
    NotCleared(FaultSet),
    /// Faults ended what the leg was doing.
    Failed(&'static str, Box<Telemetry<f32>>),
    /// The leg goes on, but something limits it.
    Limited(&'static str, Box<Telemetry<f32>>),
    /// Another host ended what the leg was doing.
    StoppedByOtherHost(&'static str, State),
    /// The leg came to rest at another pose: horizontal components of its direction.
    OtherPose([f32; 2]),
    /// The path that the leg shall follow is refused.
    Path(Failure),
    /// The leg, or this host in its place, refuses a point of the path: its time, s.
    Point(f64, PointRefusal),
    /// It is not known whether the leg does what it was asked to do.
    Unacknowledged(&'static str),
    /// No stop was acknowledged by what is named.
    NotStopped(String),
    /// The settings have the recorder record nothing.
    NothingRecorded,
    /// A recording began anew while it was read.
    RecordingReplaced,
    /// The reply is of another kind.
    WrongReply(&'static str),
    /// It takes longer than this.
    TimedOut(&'static str, Duration, Box<Telemetry<f32>>),
    /// The settings read back differ in these from those that were sent.
    ReadBack(Vec<String>),
    /// The leg's command timeout, s, is shorter than this host can keep.
    CommandTimeTooShort(f32),
    /// The user ended it.
    Cancelled,
    /// A request is too long for a frame.
    Frame(FrameError),
}

impl OperatorError {
    /// What is wrong and what to do about it: refused where nothing was done because of what was asked, or of what is
    /// missing.
    pub fn failure(&self) -> Failure {
        match self {
            Self::ConnectionLost(name, source) => Failure::refused(
                format!("the connection to {name} is lost: {source}"),
                format!("plug the board in again; without its host {WITHOUT_HOST}"),
            ),
            Self::NoAnswer(name) => Failure::refused(
                format!("{name} does not answer"),
                "see that the board is powered and flashed (`leg flash`), that this is its port, and that no other \
                 `leg` that has it is suspended",
            ),
            Self::OtherSchema(name, firmware) => Failure::refused(
                format!(
                    "the firmware at {name} speaks another protocol (schema {}, this program {})",
                    hex(firmware),
                    hex(&HOST_SCHEMA)
                ),
                refusal::OTHER_SOURCES,
            ),
            // Whatever it was, the leg was well commanded: the next point of a path, or what waited for its turn.
            Self::Refused(asked, superseded @ HostRefusal::Command(CommandRefusal::Superseded)) => {
                let [reason, remedy] = refusal::description(superseded);
                Failure::failed(format!("the leg did not {asked}: {reason}"), remedy)
            }
            Self::Refused(asked, refusal) => {
                let [reason, remedy] = refusal::description(refusal);
                Failure::refused(format!("the leg does not {asked}: {reason}"), remedy)
            }
            Self::Faulted(asked, present) => Failure::refused(
                format!(
                    "the leg does not {asked} before its faults are cleared ({})",
                    causes(*present)
                ),
                remedies_and_clear(*present, CLEAR),
            ),
            Self::NotCleared(present) => Failure::refused(
                format!(
                    "the leg keeps its faults while the cause of one is still present ({})",
                    causes(*present)
                ),
                remedies_and_clear(*present, CLEAR),
            ),
            Self::Failed(asked, telemetry) => {
                let place = match telemetry.failed_tendon {
                    0 => String::new(),
                    tendon => format!(" with tendon {tendon}"),
                };
                let (present, state) = (telemetry.faults.stopping(), state(telemetry.state));
                Failure::failed(
                    format!(
                        "the leg did not {asked}{place}, it is {state} ({})",
                        causes(present)
                    ),
                    remedies_and_clear(present, CLEAR),
                )
            }
            Self::Limited(asked, telemetry) => {
                let limits = telemetry.faults.limits();
                Failure::failed(
                    format!("the leg did not {asked} as demanded ({})", causes(limits)),
                    format!(
                        "{}; it is held at pretension {:.1} N, stiffness {:.1} N·m/rad",
                        remedies(limits),
                        telemetry.pretension_n,
                        telemetry.stiffness_nm_per_rad
                    ),
                )
            }
            Self::StoppedByOtherHost(asked, new_state) => Failure::failed(
                format!(
                    "the leg did not {asked}: another host stopped it, and it is {}",
                    state(*new_state)
                ),
                "find out why, then command again",
            ),
            Self::OtherPose(pose) => Failure::failed(
                format!(
                    "the leg did not move there: it came to rest at {}",
                    pose_words(*pose)
                ),
                "go there by way of other poses",
            ),
            Self::Path(failure) => failure.clone(),
            Self::Point(time_s, refusal) => {
                let [reason, remedy] = refusal::point_description(*time_s, *refusal);
                Failure::refused(reason, remedy)
            }
            Self::Unacknowledged(asked) => Failure::refused(
                format!("the leg did not acknowledge that it will {asked}"),
                "look at the cable, and with `leg monitor` at what the leg does",
            ),
            Self::NotStopped(name) => Failure::failed(
                format!("{name} did not acknowledge the stop"),
                format!("press the emergency stop; without its host {WITHOUT_HOST}"),
            ),
            Self::NothingRecorded => Failure::refused(
                "the leg's settings have it record nothing",
                "name signals in `recorded` in [control] of the rig file, then `leg settings set`",
            ),
            Self::RecordingReplaced => Failure::failed(
                "the leg began to record anew while it was read",
                "read it again; what was recorded before a fault is kept until that is cleared",
            ),
            Self::WrongReply(asked) => Failure::refused(
                format!("the leg sends a reply of another kind when asked to {asked}"),
                refusal::OTHER_SOURCES,
            ),
            Self::TimedOut(asked, timeout, telemetry) => timed_out(asked, *timeout, telemetry),
            Self::ReadBack(names) => Failure::failed(
                format!(
                    "the leg has other settings than were sent: {}",
                    names.join(", ")
                ),
                "set them again; if that does not help, flash anew",
            ),
            Self::CommandTimeTooShort(command_time_s) => Failure::refused(
                format!(
                    "the leg's command timeout is {command_time_s} s, and this program sends every few milliseconds at best"
                ),
                format!(
                    "give command_time_s in [control.limits] of the rig file {COMMAND_TIME_MIN_S} or more, then `leg settings set`"
                ),
            ),
            Self::Cancelled => Failure::failed(
                "ended by Ctrl-C or a signal",
                "the leg is in hold if it was driven; one that was being disarmed goes on to relax",
            ),
            Self::Frame(error) => Failure::refused(
                format!("a message cannot be sent: {error}"),
                "give shorter settings: fewer points of a tendon's curve",
            ),
        }
    }
}

fn timed_out(asked: &str, timeout: Duration, telemetry: &Telemetry<f32>) -> Failure {
    let Telemetry { pose, target, .. } = telemetry;
    let strays = telemetry.state == State::Active && !same_direction(pose, target);
    let (place, remedy) = if strays {
        (
            format!(", {:.2}° off its target", angle_deg(*pose, *target)),
            "calibrate the load cells (`leg calibrate`), and see that the leg hung free, without a payload, as it was homed: a \
             cell or a zero that is off keeps a leg from its target",
        )
    } else {
        (
            String::new(),
            "look with `leg monitor` at what the leg does",
        )
    };
    Failure::failed(
        format!(
            "the leg did not {asked} within {} s; it is {}{place}, faults: {}",
            timeout.as_secs_f64(),
            state(telemetry.state),
            faults(telemetry.faults)
        ),
        remedy,
    )
}

/// The angle between two directions, given by their horizontal components, degrees.
fn angle_deg(a: [f32; 2], b: [f32; 2]) -> f64 {
    let unit = |direction: [f32; 2]| {
        let [x, y] = direction.map(f64::from);
        [x, y, (1.0 - x * x - y * y).max(0.0).sqrt()]
    };
    let chord_squared: f64 = unit(a)
        .iter()
        .zip(unit(b))
        .map(|(a, b)| (a - b).powi(2))
        .sum();
    2.0 * (0.5 * chord_squared.sqrt()).asin().to_degrees()
}

impl From<OperatorError> for Failure {
    fn from(error: OperatorError) -> Self {
        error.failure()
    }
}

impl fmt::Display for OperatorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.failure().fmt(f)
    }
}

impl std::error::Error for OperatorError {}
