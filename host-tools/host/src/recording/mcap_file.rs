//! A recording as MCAP: of a simulation the settings, every tick as a controller sees it, and the leg beside what it reports; of
//! all the telemetry. What is not needed to run it again is JSON.

use super::tick_record::{TickRecord, to_bytes};
use super::{About, RecordingError, to_json};
use leg_base::description::hex;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::BENCH_SCHEMA;
use leg_sim::simulation::{SAMPLE_TICKS, Tick};
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::mem::ManuallyDrop;

/// Topics.
pub(super) const SETTINGS: &str = "/settings";
pub(super) const TICKS: &str = "/ticks";
pub(super) const ABOUT: Topic = ("/about", "About");
pub(super) const TELEMETRY: Topic = ("/leg", "Telemetry");
pub(super) const COMPARISON: Topic = ("/simulation", "Comparison");

/// A topic of JSON, and the name of its messages' schema.
pub(super) type Topic = (&'static str, &'static str);

/// The key of a channel's metadata under which the schema of its messages stands.
pub(super) const SCHEMA_KEY: &str = "schema";

/// A tick in ns.
const TICK_NS: u64 = 1_000_000_000 / TICK_HZ as u64;

/// A file that is being written. A channel is made with its first message.
pub(super) struct McapFile {
    /// Dropped once it has finished alone: its own drop tries to, and panics where the disk is full.
    writer: ManuallyDrop<Writer<BufWriter<File>>>,
    ticks: Option<u16>,
    telemetry: Option<u16>,
    comparison: Option<u16>,
    /// What it is of, until it is written: with the first message, for a leg's time does not begin at zero.
    about: Option<Value>,
}

/// The hash of all message types, in words: a recording is replayed by the sources that made it.
pub(super) fn schema() -> String {
    hex(&BENCH_SCHEMA)
}

impl McapFile {
    pub fn new(
        file: File,
        about: &About,
        settings: Option<&Settings>,
    ) -> Result<Self, RecordingError> {
        let options = WriteOptions::new().compression(None).library("leg");
        let mut file = Self {
            writer: ManuallyDrop::new(options.create(BufWriter::new(file))?),
            ticks: None,
            telemetry: None,
            comparison: None,
            about: Some(to_json(about)?),
        };
        if let Some(settings) = settings {
            let channel = file.postcard_channel(SETTINGS)?;
            file.write(channel, 0, 0, &to_bytes(settings)?)?;
            file.flush()?;
        }
        Ok(file)
    }

    pub fn take_tick(&mut self, number: u32, tick: &Tick<'_>) -> Result<(), RecordingError> {
        let time_ns = u64::from(number) * TICK_NS;
        let channel = match self.ticks {
            Some(channel) => channel,
            None => self.postcard_channel(TICKS)?,
        };
        self.ticks = Some(channel);
        self.write(
            channel,
            number,
            time_ns,
            &to_bytes(&TickRecord::new(tick)?)?,
        )?;
        if number.is_multiple_of(SAMPLE_TICKS) {
            self.write_telemetry(number, time_ns, tick.telemetry)?;
            let value = to_json(tick.comparison)?;
            let channel = self.json_channel(self.comparison, COMPARISON, &value)?;
            self.comparison = Some(channel);
            self.write(channel, number, time_ns, value.to_string().as_bytes())?;
        }
        Ok(())
    }

    pub fn write_telemetry(
        &mut self,
        number: u32,
        time_ns: u64,
        telemetry: &Telemetry<f32>,
    ) -> Result<(), RecordingError> {
        if let Some(about) = self.about.take() {
            let channel = self.json_channel(None, ABOUT, &about)?;
            self.write(channel, 0, time_ns, about.to_string().as_bytes())?;
        }
        let value = to_json(telemetry)?;
        let channel = self.json_channel(self.telemetry, TELEMETRY, &value)?;
        self.telemetry = Some(channel);
        self.write(channel, number, time_ns, value.to_string().as_bytes())
    }

    /// A topic's channel; made for messages like this one where there is none yet.
    fn json_channel(
        &mut self,
        made: Option<u16>,
        (topic, name): Topic,
        message: &Value,
    ) -> Result<u16, RecordingError> {
        if let Some(channel) = made {
            return Ok(channel);
        }
        let schema = json_schema(message).to_string().into_bytes();
        let id = self.writer.add_schema(name, "jsonschema", &schema)?;
        Ok(self
            .writer
            .add_channel(id, topic, "json", &BTreeMap::new())?)
    }

    fn postcard_channel(&mut self, topic: &str) -> Result<u16, RecordingError> {
        let metadata = BTreeMap::from([(SCHEMA_KEY.to_string(), schema())]);
        Ok(self.writer.add_channel(0, topic, "postcard", &metadata)?)
    }

    fn write(
        &mut self,
        channel_id: u16,
        sequence: u32,
        time_ns: u64,
        message: &[u8],
    ) -> Result<(), RecordingError> {
        let header = MessageHeader {
            channel_id,
            sequence,
            log_time: time_ns,
            publish_time: time_ns,
        };
        Ok(self.writer.write_to_known_channel(&header, message)?)
    }

    /// Ends the chunk, and lets the system have it.
    pub fn flush(&mut self) -> Result<(), RecordingError> {
        Ok(self.writer.flush()?)
    }

    pub fn finish(mut self) -> Result<(), RecordingError> {
        self.writer.finish()?;
        drop(ManuallyDrop::into_inner(self.writer));
        Ok(())
    }
}

/// The JSON schema of a value, by which Foxglove lists its fields.
fn json_schema(value: &Value) -> Value {
    match value {
        Value::Object(map) => {
            let properties: serde_json::Map<String, Value> = map
                .iter()
                .map(|(key, value)| (key.clone(), json_schema(value)))
                .collect();
            json!({"type": "object", "properties": properties})
        }
        Value::Array(values) => {
            json!({"type": "array", "items": values.first().map(json_schema)})
        }
        Value::String(_) => json!({"type": "string"}),
        Value::Bool(_) => json!({"type": "boolean"}),
        _ => json!({"type": "number"}),
    }
}
