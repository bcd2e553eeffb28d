//! Reproduces a recording with the present code, bit for bit.

use super::mcap_file::{SCHEMA_KEY, SETTINGS, TICKS, schema};
use super::tick_record::{TickRecord, bits};
use leg_firmware::host_link::BoardKind;
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware_bench::protocol::TickRequest;
use leg_firmware_bench::server::emulated;
use leg_firmware_bench::virtual_leg::VirtualLeg;
use mcap::{Message, MessageStream};
use serde::Deserialize;
use serde::Serialize;
use std::path::Path;

/// Why a recording cannot be replayed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// It is no MCAP file, or it is cut off.
    #[error("is no whole MCAP file: {0}")]
    NoMcap(#[from] mcap::McapError),
    /// Its messages are of another kind.
    #[error("was recorded by other sources (schema {found}, this program {wanted})")]
    OtherSchema {
        /// Of the recording.
        found: String,
        /// Of this program.
        wanted: String,
    },
    /// A message cannot be read.
    #[error("message {0} cannot be read")]
    BadMessage(u32),
    /// It does not begin with settings.
    #[error("holds no settings: it is no recording of `leg run`")]
    NoSettings,
    /// The settings are refused.
    #[error("holds settings that are refused: {0}")]
    Settings(SettingsError),
}

/// How a replay compares with its recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Replay {
    /// Ticks that were replayed.
    pub ticks: u32,
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

/// Replays a recording.
///
/// # Errors
/// A [`ReplayError`].
pub fn replay(file: &Path) -> Result<Replay, ReplayError> {
    let bytes = std::fs::read(file)?;
    let mut leg = None;
    let mut result = Replay {
        ticks: 0,
        other: 0,
        first: None,
    };
    for message in MessageStream::new(&bytes)? {
        let message = message?;
        match (message.channel.topic.as_str(), &mut leg) {
            (SETTINGS, leg) => {
                let settings: Settings = read(&message)?;
                let identity = emulated(BoardKind::InProcess);
                *leg = Some(VirtualLeg::new(identity, &settings).map_err(ReplayError::Settings)?);
            }
            (TICKS, Some(leg)) => result.take(leg, read(&message)?),
            (TICKS, None) => return Err(ReplayError::NoSettings),
            _ => {}
        }
    }
    if leg.is_none() {
        return Err(ReplayError::NoSettings);
    }
    Ok(result)
}

/// The content of a message, if it was written by the same sources.
fn read<'a, T: Deserialize<'a>>(message: &'a Message<'_>) -> Result<T, ReplayError> {
    let found = message.channel.metadata.get(SCHEMA_KEY);
    let wanted = schema();
    if found != Some(&wanted) {
        return Err(ReplayError::OtherSchema {
            found: found.cloned().unwrap_or_else(|| "none".into()),
            wanted,
        });
    }
    postcard::from_bytes(&message.data).map_err(|_| ReplayError::BadMessage(message.sequence))
}

impl Replay {
    fn take(&mut self, leg: &mut VirtualLeg, record: TickRecord) {
        let request = TickRequest {
            sensors: record.sensors,
            link: record.link,
        };
        let drive = leg.tick(&request, |_| true).drive;
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
