//! `leg flash`.

use crate::board;
use crate::options::Options;
use crate::output::{note, print};
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_boards::image::FirmwareImage;
use leg_host::cancel_flag::CancelFlag;
use leg_host::flash::Probe;
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

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let probe = Probe::find(args.probe.clone())?;
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
    probe.check_chip()?;
    probe.download(&image)?;
    if !options.json {
        print("flashed, read back and found the same\n")?;
    }
    probe.reset()?;
    // What was done; the log follows as text.
    let json = json_object! { image: &image, verified: true, started: true };
    options.report(&json, || "started\n".into())?;
    if args.no_log {
        return Ok(());
    }
    let cancel = CancelFlag::set_by_ctrl_c();
    note("leg: the firmware's log follows; Ctrl-C ends it");
    probe.attach(&image, &cancel)
}
