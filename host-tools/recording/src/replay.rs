//! Reproduces a recording with the present code, bit for bit.

use crate::contents::Contents;
use crate::samples::unreadable;
use crate::tick_record::{TickRecord, bits};
use crate::writer::{RECORDER, REPORT, SCHEMA_KEY, SETTINGS, TICKS, schema};
use leg_base::failure::Failure;
use leg_firmware::host_link::BoardKind;
use leg_firmware::recorder::{Recorder, RecorderSetup};
use leg_firmware_bench::protocol::TickRequest;
use leg_firmware_bench::server::emulated;
use leg_firmware_bench::virtual_leg::VirtualLeg;
use mcap::Message;
use serde::{Deserialize, Serialize};

/// How a replay compares with its recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Replay {
    /// Ticks that were replayed.
    pub ticks: u32,
    /// Whether the recording came to its end; otherwise it is replayed as far as it goes.
    pub finished: bool,
    /// Ticks whose duties have other bits.
    pub other: u32,
    /// The first of them, if any.
    pub first: Option<TickDifference>,
}

/// A tick in which the present code gives other duties.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TickDifference {
    /// Tick, counted from 0.
    pub tick: u32,
    /// Duties that were recorded.
    pub recorded: [f32; 3],
    /// Duties now.
    pub now: [f32; 3],
    /// Whether the drivers were on, and are now.
    pub enabled: [bool; 2],
}

/// What to do where there is nothing to replay.
pub const REPLAY_HELP: &str = "record anew with `leg run --record FILE.mcap`";

/// Replays a recording of that name.
///
/// # Errors
/// One that is no recording of `leg run`, or of other sources, is refused.
pub fn replay(name: &str, bytes: &[u8]) -> Result<Replay, Failure> {
    compare(bytes).map_err(|error| Failure::refused(format!("{name}: {error}"), REPLAY_HELP))
}

fn compare(bytes: &[u8]) -> Result<Replay, String> {
    let contents = Contents::new(bytes)?;
    let mut leg = None;
    let mut recorder = Box::new(Recorder::new());
    let mut result = Replay {
        ticks: 0,
        finished: contents.finished,
        other: 0,
        first: None,
    };
    contents.visit_messages(|message| {
        match (message.channel.topic.as_str(), &mut leg) {
            (SETTINGS, leg) => {
                let identity = emulated(BoardKind::InProcess);
                let settings = &read(message)?;
                let virtual_leg = VirtualLeg::new(identity, settings)
                    .map_err(|error| format!("holds settings that are refused: {error}"))?;
                recorder.begin(&RecorderSetup::new(settings));
                *leg = Some(virtual_leg);
            }
            (TICKS, Some(leg)) => result.take(leg, &mut recorder, read(message)?),
            (TICKS, None) => return Ok(false),
            // A log and what a recorder held have settings, too, but no ticks.
            (REPORT | RECORDER, leg) if result.ticks == 0 => {
                *leg = None;
                return Ok(false);
            }
            _ => {}
        }
        Ok(true)
    })?;
    leg.map(|_| result)
        .ok_or_else(|| "holds no ticks: it is no recording of `leg run`".into())
}

/// The content of a message, if it was written by the same sources.
fn read<'a, T: Deserialize<'a>>(message: &'a Message<'_>) -> Result<T, String> {
    let wanted = schema();
    match message.channel.metadata.get(SCHEMA_KEY) {
        // The settings are JSON; recordings of earlier versions have them in postcard's format, as the ticks.
        Some(found) if *found == wanted && message.channel.message_encoding == "json" => {
            serde_json::from_slice(&message.data)
                .map_err(|error| unreadable(message, &error.to_string()))
        }
        Some(found) if *found == wanted => postcard::from_bytes(&message.data)
            .map_err(|_| format!("message {} cannot be read", message.sequence)),
        found => {
            let found = found.map_or("none", String::as_str);
            Err(format!(
                "was recorded by other sources (schema {found}, this program {wanted})"
            ))
        }
    }
}

impl Replay {
    fn take(&mut self, leg: &mut VirtualLeg, recorder: &mut Recorder, record: TickRecord) {
        let request = TickRequest {
            sensors: record.sensors,
            link: record.link,
        };
        let drive = leg.tick(&request, recorder, |_| true).drive;
        if bits(&drive) != (record.duty_bits, record.enabled) {
            self.other += 1;
            self.first.get_or_insert(TickDifference {
                tick: self.ticks,
                recorded: record.duty_bits.map(f32::from_bits),
                now: drive.duty,
                enabled: [record.enabled, drive.enabled],
            });
        }
        self.ticks += 1;
    }
}
