//! Links to the firmware without a board, and what they need: the Rust target, QEMU, images.

use crate::options::Options;
use crate::output::note;
use clap::ValueEnum;
use indicatif::ProgressBar;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_boards::chip::ChipSession;
use leg_boards::image::{FirmwareImage, ImageError, workspace_root};
use leg_boards::qemu::{QemuClock, QemuConfig, QemuSession};
use leg_boards::setup;
use leg_host::cancel_flag::CancelFlag;
use leg_sim::link::{InProcess, Link};
use std::path::PathBuf;
use std::time::Duration;

/// Where the firmware runs without a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Emulation {
    /// On an emulated Cortex-M4F, under QEMU.
    Qemu,
    /// In this process.
    Sim,
    /// The board's own image, on an emulated STM32G474.
    Chip,
}

impl Emulation {
    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::Qemu => "under QEMU",
            Self::Sim => "in this process",
            Self::Chip => "on an emulated STM32G474",
        }
    }

    /// The firmware, to be coupled to a simulated leg.
    pub(crate) fn link(self, options: Options) -> Result<Box<dyn Link>, Failure> {
        match self {
            Self::Sim => Ok(Box::new(InProcess::new())),
            Self::Qemu => qemu(QemuClock::Normal, options),
            Self::Chip => Ok(Box::new(chip()?)),
        }
    }
}

/// `leg setup`: what QEMU needs.
pub(crate) fn setup(options: Options) -> Result<(), Failure> {
    let [emulator, firmware] = &prepare()?;
    let json = json_object! { emulator: emulator, firmware: firmware };
    options.report(&json, || {
        let [emulator, firmware] = [emulator, firmware].map(|path| path.display());
        format!("emulator: {emulator}\nfirmware: {firmware}\nAll is set up.\n")
    })
}

/// The firmware under QEMU, whose clock may be made for counting. Installs and builds first what is missing.
pub(crate) fn qemu(clock: QemuClock, options: Options) -> Result<Box<dyn Link>, Failure> {
    let [emulator, firmware] = prepare()?;
    let config = QemuConfig {
        clock,
        verbose: options.verbose,
        ..QemuConfig::new(emulator, firmware)
    };
    Ok(Box::new(
        QemuSession::open(&config).map_err(Failure::from_error)?,
    ))
}

/// The board's image on an emulated chip. Installs and builds first what is missing.
fn chip() -> Result<ChipSession, Failure> {
    prepare_target()?;
    let image = build_image(FirmwareImage::Stm32g474)?;
    ChipSession::open(&image).map_err(Failure::from_error)
}

/// The same on a chip whose flash keeps no settings.
pub(crate) fn new_chip() -> Result<Box<dyn Link>, Failure> {
    Ok(Box::new(chip()?.with_flash(&[])))
}

/// Installs and builds what is missing, and says so on standard error: the emulator and the firmware's ELF file.
fn prepare() -> Result<[PathBuf; 2], Failure> {
    prepare_target()?;
    let emulator = setup::ensure_qemu(&mut report).map_err(Failure::from_error)?;
    Ok([emulator, build_image(FirmwareImage::Qemu)?])
}

/// Installs what compiles the firmware, and says so on standard error.
pub(crate) fn prepare_target() -> Result<(), Failure> {
    setup::ensure_target(&mut report).map_err(Failure::from_error)
}

pub(crate) fn report(doing: &str) {
    note(&format!("leg: {doing}"));
}

/// Builds a board's firmware, with a spinner on a terminal: the first time takes half a minute.
pub(crate) fn build_image(image: FirmwareImage) -> Result<PathBuf, Failure> {
    let message = format!("building {}", image.binary());
    let spinner = ProgressBar::new_spinner().with_message(message);
    spinner.enable_steady_tick(Duration::from_millis(100));
    let built = image.build_in(&workspace_root(), &CancelFlag::ctrl_c_pressed);
    spinner.finish_and_clear();
    built.map_err(|error| match error {
        ImageError::Cancelled => Failure::failed(
            "ended by Ctrl-C or a signal while the firmware was being built",
            "nothing was begun: command again",
        ),
        error => Failure::from_error(error),
    })
}
