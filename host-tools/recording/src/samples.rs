//! What a recording shows of a leg over time.

use crate::About;
use crate::contents::Contents;
use crate::writer::{ABOUT, RECORDER, REPORT, SIMULATED};
use leg_base::failure::Failure;
use leg_base::recorder_rows::RecorderRow;
use leg_base::tick_time::{seconds, tick_s};
use leg_firmware::telemetry::Telemetry;
use leg_sim::signals;
use leg_sim::simulation::Sample;
use mcap::Message;
use serde::de::DeserializeOwned;

/// What a recording holds.
pub struct Recorded {
    /// What it is of.
    pub about: About,
    /// Whether it came to its end.
    pub finished: bool,
    /// The leg over time.
    pub samples: Samples,
}

/// The leg over time.
pub enum Samples {
    /// A simulated leg, and what is true of it.
    Simulation(Vec<Sample>),
    /// What a leg reported, each with its time since the board's start, s.
    Log(Vec<(f64, Telemetry<f32>)>),
    /// What a board's recorder kept.
    Recorder(Vec<RecorderRow>),
}

/// What to do where there are no samples.
pub const SAMPLES_HELP: &str = "give a file that `leg run --record FILE.mcap`, `leg log --out FILE.mcap` or `leg scope --out FILE.mcap` has written";

/// Reads a recording of that name, as far as it goes.
///
/// # Errors
/// A file that is no MCAP file of `leg` is refused (exit code 2).
pub fn read_samples(name: &str, bytes: &[u8]) -> Result<Recorded, Failure> {
    read(name, bytes).map_err(|error| Failure::refused(format!("{name}: {error}"), SAMPLES_HELP))
}

fn read(name: &str, bytes: &[u8]) -> Result<Recorded, String> {
    let contents = Contents::new(bytes)?;
    let mut about = None;
    let (mut log, mut simulation, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    let mut last_report = Vec::new();
    contents.visit_messages(|message| {
        let topic = message.channel.topic.as_str();
        let unread = |error: String| unreadable(message, &error);
        if topic == ABOUT {
            about = Some(parse(message)?);
        } else if topic == REPORT {
            let telemetry = signals::telemetry(&message.data).map_err(unread)?;
            log.push((seconds(telemetry.tick.into()), telemetry));
            last_report = message.data.to_vec();
        } else if topic == RECORDER {
            rows.push(signals::recorder_row(&message.data).map_err(unread)?);
        } else if topic == SIMULATED {
            // It follows the report of the same tick.
            let (_, telemetry) = log.last().ok_or("has a simulated leg with no report")?;
            simulation.push(Sample {
                time_s: f64::from(message.sequence) * tick_s(),
                comparison: signals::comparison(&last_report, &message.data).map_err(unread)?,
                telemetry: *telemetry,
            });
        }
        Ok(true)
    })?;
    if log.is_empty() && rows.is_empty() {
        return Err("holds no telemetry of a leg".into());
    }
    let samples = if !rows.is_empty() {
        Samples::Recorder(rows)
    } else if simulation.is_empty() {
        Samples::Log(log)
    } else {
        Samples::Simulation(simulation)
    };
    // Recordings of earlier versions do not say it.
    let named = || About::log(name);
    Ok(Recorded {
        about: about.unwrap_or_else(named),
        finished: contents.finished,
        samples,
    })
}

pub(crate) fn parse<T: DeserializeOwned>(message: &Message<'_>) -> Result<T, String> {
    serde_json::from_slice(&message.data).map_err(|error| unreadable(message, &error.to_string()))
}

pub(crate) fn unreadable(message: &Message<'_>, error: &str) -> String {
    let topic = &message.channel.topic;
    format!(
        "message {} of {topic} cannot be read: {error}",
        message.sequence
    )
}
