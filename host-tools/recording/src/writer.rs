//! A recording as MCAP: the settings, of a simulation every tick as a controller sees it, and the signals. What is not needed to
//! run a simulation again is JSON.

use crate::tick_record::{TickRecord, to_bytes};
use crate::{About, WriteError};
use leg_base::description::hex;
use leg_base::recorder_rows::RecorderRow;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::Settings;
use leg_firmware_bench::protocol::BENCH_SCHEMA;
use leg_rig::settings_text;
use leg_sim::signals::{
    RECORDER_SIGNALS, REPORT_SIGNALS, Report, SIMULATED_SIGNALS, Signal, Simulated, json_object,
    json_schema,
};
use leg_sim::simulation::Tick;
use mcap::records::{MessageHeader, Metadata};
use mcap::{WriteOptions, Writer};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{Seek, Write};
use std::mem::ManuallyDrop;
use std::time::Duration;

/// Topics.
pub(crate) const SETTINGS: &str = "/settings";
pub(crate) const TICKS: &str = "/ticks";
pub(crate) const ABOUT: &str = "/about";
pub(crate) const REPORT: &str = "/leg";
pub(crate) const SIMULATED: &str = "/simulation";
pub(crate) const RECORDER: &str = "/recorder";

/// The name of the metadata that says what a recording is of.
pub(crate) const METADATA: &str = "leg";

/// Under which key of it the settings stand, as a rig file.
pub(crate) const METADATA_SETTINGS: &str = "settings";

/// The key of a channel's metadata under which the schema of its messages stands.
pub(crate) const SCHEMA_KEY: &str = "schema";

/// Bytes of a message beside what it says.
const MESSAGE_HEAD_BYTES: usize = 31;

/// Bytes of a chunk at most: then it is written, and other programs look for it as a whole.
pub const CHUNK_BYTES: u64 = 1 << 20;

/// A tick in ns.
const TICK_NS: u64 = 1_000_000_000 / TICK_HZ as u64;

/// A recording that is being written.
pub struct McapWriter<W: Write + Seek> {
    /// Dropped once it has finished alone: its own drop tries to, and panics where the disk is full.
    writer: ManuallyDrop<Writer<W>>,
    /// The channels that were made, by topic.
    channels: BTreeMap<&'static str, u16>,
    /// What it is of, until it is written: with the first message, for a leg's time does not begin at zero.
    about: Option<Value>,
    /// The time of the day that the time zero of a simulated leg is given, ns since 1970.
    begin_ns: u64,
    /// Bytes of the messages so far.
    bytes: u64,
}

/// The hash of all message types, in words: a recording is replayed by the sources that made it.
pub(crate) fn schema() -> String {
    hex(&BENCH_SCHEMA)
}

impl<W: Write + Seek> McapWriter<W> {
    /// Begins it.
    ///
    /// # Errors
    /// What it is written to takes nothing.
    pub fn new(to: W, about: &About, settings: &Settings) -> Result<Self, WriteError> {
        // A chunk is written whole: what is on the disk can be read up to there by any reader.
        let options = WriteOptions::new()
            .compression(None)
            .disable_seeking(true)
            .chunk_size(Some(CHUNK_BYTES))
            .library("leg");
        let mut file = Self {
            writer: ManuallyDrop::new(options.create(to)?),
            channels: BTreeMap::new(),
            about: Some(serde_json::to_value(about).map_err(WriteError::message)?),
            begin_ns: about.begin_wall_time_s.map_or(0, wall_ns),
            bytes: 0,
        };
        file.writer.write_metadata(&metadata(about, settings))?;
        file.write_settings(settings)?;
        file.flush()?;
        Ok(file)
    }

    /// The settings, exactly: a number in f32 is written with as many digits as it has.
    fn write_settings(&mut self, settings: &Settings) -> Result<(), WriteError> {
        // A value in between would write a number in f32 with the digits of one in f64.
        let text = serde_json::to_string(settings).map_err(WriteError::message)?;
        let value = serde_json::from_str(&text).map_err(WriteError::message)?;
        let metadata = BTreeMap::from([(SCHEMA_KEY.to_string(), schema())]);
        let channel = self.described_channel(SETTINGS, &described(SETTINGS, &value), &metadata)?;
        self.write(channel, 0, self.begin_ns, text.as_bytes())
    }

    /// What a controller gets and gives in a tick of a simulation.
    ///
    /// # Errors
    /// What it is written to takes no more; a message that has no form.
    pub fn write_tick(&mut self, number: u32, tick: &Tick<'_>) -> Result<(), WriteError> {
        let channel = self.channel(TICKS, |file| file.postcard_channel(TICKS))?;
        let bytes = to_bytes(&TickRecord::new(tick)?)?;
        self.write(channel, number, self.simulated_ns(number), &bytes)
    }

    /// The leg in a tick of a simulation.
    ///
    /// # Errors
    /// What it is written to takes no more; a message that has no form.
    pub fn write_simulation(
        &mut self,
        number: u32,
        (report, simulated): &(Report, Simulated),
    ) -> Result<(), WriteError> {
        let time_ns = self.simulated_ns(number);
        self.write_report(number, time_ns, report)?;
        self.write_signals(SIMULATED, SIMULATED_SIGNALS, number, time_ns, simulated)
    }

    /// What a leg reports.
    ///
    /// # Errors
    /// What it is written to takes no more; a message that has no form.
    pub fn write_report(
        &mut self,
        number: u32,
        time_ns: u64,
        report: &Report,
    ) -> Result<(), WriteError> {
        self.write_about(time_ns)?;
        self.write_signals(REPORT, REPORT_SIGNALS, number, time_ns, report)
    }

    /// A row of a board's recorder.
    ///
    /// # Errors
    /// What it is written to takes no more; a message that has no form.
    pub fn write_recorder_row(
        &mut self,
        number: u32,
        time_ns: u64,
        row: &RecorderRow,
    ) -> Result<(), WriteError> {
        self.write_about(time_ns)?;
        self.write_signals(RECORDER, RECORDER_SIGNALS, number, time_ns, row)
    }

    fn write_about(&mut self, time_ns: u64) -> Result<(), WriteError> {
        let Some(about) = self.about.take() else {
            return Ok(());
        };
        let channel = self.json_channel(ABOUT, &about_schema())?;
        self.write(channel, 0, time_ns, about.to_string().as_bytes())
    }

    fn write_signals<S>(
        &mut self,
        topic: &'static str,
        signals: &[Signal<S>],
        number: u32,
        time_ns: u64,
        of: &S,
    ) -> Result<(), WriteError> {
        let make = |file: &mut Self| file.json_channel(topic, &json_schema(topic, signals));
        let channel = self.channel(topic, make)?;
        let message = Value::Object(json_object(signals, of));
        self.write(channel, number, time_ns, message.to_string().as_bytes())
    }

    /// The channel of a topic: made with its first message.
    fn channel(
        &mut self,
        topic: &'static str,
        make: impl FnOnce(&mut Self) -> Result<u16, WriteError>,
    ) -> Result<u16, WriteError> {
        if let Some(channel) = self.channels.get(topic) {
            return Ok(*channel);
        }
        let channel = make(self)?;
        self.channels.insert(topic, channel);
        Ok(channel)
    }

    fn json_channel(&mut self, topic: &str, schema: &Value) -> Result<u16, WriteError> {
        self.described_channel(topic, schema, &BTreeMap::new())
    }

    fn described_channel(
        &mut self,
        topic: &str,
        schema: &Value,
        metadata: &BTreeMap<String, String>,
    ) -> Result<u16, WriteError> {
        let schema = schema.to_string().into_bytes();
        let id = self.writer.add_schema(topic, "jsonschema", &schema)?;
        Ok(self.writer.add_channel(id, topic, "json", metadata)?)
    }

    fn postcard_channel(&mut self, topic: &str) -> Result<u16, WriteError> {
        let metadata = BTreeMap::from([(SCHEMA_KEY.to_string(), schema())]);
        Ok(self.writer.add_channel(0, topic, "postcard", &metadata)?)
    }

    fn write(
        &mut self,
        channel_id: u16,
        sequence: u32,
        time_ns: u64,
        message: &[u8],
    ) -> Result<(), WriteError> {
        let header = MessageHeader {
            channel_id,
            sequence,
            log_time: time_ns,
            publish_time: time_ns,
        };
        self.bytes += (MESSAGE_HEAD_BYTES + message.len()) as u64;
        Ok(self.writer.write_to_known_channel(&header, message)?)
    }

    /// The time of a tick of a simulation.
    fn simulated_ns(&self, tick: u32) -> u64 {
        self.begin_ns + u64::from(tick) * TICK_NS
    }

    /// The time of the day that a time of a simulated leg is given, s, in ns since 1970.
    #[must_use]
    pub fn leg_time_ns(&self, time_s: f64) -> u64 {
        self.begin_ns + wall_ns(time_s)
    }

    /// Ends the chunk, and lets the system have it.
    ///
    /// # Errors
    /// What it is written to takes no more; a message that has no form.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        Ok(self.writer.flush()?)
    }

    /// About how many bytes it has.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Ends it, and gives back what it was written to.
    ///
    /// # Errors
    /// What it is written to takes no more.
    pub fn finish(mut self) -> Result<W, WriteError> {
        self.writer.finish()?;
        Ok(ManuallyDrop::into_inner(self.writer).into_inner())
    }
}

/// A time of the day, s since 1970, in ns; zero for one that is none.
#[must_use]
pub fn wall_ns(wall_time_s: f64) -> u64 {
    // A product of so many ns would be rounded to 256.
    Duration::try_from_secs_f64(wall_time_s).map_or(0, |since| since.as_nanos() as u64)
}

/// What a recording is of, for programs that read no topics.
fn metadata(about: &About, settings: &Settings) -> Metadata {
    let seed = about.seed.map(|seed| seed.to_string());
    let begin_wall_time_s = about.begin_wall_time_s.map(|time_s| time_s.to_string());
    let entries = [
        ("title", Some(about.title.clone())),
        ("version", Some(about.version.clone())),
        ("scenario", about.scenario.clone()),
        ("rig", about.rig.clone()),
        ("seed", seed),
        ("begin_wall_time_s", begin_wall_time_s),
        (METADATA_SETTINGS, Some(settings_text::rig_file(settings))),
    ];
    let known = entries.into_iter();
    let known = known.filter_map(|(key, value)| Some((key.to_string(), value?)));
    Metadata {
        name: METADATA.into(),
        metadata: known.collect(),
    }
}

/// The JSON schema that a message like this one has. What is null in it may be anything.
fn described(title: &str, message: &Value) -> Value {
    let mut schema = kind(message);
    schema["title"] = title.into();
    schema
}

fn kind(value: &Value) -> Value {
    match value {
        Value::Null => json!({}),
        Value::Bool(_) => json!({ "type": "boolean" }),
        Value::Number(_) => json!({ "type": "number" }),
        Value::String(_) => json!({ "type": "string" }),
        // A list's parts are alike.
        Value::Array(parts) => match parts.first() {
            Some(part) => json!({ "type": "array", "items": kind(part) }),
            None => json!({ "type": "array" }),
        },
        Value::Object(entries) => {
            let properties = entries
                .iter()
                .map(|(key, value)| (key.clone(), kind(value)));
            let properties: serde_json::Map<String, Value> = properties.collect();
            json!({ "type": "object", "properties": properties })
        }
    }
}

fn about_schema() -> Value {
    let text = json!({ "type": ["string", "null"] });
    json!({
        "title": ABOUT,
        "type": "object",
        "properties": {
            "title": text,
            "version": text,
            "scenario": text,
            "rig": text,
            "seed": { "type": ["integer", "null"] },
            "begin_wall_time_s": { "type": ["number", "null"] },
        },
    })
}
