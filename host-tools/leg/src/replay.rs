//! `leg replay`.

use crate::options::Options;
use leg_base::failure::Failure;
use leg_base::tick_time::tick_s;
use leg_host::recording::{self, Replay};
use std::path::PathBuf;

/// Runs the firmware's code again on a recording of `leg run --record F.mcap`, and checks that every bit is the same.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The recording.
    file: PathBuf,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let replay = recording::replay(&args.file)?;
    options.report(&replay, || text(&replay))?;
    if replay.other == 0 {
        return Ok(());
    }
    let sentence = format!("{} of {} ticks differ", replay.other, replay.ticks);
    let help = "the control law has changed since the recording";
    Err(Failure::failed(sentence, help))
}

fn text(replay: &Replay) -> String {
    let unfinished = match replay.finished {
        true => "",
        false => "The recording did not come to its end: it is replayed as far as it goes.\n",
    };
    let Some(first) = &replay.first else {
        return format!(
            "{unfinished}{} ticks, each with the bits that were recorded\n",
            replay.ticks
        );
    };
    format!(
        "{unfinished}First difference in tick {} ({:.6} s): duties recorded {:?}, now {:?}\nDrivers on: recorded {}, now {}\n",
        first.tick,
        f64::from(first.tick) * tick_s(),
        first.recorded,
        first.now,
        first.enabled[0],
        first.enabled[1],
    )
}
