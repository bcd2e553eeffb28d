//! Opening the links that commands ask for, with everything that they need.

use indicatif::ProgressBar;
use leg_base::failure::Failure;
use leg_boards::image::{self, Board};
use leg_boards::qemu::{Clock, Config, Session};
use leg_boards::setup;
use leg_sim::link::{InProcess, Link};
use std::path::PathBuf;
use std::time::Duration;

/// What QEMU needs.
pub(super) struct Prerequisites {
    /// The emulator's program.
    pub(super) qemu: PathBuf,
    /// The firmware's ELF file.
    pub(super) image: PathBuf,
}

/// The firmware's code in this process.
pub(super) fn in_process() -> Result<Box<dyn Link>, Failure> {
    match InProcess::open() {
        Ok(link) => Ok(Box::new(link)),
        Err(error) => Err(Failure::from_error(&error)),
    }
}

/// The firmware on an emulated board. Installs and builds first what is missing.
pub(super) fn qemu(verbose: bool) -> Result<Box<dyn Link>, Failure> {
    qemu_with(Clock::Normal, verbose)
}

/// The firmware on an emulated board whose clock may be made for counting.
pub(super) fn qemu_with(clock: Clock, verbose: bool) -> Result<Box<dyn Link>, Failure> {
    let Prerequisites { qemu, image } = prepare()?;
    let config = Config {
        clock,
        verbose,
        ..Config::new(qemu, image)
    };
    match Session::open(&config) {
        Ok(session) => Ok(Box::new(session)),
        Err(error) => Err(Failure::from_error(&error)),
    }
}

/// Installs and builds what is missing, and says so on standard error.
pub(super) fn prepare() -> Result<Prerequisites, Failure> {
    prepare_target()?;
    let qemu = setup::ensure_qemu(&mut report).map_err(|error| Failure::from_error(&error))?;
    let image = build_image(Board::Qemu)?;
    Ok(Prerequisites { qemu, image })
}

/// Installs what compiles the firmware, and says so on standard error.
pub(super) fn prepare_target() -> Result<(), Failure> {
    setup::ensure_target(&mut report).map_err(|error| Failure::from_error(&error))
}

fn report(doing: &str) {
    eprintln!("leg: {doing}");
}

/// Builds a board's firmware, with a sign of life on a terminal: the first time takes half a minute.
pub(super) fn build_image(board: Board) -> Result<PathBuf, Failure> {
    let message = format!("building {}", board.binary());
    let spinner = ProgressBar::new_spinner().with_message(message);
    spinner.enable_steady_tick(Duration::from_millis(100));
    let built = image::build_for(board);
    spinner.finish_and_clear();
    built.map_err(|error| Failure::from_error(&error))
}
