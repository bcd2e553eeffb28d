//! A chip that runs, tick by tick, with its twin beside it.

mod checks;

use super::breaks::Breaks;
use super::reports::Reports;
use super::settings_page::Page;
use super::stack::StackGuard;
use super::twin::Twin;
use super::wiring;
use checks::described;
use leg_firmware::board::timing::TICK_BUDGET_CYCLES;
use leg_firmware::drive::Drive;
use leg_firmware::linked_leg::LINK_BYTES_MAX;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::{TickReply, TickRequest};
use leg_sim::emulated_leg::HostBytes;
use leg_sim::link::LinkError;
use std::collections::VecDeque;
use stm32g474_emulator::chip::{Chip, Stop};
use stm32g474_emulator::image::Image;
use stm32g474_emulator::processor::MapError;

/// The longest that a chip may take to its first tick, and from one to the next, cycles of 170 MHz: 200 ms and 10 ms.
const BOOT_CYCLES: u64 = 34_000_000;
const TICK_CYCLES_MAX: u64 = 1_700_000;

/// How long the processor is held in a tick that shall take too long: more than the budget, and it is done before the
/// next update.
const HELD_CYCLES: u64 = TICK_BUDGET_CYCLES as u64 + 1;

/// By then the control interrupt has read when it started.
const HANDLER_CYCLES: u64 = 100;

/// The latest that the control interrupt's handler may begin, cycles after its interrupt: 2.5 µs. The tests `chip_latency` and
/// `chip_scenarios` measure the longest critical section below it: of a leg at rest, and of one that is driven.
pub const LATENCY_CYCLES_MAX: u64 = 423;

/// Updates of the pulse timer up to the end of the first tick.
const UPDATES_TO_FIRST_TICK: u32 = 3;

/// A chip that runs, and its twin.
pub struct Running {
    pub chip: Chip,
    twin: Twin,
    /// Bytes of the host that wait until the line is open.
    waiting: VecDeque<u8>,
    first: Option<Sensors>,
    /// What the leg took in the last tick.
    pub taken: Option<TickRequest>,
    breaks: Breaks,
    stack: StackGuard,
    /// The first instruction of the control interrupt's handler, and the cycle by which it has to come.
    handler: u32,
    handler_due: Option<u64>,
    /// The longest from the interrupt to that instruction, cycles.
    pub latency_max: u64,
    /// Whether the sensors were converted in this tick.
    converted: bool,
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
    /// It was asked for a wrong bit in the settings.
    corrupted: bool,
    /// The chip found no whole settings when it started, and has kept none since.
    settings_corrupt: bool,
    /// The last trigger did not reach ADC2.
    untriggered: bool,
    /// The processor was held in the last tick.
    held: bool,
}

impl Running {
    /// A chip that has just been switched on.
    ///
    /// `settings` are what its flash holds where they are kept, and whether it has to use others.
    pub fn new(
        image: &Image,
        chip: Chip,
        twin: Twin,
        settings: (Page, bool),
        handler: u32,
    ) -> Self {
        let (settings, settings_corrupt) = settings;
        Self {
            stack: StackGuard::new(image, chip.processor()),
            breaks: Breaks::default(),
            handler,
            handler_due: None,
            latency_max: 0,
            converted: false,
            chip,
            twin,
            waiting: VecDeque::new(),
            first: None,
            taken: None,
            ticks: 0,
            sensors: Sensors::default(),
            ticked: None,
            commanding: false,
            reports: Reports::new(),
            sent: 0,
            settings,
            defects: Defects {
                settings_corrupt,
                ..Defects::default()
            },
        }
    }

    /// The same chip and the same twin once more.
    ///
    /// # Errors
    /// [`MapError`]: a fault of the emulator.
    pub fn copy(&self, image: &Image) -> Result<Self, MapError> {
        Ok(Self {
            chip: self.chip.copy(image)?,
            twin: self.twin.clone(),
            waiting: self.waiting.clone(),
            taken: self.taken.clone(),
            breaks: self.breaks.clone(),
            stack: self.stack.clone(),
            reports: self.reports.clone(),
            settings: self.settings.clone(),
            ..*self
        })
    }

    /// One tick of the chip, and of its twin.
    ///
    /// # Errors
    /// [`LinkError::Chip`] for whatever the image, the chip or the coupling does wrong.
    pub fn tick(&mut self, request: &TickRequest, image: &Image) -> Result<TickReply, LinkError> {
        // The encoders of a chip count from its start.
        let first = *self.first.get_or_insert(request.sensors);
        let sensors = wiring::count_from(&first, &request.sensors);
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
        let motors = match motors {
            Ok(motors) => motors,
            Err(wrong) => return Err(self.violation(&wrong, image)),
        };
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
            recorder_instructions: None,
            link: self.received()?,
        })
    }

    /// Lets a bit of the settings be wrong before the chip starts, which then uses those that are built in.
    ///
    /// # Errors
    /// [`LinkError::Chip`] once it has started: it reads its settings then.
    fn corrupt_settings(&mut self, corrupt: bool) -> Result<(), LinkError> {
        let refused = |sentence: &str| Err(LinkError::Chip(sentence.into()));
        if corrupt == self.defects.corrupted {
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
        let built_in = Settings::table_1().map(|settings| Twin::new(&settings));
        let Some(Ok(twin)) = built_in else {
            return refused("the built-in settings are refused");
        };
        self.twin = twin;
        self.defects.corrupted = true;
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
                    if let Some(due) = self.handler_due.take() {
                        let latency = self.chip.cycle() + LATENCY_CYCLES_MAX - due;
                        self.latency_max = self.latency_max.max(latency);
                    }
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
                Stop::Time | Stop::LockedUp | Stop::Reset(_) => {
                    return Err(self.stuck(&described(stop), image));
                }
            }
            take_command(&self.chip, &mut self.twin, &mut self.commanding);
        }
    }

    /// The sensors have been converted: a tick begins.
    fn converted(&mut self, image: &Image) -> Result<(), LinkError> {
        self.converted = true;
        self.handler_due = Some(self.chip.cycle() + LATENCY_CYCLES_MAX);
        let wrong = wiring::wrong_code(&self.chip.peripherals(), self.defects.untriggered);
        self.require(wrong.or_else(|| self.breaks.converted(&self.chip)), image)
    }

    /// The handler of the control interrupt is at its first instruction: the twin has the same tick.
    fn begin_tick(&mut self, image: &Image) -> Result<(), LinkError> {
        self.read_corrupt(image)?;
        let [supply_code, temperature_code] = wiring::slow_codes(&self.chip.peripherals());
        let sensors = Sensors {
            supply_code,
            temperature_code,
            current_codes: wiring::current_codes(&self.chip.peripherals()),
            cell_fresh: [!self.defects.untriggered; 3],
            // That a tick took too long is reported in the next one.
            late: self.defects.held,
            settings_corrupt: self.defects.settings_corrupt,
            ..self.sensors
        };
        let ticked = self.twin.tick(&sensors);
        self.reports.learn(ticked.2);
        self.ticked = Some(ticked);
        let room = LINK_BYTES_MAX.saturating_sub(self.twin.received.len());
        self.twin.take_incomplete(room);
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
    if *commanding && chip.processor().is_in_critical_section() {
        *commanding = false;
        twin.take_command();
    }
}
