//! A recording as MCAP: the settings, every tick as a controller sees it, and what the leg tells, as JSON.

use super::RecordingError;
use super::tick_record::{TickRecord, to_bytes};
use crate::simulation::Tick;
use leg_firmware::protocol::SCHEMA;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Topics.
pub(super) const SETTINGS: &str = "/settings";
pub(super) const TICKS: &str = "/ticks";
const TELEMETRY: &str = "/leg";

/// The key under which a channel tells the schema of its messages.
pub(super) const SCHEMA_KEY: &str = "schema";

/// Ticks between two messages of telemetry.
const TELEMETRY_TICKS: u32 = 32;

/// A tick in ns.
const TICK_NS: u64 = 125_000;

/// A recording that is being written.
pub struct McapFile {
    writer: Writer<BufWriter<File>>,
    ticks: u16,
    /// The channel of the telemetry: made with its first message, whose fields its schema lists.
    telemetry: Option<u16>,
    count: u32,
}

/// The hash of all message types, in words.
pub(super) fn schema() -> String {
    SCHEMA.iter().map(|byte| format!("{byte:02x}")).collect()
}

impl McapFile {
    pub(super) fn create(file: &Path, settings: &Settings) -> Result<Self, RecordingError> {
        let options = WriteOptions::new().compression(None).library("leg");
        let mut writer = options.create(BufWriter::new(File::create(file)?))?;
        let told = BTreeMap::from([(SCHEMA_KEY.to_string(), schema())]);
        let channel = writer.add_channel(0, SETTINGS, "postcard", &told)?;
        writer.write_to_known_channel(&header(channel, 0), &to_bytes(settings)?)?;
        let ticks = writer.add_channel(0, TICKS, "postcard", &told)?;
        Ok(Self {
            writer,
            ticks,
            telemetry: None,
            count: 0,
        })
    }

    pub(super) fn take(&mut self, tick: &Tick<'_>) -> Result<(), RecordingError> {
        let record = to_bytes(&TickRecord::of(tick)?)?;
        self.writer
            .write_to_known_channel(&header(self.ticks, self.count), &record)?;
        if self.count.is_multiple_of(TELEMETRY_TICKS) {
            self.tell(tick.telemetry)?;
        }
        self.count += 1;
        Ok(())
    }

    fn tell(&mut self, telemetry: &Telemetry<f32>) -> Result<(), RecordingError> {
        let form = |error: serde_json::Error| RecordingError::Form(error.to_string());
        let value = serde_json::to_value(telemetry).map_err(form)?;
        let channel = match self.telemetry {
            Some(channel) => channel,
            None => {
                let schema = serde_json::to_vec(&schema_of(&value)).map_err(form)?;
                let id = self.writer.add_schema("Telemetry", "jsonschema", &schema)?;
                let none = BTreeMap::new();
                self.writer.add_channel(id, TELEMETRY, "json", &none)?
            }
        };
        self.telemetry = Some(channel);
        let text = serde_json::to_vec(&value).map_err(form)?;
        self.writer
            .write_to_known_channel(&header(channel, self.count), &text)?;
        Ok(())
    }

    pub(super) fn finish(&mut self) -> Result<(), RecordingError> {
        self.writer.finish()?;
        Ok(())
    }
}

fn header(channel_id: u16, tick: u32) -> MessageHeader {
    let time = u64::from(tick) * TICK_NS;
    MessageHeader {
        channel_id,
        sequence: tick,
        log_time: time,
        publish_time: time,
    }
}

/// The JSON schema that a value fulfils.
fn schema_of(value: &Value) -> Value {
    match value {
        Value::Object(map) => {
            let properties: serde_json::Map<String, Value> = map
                .iter()
                .map(|(key, value)| (key.clone(), schema_of(value)))
                .collect();
            json!({"type": "object", "properties": properties})
        }
        Value::Array(values) => {
            json!({"type": "array", "items": values.first().map(schema_of)})
        }
        Value::String(_) => json!({"type": "string"}),
        Value::Bool(_) => json!({"type": "boolean"}),
        _ => json!({"type": "number"}),
    }
}
