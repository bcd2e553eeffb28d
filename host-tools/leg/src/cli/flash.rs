//! `leg flash`.

use super::{board, print};
use leg_base::failure::Failure;
use leg_boards::image::Board;
use leg_host::flash::{FlashError, Probe};
use leg_host::operator::Interrupt;
use std::path::PathBuf;

/// Builds the firmware, writes it into the board over its debugger, reads it back, starts it and shows its log.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// An image that is there, instead of building one.
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
    /// One of several debuggers, as VID:PID:Serial; `probe-rs list` shows them.
    #[arg(long, value_name = "SELECTOR")]
    probe: Option<String>,
    /// Ends when the firmware has started, instead of showing its log until Ctrl-C.
    #[arg(long)]
    no_log: bool,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no probe-rs, no debugger, another chip or one with other option bytes, or flash that does not hold what was written.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let probe = Probe::find(args.probe.clone()).map_err(failure)?;
    let image = match &args.image {
        Some(image) if image.is_file() => image.clone(),
        Some(image) => {
            let sentence = format!("there is no image {}", image.display());
            return Err(Failure::refused(sentence, "leave --image out to build it"));
        }
        None => {
            board::prepare_target()?;
            board::build_image(Board::Stm32g474)?
        }
    };
    probe.check_chip().map_err(failure)?;
    probe.download(&image).map_err(failure)?;
    print("flashed, read back and found the same\n")?;
    probe.reset().map_err(failure)?;
    print("started\n")?;
    if args.no_log {
        return Ok(());
    }
    let interrupt = Interrupt::on_ctrl_c();
    eprintln!("leg: the firmware's log follows; Ctrl-C ends it");
    probe.attach(&image, &interrupt).map_err(failure)
}

fn failure(error: FlashError) -> Failure {
    let (sentence, remedy) = (error.to_string(), error.remedy());
    if matches!(error, FlashError::NotVerified) {
        Failure::missed(sentence, remedy)
    } else {
        Failure::refused(sentence, remedy)
    }
}
