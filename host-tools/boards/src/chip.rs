//! The board's own image on an emulated chip, coupled to the simulated leg pin by pin.
//!
//! What the sensors read is put on the chip's pins; what the motors get is read from them. Beside the chip the same
//! library runs in this process, with the same codes: the duties on the pins have to be its duties, bit for bit.

mod breaks;
mod expectations;
mod hot;
mod reports;
mod running;
mod settings_page;
mod stack;
mod twin;
mod wiring;

use leg_firmware::settings::Settings;
use leg_firmware_bench::protocol::{Refusal, Reply, Request, TickRequest};
use leg_sim::link::{InProcess, Link, LinkError};
use running::Running;
use std::fs;
use std::path::Path;
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
    board: Board,
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
            board: Board::default(),
            bench: InProcess::new(),
            running: None,
        })
    }

    /// The same on another board.
    #[must_use]
    pub fn on_board(self, board: Board) -> Self {
        Self { board, ..self }
    }

    /// The chip, once a leg has started.
    pub fn chip(&mut self) -> Option<&mut Chip> {
        self.running.as_mut().map(|running| &mut running.chip)
    }

    fn start(&mut self, settings: &Settings) -> Result<Reply, LinkError> {
        let refused = |error| LinkError::Chip(error);
        let settings = settings.without_zero();
        let twin = match Twin::new(&settings) {
            Ok(twin) => twin,
            Err(error) => return Ok(Reply::Refused(Refusal::Settings(error))),
        };
        let mut chip =
            Chip::new(&self.image, &self.board).map_err(|error| refused(error.to_string()))?;
        let page = settings_page::page(&settings)
            .ok_or_else(|| refused("the settings do not fit into their page".into()))?;
        chip.load_flash(page.address, &page.bytes);
        let watched = COMMAND_FUNCTIONS.iter().flat_map(|function| {
            self.image
                .functions_ending(&format!("{COMMANDED}{function}"))
        });
        let handler = self.image.symbol(HANDLER).unwrap_or_default() & !1;
        chip.watch(watched.chain([handler]).collect());
        self.running = Some(Running::new(&self.image, chip, twin, page, handler));
        Ok(Reply::Started)
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
