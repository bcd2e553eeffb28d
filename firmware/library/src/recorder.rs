//! The last ticks in RAM, each of them: what happened before a fault can be read after it.
//!
//! A row holds the signals that the settings choose, three numbers each, and is written once a tick. A number is a value in steps
//! of its signal, modulo 65 536: the newest row is kept in full, and whoever reads the rows unwraps them from there, because no
//! value that is recorded changes by half of that in a tick: see [`RecordedSignal::steps`].
//!
//! A fault ends the recording after a quarter of the rows more; it begins anew when the fault is cleared. A host can end it, too.

use crate::drive::Drive;
use crate::leg::Leg;
use crate::sensors::TICK_HZ;
use crate::settings::{RECORDED_SIGNALS, RecordedSignal, Settings, SignalSet};
use crate::supervisor::FaultSet;
use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
mod tests;

/// One signal of one tick, in steps modulo 65 536.
pub type Triple = [u16; 3];

/// Triples that there is room for: three signals for 0.2 s.
pub const TRIPLES_MAX: usize = 3 * TICK_HZ as usize / 5;

/// Triples that are read at once: what is copied while the control interrupt waits.
pub const READ_MAX: usize = 16;

/// Ticks after which a recording goes on that a host has ended: a host that has gone must not be the reason that the next fault
/// is not recorded. Every read begins them anew.
const HOST_TICKS: u32 = 10 * TICK_HZ as u32;

/// What a recorder does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[serde(rename_all = "snake_case")]
pub enum RecorderState {
    /// It has no settings yet, or they choose no signal.
    Off,
    /// It writes a row in every tick.
    Recording,
    /// A fault was latched; the rows after it are being written.
    Triggered,
    /// It ended after a fault, until that is cleared.
    Faulted,
    /// A host ended it, until it lets it go on or reads no more.
    Stopped,
}

/// What a host asks of the recorder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum RecorderRequest {
    /// What it holds.
    Report,
    /// Ends the recording, if no fault has.
    Stop,
    /// Begins a recording that a host has ended anew.
    Restart,
    /// Triples from this one on, the oldest row first, some of them, at most [`READ_MAX`]. Answered once the recording has ended.
    Read(u16),
}

/// What the recorder answers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum RecorderReply {
    /// What it holds, after the request.
    Report(RecorderReport),
    /// Triples that were read; none beyond the last.
    Triples(Vec<Triple, READ_MAX>),
}

/// What a recorder holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct RecorderReport {
    /// What it does.
    pub state: RecorderState,
    /// The signals of each row, in the order of [`RECORDED_SIGNALS`].
    pub signals: SignalSet,
    /// Rows that it holds.
    pub rows: u16,
    /// Tick of the newest row.
    pub tick: u32,
    /// The fault that has ended it; none if a host did.
    pub fault: Option<RecordedFault>,
    /// The newest row in full, in steps; of what is not recorded, zeros.
    pub newest: [[i32; 3]; RECORDED_SIGNALS.len()],
}

/// Why a recording ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct RecordedFault {
    /// Tick in which it was latched.
    pub tick: u32,
    /// All that stopped the leg in this tick: later ones may follow from it.
    pub faults: FaultSet,
}

/// What a recorder needs of a leg's settings: found before the control interrupt has to wait for it.
#[derive(Clone, Copy, Debug)]
pub struct RecorderSetup {
    signals: SignalSet,
    steps_per_unit: [[f32; 3]; RECORDED_SIGNALS.len()],
    /// Triples of a row, and those of all rows that there is room for.
    width: usize,
    room: usize,
}

impl RecorderSetup {
    /// Nothing is recorded.
    const NONE: Self = Self {
        signals: SignalSet::NONE,
        steps_per_unit: [[0.0; 3]; RECORDED_SIGNALS.len()],
        width: 0,
        room: 0,
    };

    /// Of a leg with these settings.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let width = settings.recorded.len();
        let rows = TRIPLES_MAX.checked_div(width).unwrap_or(0);
        let per_unit = |signal: RecordedSignal| signal.steps(settings).map(|step| 1.0 / step);
        Self {
            signals: settings.recorded,
            steps_per_unit: RECORDED_SIGNALS.map(per_unit),
            width,
            room: rows * width,
        }
    }
}

/// The recorder of a leg.
#[derive(Clone, Debug)]
pub struct Recorder {
    state: RecorderState,
    /// Whether the last tick had a fault that stops the leg.
    faulted: bool,
    /// Rows that are left after a fault, or ticks until a recording goes on that a host has ended.
    left: u32,
    tick: u32,
    fault: Option<RecordedFault>,
    setup: RecorderSetup,
    /// Triples that were written, at most the room, and where the next goes.
    written: usize,
    next: usize,
    newest: [[i32; 3]; RECORDED_SIGNALS.len()],
    triples: [Triple; TRIPLES_MAX],
}

impl Recorder {
    /// Off. All its bits are zero, so that its place takes no flash.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            state: RecorderState::Off,
            faulted: false,
            left: 0,
            tick: 0,
            fault: None,
            setup: RecorderSetup::NONE,
            written: 0,
            next: 0,
            newest: [[0; 3]; RECORDED_SIGNALS.len()],
            triples: [[0; 3]; TRIPLES_MAX],
        }
    }

    /// Records what the settings choose from now on.
    pub fn begin(&mut self, setup: &RecorderSetup) {
        self.setup = *setup;
        self.restart();
    }

    fn restart(&mut self) {
        self.state = if self.setup.width > 0 {
            RecorderState::Recording
        } else {
            RecorderState::Off
        };
        (self.written, self.next) = (0, 0);
        self.fault = None;
        self.newest = [[0; 3]; RECORDED_SIGNALS.len()];
    }

    /// Takes the row of a tick.
    #[inline(always)]
    pub fn record(&mut self, leg: &Leg<f32>, drive: &Drive<f32>) {
        self.follow_faults(leg);
        if !matches!(
            self.state,
            RecorderState::Recording | RecorderState::Triggered
        ) {
            return;
        }
        self.tick = leg.ticks();
        self.write(leg, drive);
        if self.state == RecorderState::Triggered {
            self.left = self.left.saturating_sub(1);
            if self.left == 0 {
                self.state = RecorderState::Faulted;
            }
        }
    }

    /// Begins and ends with the faults that stop the leg.
    #[inline(always)]
    fn follow_faults(&mut self, leg: &Leg<f32>) {
        let faults = leg.stopping_faults();
        let faulted = faults.any();
        match self.state {
            RecorderState::Recording | RecorderState::Stopped if faulted && !self.faulted => {
                if self.state == RecorderState::Stopped {
                    // Whoever reads finds that it has begun anew: what was before the fault is lost, what follows is not.
                    self.restart();
                }
                self.state = RecorderState::Triggered;
                self.fault = Some(RecordedFault {
                    tick: leg.ticks(),
                    faults,
                });
                // A quarter of the rows: a row is `width` triples.
                self.left = (self.setup.room / 4)
                    .checked_div(self.setup.width)
                    .unwrap_or(0) as u32;
            }
            RecorderState::Faulted if !faulted => self.restart(),
            RecorderState::Stopped => {
                self.left = self.left.saturating_sub(1);
                if self.left == 0 {
                    self.restart();
                }
            }
            _ => {}
        }
        self.faulted = faulted;
    }

    #[inline(always)]
    fn write(&mut self, leg: &Leg<f32>, drive: &Drive<f32>) {
        let row = self.triples.get_mut(self.next..).unwrap_or_default();
        let mut places = row.iter_mut();
        let all = RECORDED_SIGNALS.iter().zip(&self.setup.steps_per_unit);
        for ((signal, steps_per_unit), newest) in all.zip(&mut self.newest) {
            if !self.setup.signals.has(*signal) {
                continue;
            }
            let values = leg.recorded(*signal, drive);
            let Some(place) = places.next() else { return };
            for (((step, place), value), per_unit) in
                newest.iter_mut().zip(place).zip(values).zip(steps_per_unit)
            {
                *step = rounded(value * per_unit);
                *place = *step as u16;
            }
        }
        self.next += self.setup.width;
        if self.next >= self.setup.room {
            self.next = 0;
        }
        self.written = (self.written + self.setup.width).min(self.setup.room);
    }

    /// Answers a host; `None` to a read while it records.
    #[must_use]
    pub fn answer(&mut self, request: RecorderRequest) -> Option<RecorderReply> {
        if let RecorderRequest::Read(first) = request {
            let mut read = Vec::new();
            let ended = self.read(first, &mut read);
            return ended.then_some(RecorderReply::Triples(read));
        }
        self.obey(request);
        Some(RecorderReply::Report(self.report()))
    }

    /// Does what a host asks but to answer.
    pub fn obey(&mut self, request: RecorderRequest) {
        match request {
            RecorderRequest::Stop => {
                if self.state == RecorderState::Recording {
                    self.state = RecorderState::Stopped;
                }
                self.left_for_host();
            }
            RecorderRequest::Restart => {
                if self.state == RecorderState::Stopped {
                    self.restart();
                }
            }
            RecorderRequest::Report | RecorderRequest::Read(_) => {}
        }
    }

    /// What it holds.
    #[must_use]
    #[inline(always)]
    pub fn report(&self) -> RecorderReport {
        RecorderReport {
            state: self.state,
            signals: self.setup.signals,
            rows: self.written.checked_div(self.setup.width).unwrap_or(0) as u16,
            tick: self.tick,
            fault: self.fault,
            newest: self.newest,
        }
    }

    fn left_for_host(&mut self) {
        if self.state == RecorderState::Stopped {
            self.left = HOST_TICKS;
        }
    }

    /// Reads triples as [`RecorderRequest::Read`] asks, into their place; false while it records.
    pub fn read(&mut self, first: u16, out: &mut Vec<Triple, READ_MAX>) -> bool {
        if !matches!(
            self.state,
            RecorderState::Faulted | RecorderState::Stopped | RecorderState::Off
        ) {
            return false;
        }
        self.left_for_host();
        let written = self.triples.get(..self.written).unwrap_or_default();
        // Once it has gone round, the oldest row is the one that would be written next.
        let oldest = if self.written < self.setup.room {
            0
        } else {
            self.next
        };
        let (late, early) = written.split_at_checked(oldest).unwrap_or_default();
        let first = usize::from(first);
        // Up to the end of the ring at most, so that it is one piece.
        let piece = match first.checked_sub(early.len()) {
            Some(first) => late.get(first..),
            None => early.get(first..),
        };
        let piece = piece.unwrap_or_default();
        out.extend_from_slice(piece.get(..READ_MAX).unwrap_or(piece))
            .is_ok()
    }
}

impl Default for Recorder {
    fn default() -> Self {
        Self::new()
    }
}

/// The nearest whole number; the nearest that there is to one that is too large, and 0 to what is no number.
#[inline(always)]
fn rounded(number: f32) -> i32 {
    (if number < 0.0 {
        number - 0.5
    } else {
        number + 0.5
    }) as i32
}
