//! `leg replay`.

use super::print;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::tick_time::tick_s;
use leg_host::recording::{self, Replay};
use std::path::PathBuf;

/// Runs the firmware's code again on a recording of `leg run --record F.mcap`, and says where it does something else.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The recording.
    file: PathBuf,
    /// Prints JSON instead of a sentence.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a recording that cannot be read, or duties that differ.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let replay = recording::replay(&args.file).map_err(|error| {
        Failure::refused(
            format!("{}: {error}", args.file.display()),
            "record anew with `leg run --record FILE.mcap`",
        )
    })?;
    print(&if args.json {
        to_line(&replay)?
    } else {
        words(&replay)
    })?;
    if replay.other == 0 {
        return Ok(());
    }
    let sentence = format!("{} of {} ticks differ", replay.other, replay.ticks);
    Err(Failure::missed(
        sentence,
        "the control law has changed since the recording",
    ))
}

fn words(replay: &Replay) -> String {
    let Some(first) = &replay.first else {
        return format!(
            "{} ticks, each with the bits that were recorded\n",
            replay.ticks
        );
    };
    format!(
        "First other duties in tick {} ({:.6} s): recorded {:?}, now {:?}\nDrivers on: recorded {}, now {}\n",
        first.tick,
        f64::from(first.tick) * tick_s(),
        first.recorded,
        first.now,
        first.enabled[0],
        first.enabled[1],
    )
}
