//! What a recording shows of a leg over time.

use super::About;
use super::contents::Contents;
use super::mcap_file::{ABOUT, COMPARISON, TELEMETRY};
use leg_base::failure::Failure;
use leg_base::tick_time::tick_s;
use leg_firmware::telemetry::Telemetry;
use leg_sim::simulation::{Comparison, Sample};
use mcap::Message;
use serde::de::DeserializeOwned;
use std::path::Path;

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
}

/// Reads a recording, as far as it goes.
///
/// # Errors
/// A file that is no MCAP file of `leg` is refused (exit code 2).
pub fn read_samples(file: &Path) -> Result<Recorded, Failure> {
    read(file).map_err(|error| {
        Failure::refused(
            format!("{}: {error}", file.display()),
            "give a file that `leg run --record FILE.mcap` or `leg log --out FILE.mcap` has written",
        )
    })
}

fn read(file: &Path) -> Result<Recorded, String> {
    let contents = Contents::read(file)?;
    let mut about = None;
    let (mut log, mut simulation) = (Vec::new(), Vec::new());
    contents.each(|message| {
        let topic = message.channel.topic.as_str();
        if topic == ABOUT.0 {
            about = Some(parse(message)?);
        } else if topic == TELEMETRY.0 {
            log.push((message.log_time as f64 * 1e-9, parse(message)?));
        } else if topic == COMPARISON.0 {
            // It follows the telemetry of the same tick.
            let (_, telemetry) = log.last().ok_or("has a comparison with no telemetry")?;
            let comparison: Comparison = parse(message)?;
            simulation.push(Sample {
                time_s: f64::from(message.sequence) * tick_s(),
                comparison,
                telemetry: *telemetry,
            });
        }
        Ok(true)
    })?;
    if log.is_empty() {
        return Err("holds no telemetry of a leg".into());
    }
    let samples = if simulation.is_empty() {
        Samples::Log(log)
    } else {
        Samples::Simulation(simulation)
    };
    // Recordings of earlier versions do not say it.
    let named = || About::log(&file.display().to_string());
    Ok(Recorded {
        about: about.unwrap_or_else(named),
        finished: contents.finished,
        samples,
    })
}

fn parse<T: DeserializeOwned>(message: &Message<'_>) -> Result<T, String> {
    serde_json::from_slice(&message.data).map_err(|error| {
        let topic = &message.channel.topic;
        format!(
            "message {} of {topic} cannot be read: {error}",
            message.sequence
        )
    })
}
