//! The board's own image on an emulated chip, coupled to the simulated leg pin by pin.
//!
//! What the sensors read is put on the chip's pins; what the motors get is read from them. Beside the chip the same
//! library runs in this process, with the same codes: the duties on the pins have to be its duties, bit for bit.

mod breaks;
mod expectations;
mod hot;
mod log;
mod reports;
mod running;
mod settings_page;
mod stack;
mod twin;
mod wiring;

use defmt_decoder::Table;
use leg_firmware::settings::Settings;
use leg_firmware_bench::protocol::{Refusal, Reply, Request, TickRequest};
use leg_sim::link::{InProcess, Link, LinkError};
pub use running::LATENCY_CYCLES_MAX;
use running::Running;
pub use settings_page::{PLACE as SETTINGS_PLACE, Page as SettingsPage, page as settings_page};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::image::Image;
use twin::Twin;

/// The handler of the control interrupt, by the linker's name.
const HANDLER: &str = "ADC1_2";

/// The functions of the image in which a command passes to the leg.
const COMMAND_FUNCTIONS: [&str; 3] = ["::command", "::note_decode_error", "::restart"];

/// What the names of those functions begin with.
const COMMANDED: &str =
    "<leg_stm32g474::control::SharedLeg as leg_firmware::host_link::CommandedLeg>";

/// An image on a chip that has been switched on, as something that answers a simulation's requests.
pub struct ChipSession {
    image: Image,
    /// Its log messages; none for an image without.
    log: Option<Arc<Table>>,
    board: Board,
    /// What the flash holds where settings are kept; none for the settings that a leg starts with.
    kept: Option<Vec<u8>>,
    /// What is no leg's business is answered here.
    bench: InProcess,
    running: Option<Running>,
}

impl ChipSession {
    /// A session with an image, by its ELF file. The chip is switched on when a leg starts.
    ///
    /// # Errors
    /// [`LinkError`] for a file that is not there, or is no image of the chip.
    pub fn open(image: &Path) -> Result<Self, LinkError> {
        let elf = fs::read(image).map_err(LinkError::system("read the image"))?;
        let refused = |error| LinkError::Chip(format!("{}: {error}", image.display()));
        Ok(Self {
            image: Image::parse(&elf).map_err(refused)?,
            log: Table::parse(&elf).ok().flatten().map(Arc::new),
            board: Board::default(),
            kept: None,
            bench: InProcess::new(),
            running: None,
        })
    }

    /// The same on another board.
    #[must_use]
    pub fn with_board(self, board: Board) -> Self {
        Self { board, ..self }
    }

    /// The same with what the flash holds where settings are kept, in the place of the settings that a leg starts with; no
    /// bytes for a new board.
    #[must_use]
    pub fn with_flash(self, bytes: &[u8]) -> Self {
        let kept = Some(bytes.to_vec());
        Self { kept, ..self }
    }

    /// The same session once more, its chip as it is now: what is asked of one does not happen to the other.
    ///
    /// # Errors
    /// [`LinkError::Chip`] for a fault of the emulator.
    pub fn copy(&self) -> Result<Self, LinkError> {
        let running = self.running.as_ref();
        let copied = running.map(|running| running.copy(&self.image)).transpose();
        Ok(Self {
            image: self.image.clone(),
            log: self.log.clone(),
            board: self.board,
            kept: self.kept.clone(),
            bench: InProcess::new(),
            running: copied.map_err(|error| LinkError::Chip(error.to_string()))?,
        })
    }

    /// What the image has logged since the last call, as a debugger reads it.
    pub fn log_lines(&mut self) -> Vec<String> {
        match (&mut self.running, &self.log) {
            (Some(running), Some(table)) => log::lines(&self.image, table, &mut running.chip),
            _ => Vec::new(),
        }
    }

    /// The chip, once a leg has started.
    pub fn chip(&mut self) -> Option<&mut Chip> {
        self.running.as_mut().map(|running| &mut running.chip)
    }

    /// The longest from the control interrupt to the first instruction of its handler up to now, cycles.
    #[must_use]
    pub fn latency_max(&self) -> u64 {
        self.running
            .as_ref()
            .map_or(0, |running| running.latency_max)
    }

    fn start(&mut self, settings: &Settings) -> Result<Reply, LinkError> {
        let refused = |error| LinkError::Chip(error);
        let (settings, page, corrupt) = self.flash(settings)?;
        let twin = match Twin::new(&settings) {
            Ok(twin) => twin,
            Err(error) => return Ok(Reply::Refused(Refusal::Settings(error))),
        };
        let mut chip =
            Chip::new(&self.image, &self.board).map_err(|error| refused(error.to_string()))?;
        chip.load_flash(page.address, &page.bytes);
        let watched = COMMAND_FUNCTIONS.iter().flat_map(|function| {
            self.image
                .functions_ending(&format!("{COMMANDED}{function}"))
        });
        let handler = self.image.symbol(HANDLER).unwrap_or_default() & !1;
        chip.watch(watched.chain([handler]).collect());
        let running = Running::new(&self.image, chip, twin, (page, corrupt), handler);
        self.running = Some(running);
        Ok(Reply::Started)
    }

    /// The settings that the board will use, what its flash holds, and whether they are others than those.
    fn flash(&self, asked: &Settings) -> Result<(Settings, SettingsPage, bool), LinkError> {
        let refused = |sentence: &str| LinkError::Chip(sentence.into());
        let Some(bytes) = &self.kept else {
            let settings = asked.unhomed();
            let page = settings_page(&settings)
                .ok_or_else(|| refused("the settings do not fit into their page"))?;
            return Ok((settings, page, false));
        };
        let address = settings_page::PLACE.start;
        let bytes = bytes.clone();
        let page = SettingsPage { address, bytes };
        if let Some(settings) = settings_page::kept(&page.bytes) {
            return Ok((settings.unhomed(), page, false));
        }
        let built_in = Settings::table_1();
        let built_in = built_in.ok_or_else(|| refused("the built-in settings are refused"))?;
        Ok((built_in, page, true))
    }
}

impl Link for ChipSession {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        match request {
            Request::Start(settings) => self.start(settings),
            Request::Tick(tick) => match &mut self.running {
                Some(running) => running.tick(tick, &self.image).map(Reply::Ticked),
                None => self.bench.ask(request),
            },
            _ => self.bench.ask(request),
        }
    }

    fn taken(&mut self) -> Option<TickRequest> {
        self.running.as_ref()?.taken.clone()
    }
}
