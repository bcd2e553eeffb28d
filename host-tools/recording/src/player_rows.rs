//! Every signal of a recording over time, for a player.

use crate::About;
use crate::contents::Contents;
use crate::samples::{parse, unreadable};
use crate::writer::{ABOUT, METADATA, METADATA_SETTINGS, RECORDER, REPORT, SIMULATED};
use leg_base::failure::Failure;
use leg_base::tick_time::seconds;
use leg_firmware::telemetry::Telemetry;
use leg_sim::signals::{self, REPORT_SIGNALS, SIMULATED_SIGNALS, Signal};
use mcap::Message;
use serde_json::{Map, Value};
use std::cell::Cell;
use std::future::poll_fn;
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

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
    let mut reader = SignalReader::new(name.into(), bytes.to_vec());
    loop {
        if let Some(read) = reader.read_on(usize::MAX) {
            return read;
        }
    }
}

/// What is left to read of a recording.
type Work = Pin<Box<dyn Future<Output = Result<RecordedSignals, Failure>>>>;

/// Reads every signal of a recording in parts, for a program that has to do something else in between.
pub struct SignalReader {
    /// None once its result was given.
    work: Option<Work>,
    progress: Rc<Progress>,
}

/// What passes between the reader and its work.
#[derive(Default)]
struct Progress {
    /// Messages that may be read until the next pause.
    allowed: Cell<usize>,
    /// Messages that were read.
    read: Cell<usize>,
    /// Time of the leg that was read, s.
    read_s: Cell<f64>,
}

impl Progress {
    /// Waits until one more message may be read.
    async fn wait(&self) {
        poll_fn(|_| match self.allowed.get().checked_sub(1) {
            Some(left) => {
                self.allowed.set(left);
                Poll::Ready(())
            }
            None => Poll::Pending,
        })
        .await;
    }

    /// Notes a message that was read.
    fn note(&self, read_s: f64) {
        self.read.update(|read| read + 1);
        self.read_s.set(read_s);
    }
}

impl SignalReader {
    /// Of a recording of that name, of which nothing is read yet.
    #[must_use]
    pub fn new(name: String, bytes: Vec<u8>) -> Self {
        let progress = Rc::<Progress>::default();
        let noted = progress.clone();
        Self {
            work: Some(Box::pin(async move {
                read(&name, &bytes, &noted).await.map_err(|error| {
                    Failure::refused(
                        format!("{name}: {error}"),
                        "give a file that this window, `leg run --record FILE.mcap` or `leg log --out FILE.mcap` has written",
                    )
                })
            })),
            progress,
        }
    }

    /// Reads so many messages at the most. All signals once everything is read; none before that, and after they were
    /// given.
    ///
    /// # Errors
    /// As [`read_signals`].
    pub fn read_on(&mut self, messages: usize) -> Option<Result<RecordedSignals, Failure>> {
        self.progress.allowed.set(messages);
        let context = &mut Context::from_waker(Waker::noop());
        match self.work.as_mut()?.as_mut().poll(context) {
            Poll::Ready(read) => {
                self.work = None;
                Some(read)
            }
            Poll::Pending => None,
        }
    }

    /// How many messages were read.
    #[must_use]
    pub fn messages(&self) -> usize {
        self.progress.read.get()
    }

    /// How much of the leg's time was read, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.progress.read_s.get()
    }
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

async fn read(name: &str, bytes: &[u8], progress: &Progress) -> Result<RecordedSignals, String> {
    let contents = Contents::new(bytes)?;
    let mut reading = Reading {
        about: None,
        simulated: false,
        rows: Vec::new(),
        since_s: 0.0,
        numbers: Vec::new(),
    };
    for message in contents.messages()? {
        progress.wait().await;
        reading.take(&message?)?;
        progress.note(reading.read_s());
    }
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

    fn take(&mut self, message: &Message<'_>) -> Result<(), String> {
        let unread = |error: String| unreadable(message, &error);
        match message.channel.topic.as_str() {
            ABOUT => self.about = Some(parse(message)?),
            REPORT => self.report(&message.data).map_err(unread)?,
            SIMULATED => self.truth(&message.data).map_err(unread)?,
            RECORDER => {
                return Err("holds what a board's recorder kept: `leg plot` shows it".into());
            }
            _ => {}
        }
        Ok(())
    }

    /// Time from the first report to the last one, s.
    fn read_s(&self) -> f64 {
        let ends = self.rows.first().zip(self.rows.last());
        ends.map_or(0.0, |(first, last)| last.time_s - first.time_s)
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
