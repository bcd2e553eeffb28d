//! Recordings of a leg as MCAP, which Foxglove and PlotJuggler open: written, read and replayed in memory, without files, so that a
//! page can do it, too.
//!
//! Where to begin: a [`McapWriter`] takes what a leg reports; [`read_samples`] gives it back, [`read_signals`] every signal by its
//! name, and [`replay`] runs the firmware on it once more.

mod about;
mod contents;
mod error;
mod player_rows;
mod replay;
mod samples;
mod tick_record;
mod writer;

pub use about::About;
pub use contents::{begins, interim_end};
pub use error::WriteError;
pub use player_rows::{RecordedRow, RecordedSignals, SignalReader, read_signals};
pub use replay::{REPLAY_HELP, Replay, TickDifference, replay};
pub use samples::{Recorded, SAMPLES_HELP, Samples, read_samples};
pub use writer::{CHUNK_BYTES, McapWriter, wall_ns};
