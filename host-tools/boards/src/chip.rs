//! The board's own image on an emulated chip, coupled to the simulated leg pin by pin.
//!
//! What the sensors read is put on the chip's pins; what the motors get is read from them. Beside the chip the same
//! library runs in this process, with the same codes: the duties on the pins have to be its duties, bit for bit.

mod breaks;
mod expectations;
mod hot;
mod reports;
mod settings_page;
mod stack;
mod twin;
mod wiring;

use breaks::Breaks;
use leg_firmware::board::timing::TICK_BUDGET_CYCLES;
use leg_firmware::drive::Drive;
use leg_firmware::linked_leg::LINK_BYTES_MAX;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::{Reply, Request, TickReply, TickRequest};
use leg_sim::emulated_leg::HostBytes;
use leg_sim::link::{InProcess, Link, LinkError};
use reports::Reports;
use settings_page::Page;
use stack::StackGuard;
use std::collections::VecDeque;
use std::fs;
use std::path::Path;
use stm32g474_emulator::chip::{Chip, Stop};
use stm32g474_emulator::devices::Board;
use stm32g474_emulator::image::Image;
use twin::Twin;

/// The longest that a chip may take to its first tick, and from one to the next, cycles of 170 MHz: 200 ms and 10 ms.
const BOOT_CYCLES: u64 = 34_000_000;
const TICK_CYCLES_MAX: u64 = 1_700_000;

/// How long the processor is held in a tick that shall take too long: more than the budget, and it is done before the
/// next update.
const HELD_CYCLES: u64 = TICK_BUDGET_CYCLES as u64 + 1;

/// By then the control interrupt has read when it started.
const HANDLER_CYCLES: u64 = 100;
/// The latest that the control interrupt's handler may begin, cycles after its interrupt: the longest critical section
/// below it, with some room.
const LATENCY_CYCLES_MAX: u64 = 600;

/// The handler of the control interrupt, by the linker's name.
const HANDLER: &str = "ADC1_2";

/// The tick after which the image has to have set up everything, its watchdog too: 1.5 ms.
const SET_UP_TICKS: u64 = 12;

/// Ticks from one look at the memories to the next.
const MEMORY_TICKS: u64 = 64;

/// Updates of the pulse timer up to the end of the first tick.
const UPDATES_TO_FIRST_TICK: u32 = 3;

/// The functions of the image in which a command passes to the leg.
const COMMAND_FUNCTIONS: [&str; 3] = ["::command", "::note_decode_error", "::restart"];

/// Where the image keeps the codes of supply and temperature.
const SLOW_CODES: [&str; 2] = [
    "leg_stm32g474::slow_sensors::SUPPLY",
    "leg_stm32g474::slow_sensors::TEMPERATURE",
];

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

/// A chip that runs, and its twin.
struct Running {
    chip: Chip,
    twin: Twin,
    /// Bytes of the host that wait until the line is open.
    waiting: VecDeque<u8>,
    first: Option<Sensors>,
    taken: Option<TickRequest>,
    breaks: Breaks,
    stack: StackGuard,
    /// The first instruction of the control interrupt's handler, and the cycle by which it has to come.
    handler: u32,
    handler_due: Option<u64>,
    /// Whether the sensors were converted in this tick.
    converted: bool,
    /// Supply and temperature as the program has them.
    slow_codes: [u16; 2],
    ticks: u64,
    /// What the sensors read in this tick, with what the twin made of it once the chip has begun it.
    sensors: Sensors,
    ticked: Option<(Drive<f32>, Drive<f32>, Telemetry<f32>)>,
    /// A command is on its way: its function has begun, and has not come to the leg yet.
    commanding: bool,
    reports: Reports,
    /// The last byte that was sent to the chip: a zero ends a frame.
    sent: u8,
    settings: Page,
    defects: Defects,
}

/// Defects of the board, made the hardware's own way.
#[derive(Clone, Copy, Debug, Default)]
struct Defects {
    /// A bit of the settings was wrong when the chip started.
    settings_corrupt: bool,
    /// The last trigger did not reach ADC2.
    untriggered: bool,
    /// The processor was held in the last tick.
    held: bool,
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
            Err(error) => {
                return Ok(Reply::Refused(
                    leg_firmware_bench::protocol::Refusal::Settings(error),
                ));
            }
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
        self.running = Some(Running {
            stack: StackGuard::new(&self.image, chip.processor()),
            breaks: Breaks::default(),
            handler,
            handler_due: None,
            converted: false,
            chip,
            twin,
            waiting: VecDeque::new(),
            first: None,
            taken: None,
            slow_codes: [0; 2],
            ticks: 0,
            sensors: Sensors::default(),
            ticked: None,
            commanding: false,
            reports: Reports::new(),
            sent: 0,
            settings: page,
            defects: Defects::default(),
        });
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

impl Running {
    fn tick(&mut self, request: &TickRequest, image: &Image) -> Result<TickReply, LinkError> {
        // The encoders of a chip count from its start.
        let first = *self.first.get_or_insert(request.sensors);
        let sensors = wiring::since(&first, &request.sensors);
        self.corrupt_settings(sensors.settings_corrupt)?;
        wiring::apply(&mut self.chip.peripherals(), &sensors);
        self.check_breaks(&sensors, image)?;
        self.send(&request.link);
        self.ask_for_report()?;
        // The converters of this tick have been triggered already: a trigger that does not come is missed in the next.
        let untriggered = sensors.cell_fresh.contains(&false);
        let mut peripherals = self.chip.peripherals();
        let converters = &mut peripherals.devices.converters;
        converters.set_trigger_reaches("ADC2", !untriggered);
        drop(peripherals);
        if self.ticks == 0 {
            self.defects.untriggered = untriggered;
        }
        self.sensors = sensors;
        self.converted = false;
        self.run_tick(image)?;
        self.ticks += 1;
        self.check_tick(image)?;
        self.defects.untriggered = untriggered;
        self.defects.held = sensors.late;
        let Some((drive, expected, telemetry)) = self.ticked.take() else {
            return Err(self.stuck("starts no tick", image));
        };
        let motors = wiring::motors(&self.chip.peripherals());
        if motors != expected {
            return Err(LinkError::Chip(format!(
                "at tick {} the chip's pins carry {motors:?}, and the control law in process gives {expected:?}{}",
                self.ticks,
                self.described_findings(image)
            )));
        }
        self.report_findings(image)?;
        Ok(TickReply {
            drive,
            motors,
            telemetry,
            instructions: None,
            link: self.received()?,
        })
    }

    /// Lets a bit of the settings be wrong before the chip starts, which then uses those that are built in.
    ///
    /// # Errors
    /// [`LinkError::Chip`] once it has started: it reads its settings then.
    fn corrupt_settings(&mut self, corrupt: bool) -> Result<(), LinkError> {
        let refused = |sentence: &str| Err(LinkError::Chip(sentence.into()));
        if corrupt == self.defects.settings_corrupt {
            return Ok(());
        }
        if self.ticks > 0 {
            return refused(
                "a board reads its settings when it starts: they cannot be corrupt later",
            );
        }
        self.settings.corrupt();
        self.chip
            .load_flash(self.settings.address, &self.settings.bytes);
        let built_in = Settings::for_table_1().map(|settings| Twin::new(&settings));
        let Some(Ok(twin)) = built_in else {
            return refused("the built-in settings are refused");
        };
        self.twin = twin;
        self.defects.settings_corrupt = true;
        Ok(())
    }

    /// Asks the chip now and then what it knows of itself, between two frames of the host.
    fn ask_for_report(&mut self) -> Result<(), LinkError> {
        if !Reports::due(self.ticks) || self.sent != 0 || !self.waiting.is_empty() {
            return Ok(());
        }
        for byte in Reports::question()? {
            wiring::send(&mut self.chip.peripherals(), byte);
        }
        Ok(())
    }

    /// Runs to the end of a tick. Before the first one there are updates: one by which the program sets up the timer, and
    /// the one that starts the converters for the first time.
    fn run_tick(&mut self, image: &Image) -> Result<(), LinkError> {
        if self.ticks > 0 {
            return self.run(TICK_CYCLES_MAX, image);
        }
        for _ in 0..UPDATES_TO_FIRST_TICK {
            self.run(BOOT_CYCLES, image)?;
            if self.ticked.is_some() {
                break;
            }
        }
        Ok(())
    }

    /// Runs to the next update of the pulse timer, and lets the twin do what the chip does when the chip does it.
    fn run(&mut self, cycles_max: u64, image: &Image) -> Result<(), LinkError> {
        let end = self.chip.cycle() + cycles_max;
        loop {
            let watching = self.handler_due.is_some() || !self.twin.pending.is_empty();
            self.chip.set_watching(watching);
            let limit = self.handler_due.unwrap_or(end);
            let stop = if self.commanding {
                self.chip.run(self.chip.cycle() + 1)
            } else {
                self.chip.run(limit)
            };
            match stop {
                Stop::Update => return Ok(()),
                Stop::Watched if self.chip.processor().pc() == self.handler => {
                    self.handler_due = None;
                    self.begin_tick(image)?;
                }
                Stop::Watched => self.commanding = true,
                Stop::Converted => self.converted(image)?,
                Stop::Time if self.chip.cycle() < limit => {}
                Stop::Time if self.handler_due.is_some() => {
                    let how = format!(
                        "does not begin the control interrupt's handler within {LATENCY_CYCLES_MAX} cycles"
                    );
                    return Err(self.stuck(&how, image));
                }
                Stop::Time => return Err(self.stuck("starts no tick", image)),
                Stop::LockedUp => return Err(self.stuck("is locked up", image)),
                Stop::Reset(cause) => {
                    return Err(self.stuck(&format!("was reset ({cause:?})"), image));
                }
            }
            take_command(&self.chip, &mut self.twin, &mut self.commanding);
        }
    }

    /// The sensors have been converted: a tick begins.
    fn converted(&mut self, image: &Image) -> Result<(), LinkError> {
        self.converted = true;
        self.handler_due = Some(self.chip.cycle() + LATENCY_CYCLES_MAX);
        let wrong = wiring::wrong_code(&mut self.chip.peripherals(), self.defects.untriggered);
        self.require(wrong.or_else(|| self.breaks.converted(&self.chip)), image)
    }

    /// The handler of the control interrupt is at its first instruction: the twin has the same tick.
    fn begin_tick(&mut self, image: &Image) -> Result<(), LinkError> {
        self.read_slow_codes(image)?;
        let [supply_code, temperature_code] = self.slow_codes;
        let sensors = Sensors {
            supply_code,
            temperature_code,
            current_codes: wiring::current_codes(&self.chip.peripherals()),
            cell_fresh: [!self.defects.untriggered; 3],
            // That a tick took too long is told in the next one.
            late: self.defects.held,
            settings_corrupt: self.defects.settings_corrupt,
            ..self.sensors
        };
        let ticked = self.twin.tick(&sensors);
        self.reports.learn(ticked.2);
        self.ticked = Some(ticked);
        let fitting = self.twin.received.len().min(LINK_BYTES_MAX);
        self.taken = Some(TickRequest {
            sensors,
            link: self.twin.received.drain(..fitting).collect(),
        });
        if self.sensors.late {
            self.hold(image)?;
        }
        Ok(())
    }

    /// Holds the processor within the control interrupt, which nothing interrupts.
    fn hold(&mut self, image: &Image) -> Result<(), LinkError> {
        self.chip.set_watching(false);
        let begun = self.chip.run(self.chip.cycle() + HANDLER_CYCLES);
        let held = self.chip.hold_processor(HELD_CYCLES);
        if (begun, held) == (Stop::Time, None) {
            return Ok(());
        }
        Err(self.stuck("is interrupted in the control interrupt", image))
    }

    /// What the breaks have to do at the beginning of a tick.
    fn check_breaks(&mut self, sensors: &Sensors, image: &Image) -> Result<(), LinkError> {
        let (twin, commanding) = (&mut self.twin, &mut self.commanding);
        let handler = self.handler;
        let mut pass = |chip: &mut Chip, cycles| {
            let end = chip.cycle() + cycles;
            chip.set_watching(!twin.pending.is_empty());
            while chip.cycle() < end {
                let step = if *commanding { chip.cycle() + 1 } else { end };
                let stop = chip.run(step);
                *commanding |= stop == Stop::Watched && chip.processor().pc() != handler;
                take_command(chip, twin, commanding);
            }
        };
        let wrong = self.breaks.begin(&mut self.chip, sensors, &mut pass);
        self.require(wrong, image)
    }

    /// What has to hold after every tick.
    fn check_tick(&mut self, image: &Image) -> Result<(), LinkError> {
        let idle = (!self.converted).then(|| {
            "ADC1 and ADC2 have ended no sequence from one update of TIM1 to the next".to_owned()
        });
        let unmet = || {
            let due = self.ticks == SET_UP_TICKS;
            due.then(|| expectations::unmet(&self.chip)).flatten()
        };
        let looked_at = self.ticks % MEMORY_TICKS == 1;
        let memory = || looked_at.then(|| self.wrong_memory(image)).flatten();
        self.require(idle.or_else(unmet).or_else(memory), image)
    }

    /// What is wrong in RAM or CCM, as a sentence.
    fn wrong_memory(&self, image: &Image) -> Option<String> {
        let processor = self.chip.processor();
        if self.stack.is_reached(processor) {
            return Some("the stack has come down to the variables".into());
        }
        // The code of the CCM is compared once: the program cannot change it by chance and go on.
        let copied = self.ticks > 1 || !hot::differs(image, processor);
        (!copied).then(|| "the code of the CCM is not there: it was not copied".into())
    }

    /// # Errors
    /// [`LinkError::Chip`] with what is wrong, if anything is, and with what the chip found.
    fn require(&self, wrong: Option<String>, image: &Image) -> Result<(), LinkError> {
        match wrong {
            None => Ok(()),
            Some(wrong) => Err(LinkError::Chip(format!(
                "at tick {}: {wrong}{}",
                self.ticks,
                self.described_findings(image)
            ))),
        }
    }

    /// Reads the codes of supply and temperature that the tick uses: the program converts them every 10 ms, and keeps
    /// them. They have to be those of the pins.
    fn read_slow_codes(&mut self, image: &Image) -> Result<(), LinkError> {
        let converted = wiring::slow_codes(&self.chip.peripherals());
        let codes = self.slow_codes.iter_mut().zip(converted);
        for (name, (kept, converted)) in SLOW_CODES.into_iter().zip(codes) {
            let address = image.variable(name);
            let word = address.and_then(|address| {
                let word = self.chip.processor().word(address & !3)?;
                Some((word >> (8 * (address & 2))) as u16)
            });
            let Some(code) = word else {
                return Err(LinkError::Chip(format!(
                    "the image has no variable `{name}`"
                )));
            };
            if code != *kept && Some(code) != converted {
                return Err(LinkError::Chip(format!(
                    "`{name}` is {code}, and its pin was {converted:?} when it was converted"
                )));
            }
            *kept = code;
        }
        Ok(())
    }

    fn stuck(&self, how: &str, image: &Image) -> LinkError {
        let place = self.chip.processor().place();
        let function = image.function_at(place.pc).unwrap_or("no function");
        let memory = self.wrong_memory(image);
        let mut memory = memory.map(|wrong| format!("; {wrong}")).unwrap_or_default();
        let (refused, address) = self.chip.processor().refused();
        if refused > 0 {
            memory += &format!("; nothing answers at {address:#010x}, which it accessed");
        }
        LinkError::Chip(format!(
            "the emulated chip {how}: it is at {:#010x} in {function}, exception {}{memory}{}",
            place.pc,
            place.exception,
            self.described_findings(image)
        ))
    }

    /// # Errors
    /// [`LinkError::Chip`] if the image did something wrong up to now.
    fn report_findings(&self, image: &Image) -> Result<(), LinkError> {
        let findings = self.described_findings(image);
        if findings.is_empty() {
            return Ok(());
        }
        Err(LinkError::Chip(format!(
            "the image does what the chip forbids, up to tick {}:{findings}",
            self.ticks
        )))
    }

    fn described_findings(&self, image: &Image) -> String {
        let peripherals = self.chip.peripherals();
        let list = peripherals.findings.list().iter();
        list.map(|finding| {
            let function = image.function_at(finding.pc).unwrap_or("no function");
            format!("\n  {finding}, in {function}")
        })
        .collect()
    }

    /// Sends the host's bytes once the chip listens: until then a host that is not answered asks again.
    fn send(&mut self, bytes: &[u8]) {
        self.waiting.extend(bytes);
        if !wiring::listens(&self.chip.peripherals()) {
            return;
        }
        for byte in self.waiting.drain(..) {
            wiring::send(&mut self.chip.peripherals(), byte);
            self.twin.pending.push_back(byte);
            self.sent = byte;
        }
    }

    fn received(&mut self) -> Result<HostBytes, LinkError> {
        let mut peripherals = self.chip.peripherals();
        let mut bytes = HostBytes::new();
        while !bytes.is_full()
            && let Some(sent) = peripherals.devices.lpuart.host_receive()
        {
            // There is room: it was just checked.
            let _ = bytes.push(sent.byte);
            self.reports.take(sent.byte).map_err(LinkError::Chip)?;
        }
        Ok(bytes)
    }
}

/// Lets the twin take a command where the chip's leg does: in the first critical section of the function that brings it.
/// The control interrupt may come before that, and then belongs before the command.
fn take_command(chip: &Chip, twin: &mut Twin, commanding: &mut bool) {
    if *commanding && chip.processor().in_critical_section() {
        *commanding = false;
        twin.take_command();
    }
}
