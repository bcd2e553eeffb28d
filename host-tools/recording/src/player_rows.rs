//! Every signal of a recording over time, for a player.

use crate::About;
use crate::contents::Contents;
use crate::samples::{parse, unreadable};
use crate::writer::{ABOUT, METADATA, METADATA_SETTINGS, RECORDER, REPORT, SIMULATED};
use leg_base::failure::Failure;
use leg_base::tick_time::seconds;
use leg_firmware::telemetry::Telemetry;
use leg_sim::signals::{self, REPORT_SIGNALS, SIMULATED_SIGNALS, Signal};
use serde_json::{Map, Value};

/// A leg over time, with every signal that has numbers.
pub struct RecordedSignals {
    /// What it is of.
    pub about: About,
    /// The leg's settings as a rig file; none in a recording of earlier versions.
    pub rig: Option<String>,
    /// Whether it came to its end.
    pub finished: bool,
    /// Whether it is of a simulated leg.
    pub simulated: bool,
    /// The leg over time, which only goes on.
    pub rows: Vec<RecordedRow>,
}

/// A leg at a time.
pub struct RecordedRow {
    /// Time since its board started, s. Where a board has started anew, it goes on from there.
    pub time_s: f64,
    /// What it reported.
    pub telemetry: Telemetry<f32>,
    /// The numbers of [`REPORT_SIGNALS`] and, of a simulated leg, of [`SIMULATED_SIGNALS`]; not a number where there is none.
    pub numbers: Box<[f32]>,
}

/// Reads every signal of a recording of that name, as far as it goes.
///
/// # Errors
/// What is no recording of a leg's telemetry is refused, with the place where that is known.
pub fn read_signals(name: &str, bytes: &[u8]) -> Result<RecordedSignals, Failure> {
    read(name, bytes).map_err(|error| {
        Failure::refused(
            format!("{name}: {error}"),
            "give a file that this window, `leg run --record FILE.mcap` or `leg log --out FILE.mcap` has written",
        )
    })
}

/// What is read so far.
struct Reading {
    about: Option<About>,
    simulated: bool,
    rows: Vec<RecordedRow>,
    /// What is added to the time of the board, s.
    since_s: f64,
    numbers: Vec<f64>,
}

fn read(name: &str, bytes: &[u8]) -> Result<RecordedSignals, String> {
    let contents = Contents::new(bytes)?;
    let mut reading = Reading {
        about: None,
        simulated: false,
        rows: Vec::new(),
        since_s: 0.0,
        numbers: Vec::new(),
    };
    contents.for_each_message(|message| {
        let unread = |error: String| unreadable(message, &error);
        match message.channel.topic.as_str() {
            ABOUT => reading.about = Some(parse(message)?),
            REPORT => reading.report(&message.data).map_err(unread)?,
            SIMULATED => reading.truth(&message.data).map_err(unread)?,
            RECORDER => {
                return Err("holds what a board's recorder kept: `leg plot` shows it".into());
            }
            _ => {}
        }
        Ok(true)
    })?;
    if reading.rows.is_empty() {
        return Err("holds no telemetry of a leg".into());
    }
    let metadata = contents.metadata(METADATA);
    Ok(RecordedSignals {
        about: reading.about.unwrap_or_else(|| About::log(name)),
        rig: metadata.and_then(|mut metadata| metadata.remove(METADATA_SETTINGS)),
        finished: contents.finished,
        simulated: reading.simulated,
        rows: reading.rows,
    })
}

fn object(json: &[u8]) -> Result<Map<String, Value>, String> {
    serde_json::from_slice(json).map_err(|error| error.to_string())
}

impl Reading {
    fn numbers_of<S>(&mut self, signals: &[Signal<S>], json: &[u8]) -> Result<Box<[f32]>, String> {
        self.numbers.clear();
        signals::numbers(signals, &object(json)?, &mut self.numbers);
        Ok(self.numbers.iter().map(|number| *number as f32).collect())
    }

    fn report(&mut self, json: &[u8]) -> Result<(), String> {
        let telemetry = signals::telemetry(json)?;
        let board_s = seconds(telemetry.tick.into());
        if let Some(last) = self.rows.last()
            && last.telemetry.tick > telemetry.tick
        {
            self.since_s = last.time_s;
        }
        let numbers = self.numbers_of(REPORT_SIGNALS, json)?;
        self.rows.push(RecordedRow {
            time_s: self.since_s + board_s,
            telemetry,
            numbers,
        });
        Ok(())
    }

    /// What is true of the leg of the last report.
    fn truth(&mut self, json: &[u8]) -> Result<(), String> {
        let numbers = self.numbers_of(SIMULATED_SIGNALS, json)?;
        let last = self.rows.last_mut();
        let last = last.ok_or("there is no report of the same tick")?;
        last.numbers = [&*last.numbers, &*numbers].concat().into();
        self.simulated = true;
        Ok(())
    }
}
