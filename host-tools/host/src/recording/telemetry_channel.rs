//! What a leg tells, as JSON in an MCAP file.

use super::RecordingError;
use leg_firmware::telemetry::Telemetry;
use mcap::Writer;
use mcap::records::MessageHeader;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{Seek, Write};

const TOPIC: &str = "/leg";

/// The channel: made with its first message, whose fields its schema lists.
#[derive(Debug, Default)]
pub(super) struct TelemetryChannel(Option<u16>);

impl TelemetryChannel {
    /// Writes what the leg tells at a time.
    pub fn write<W: Write + Seek>(
        &mut self,
        writer: &mut Writer<W>,
        sequence: u32,
        time_ns: u64,
        telemetry: &Telemetry<f32>,
    ) -> Result<(), RecordingError> {
        let form = |error: serde_json::Error| RecordingError::Form(error.to_string());
        let value = serde_json::to_value(telemetry).map_err(form)?;
        let channel_id = match self.0 {
            Some(channel) => channel,
            None => {
                let schema = serde_json::to_vec(&schema_of(&value)).map_err(form)?;
                let id = writer.add_schema("Telemetry", "jsonschema", &schema)?;
                writer.add_channel(id, TOPIC, "json", &BTreeMap::new())?
            }
        };
        self.0 = Some(channel_id);
        let header = MessageHeader {
            channel_id,
            sequence,
            log_time: time_ns,
            publish_time: time_ns,
        };
        let text = serde_json::to_vec(&value).map_err(form)?;
        writer.write_to_known_channel(&header, &text)?;
        Ok(())
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
