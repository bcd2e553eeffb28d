//! `leg flash`.

use crate::board;
use crate::options::Options;
use crate::output::print;
use leg_base::failure::Failure;
use leg_boards::image::FirmwareImage;
use leg_host::cancel_flag::CancelFlag;
use leg_host::flash::{FlashError, Probe};
use serde::Serialize;
use std::path::PathBuf;

/// Builds the firmware, writes it into the board over its debugger, reads it back, starts it and shows its log.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// An existing image in the place of a new build.
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
    /// One of several debuggers, as VID:PID:Serial; `probe-rs list` shows them.
    #[arg(long, value_name = "SELECTOR")]
    probe: Option<String>,
    /// Ends when the firmware has started, without showing its log.
    #[arg(long)]
    no_log: bool,
}

/// What was done; the log follows as text.
#[derive(Serialize)]
struct FlashReport {
    image: PathBuf,
    verified: bool,
    started: bool,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let probe = Probe::find(args.probe.clone()).map_err(failure)?;
    let image = match &args.image {
        Some(image) if image.is_file() => image.clone(),
        Some(image) => {
            let sentence = format!("there is no image {}", image.display());
            return Err(Failure::refused(sentence, "leave --image out to build it"));
        }
        None => {
            board::prepare_target()?;
            board::build_image(FirmwareImage::Stm32g474)?
        }
    };
    probe.check_chip().map_err(failure)?;
    probe.download(&image).map_err(failure)?;
    if !options.json {
        print("flashed, read back and found the same\n")?;
    }
    probe.reset().map_err(failure)?;
    let report = FlashReport {
        image,
        verified: true,
        started: true,
    };
    options.report(&report, |_| "started\n".into())?;
    if args.no_log {
        return Ok(());
    }
    let cancel = CancelFlag::on_ctrl_c();
    eprintln!("leg: the firmware's log follows; Ctrl-C ends it");
    probe.attach(&report.image, &cancel).map_err(failure)
}

fn failure(error: FlashError) -> Failure {
    let (sentence, remedy) = (error.to_string(), error.remedy());
    if matches!(error, FlashError::NotVerified) {
        Failure::failed(sentence, remedy)
    } else {
        Failure::refused(sentence, remedy)
    }
}
