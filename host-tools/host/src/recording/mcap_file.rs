//! A recording as MCAP: the settings, every tick as a controller sees it, and what the leg tells, as JSON.

use super::RecordingError;
use super::telemetry_channel::TelemetryChannel;
use super::tick_record::{TickRecord, to_bytes};
use leg_base::words::hex;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::Settings;
use leg_firmware_bench::protocol::BENCH_SCHEMA;
use leg_sim::simulation::Tick;
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Topics.
pub(super) const SETTINGS: &str = "/settings";
pub(super) const TICKS: &str = "/ticks";

/// The key under which a channel tells the schema of its messages.
pub(super) const SCHEMA_KEY: &str = "schema";

/// Ticks between two messages of telemetry.
const TELEMETRY_TICKS: u32 = 32;

/// A tick in ns.
const TICK_NS: u64 = 1_000_000_000 / TICK_HZ as u64;

/// A recording that is being written.
pub struct McapFile {
    writer: Writer<BufWriter<File>>,
    ticks: u16,
    telemetry: TelemetryChannel,
    count: u32,
}

/// The hash of all message types, in words.
pub(super) fn schema() -> String {
    hex(&BENCH_SCHEMA)
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
            telemetry: TelemetryChannel::default(),
            count: 0,
        })
    }

    pub(super) fn take(&mut self, tick: &Tick<'_>) -> Result<(), RecordingError> {
        let record = to_bytes(&TickRecord::of(tick)?)?;
        self.writer
            .write_to_known_channel(&header(self.ticks, self.count), &record)?;
        if self.count.is_multiple_of(TELEMETRY_TICKS) {
            let time_ns = time_ns(self.count);
            self.telemetry
                .write(&mut self.writer, self.count, time_ns, tick.telemetry)?;
        }
        self.count += 1;
        Ok(())
    }

    pub(super) fn finish(&mut self) -> Result<(), RecordingError> {
        self.writer.finish()?;
        Ok(())
    }
}

fn time_ns(tick: u32) -> u64 {
    u64::from(tick) * TICK_NS
}

fn header(channel_id: u16, tick: u32) -> MessageHeader {
    MessageHeader {
        channel_id,
        sequence: tick,
        log_time: time_ns(tick),
        publish_time: time_ns(tick),
    }
}
