//! The board's image on the emulated chip.

use leg_boards::chip::ChipSession;
use leg_boards::image::FirmwareImage;
use leg_boards::setup;
use leg_firmware::command::Command;
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostReply, HostRequest, Identity};
use leg_firmware::sensors::{CODE_MAX, Sensors};
use leg_firmware::settings::Settings;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::{Reply, Request, TickRequest};
use leg_sim::emulated_leg::HostBytes;
use leg_sim::link::Link;
use std::error::Error;
use std::path::{Path, PathBuf};
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::{Chip, Stop};
use stm32g474_emulator::facts::{Facts, Pin};
use stm32g474_emulator::rcc::ResetFlag;

/// An image, built with what that needs.
pub fn image(image: FirmwareImage) -> Result<PathBuf, Box<dyn Error>> {
    setup::ensure_target(&mut |what: &str| eprintln!("{what}"))?;
    Ok(image.build()?)
}

/// A tick of a leg at rest, whose host says nothing.
pub fn resting_tick() -> TickRequest {
    TickRequest {
        sensors: Sensors {
            cell_codes: [CODE_MAX / 4; 3],
            current_codes: [CODE_MAX / 2; 3],
            supply_code: CODE_MAX / 3 * 2,
            temperature_code: CODE_MAX / 4,
            cell_fresh: [true; 3],
            ..Sensors::default()
        },
        link: HostBytes::new(),
    }
}

/// Lets the codes of the load cells change, as those of real ones do: constant ones are a fault.
pub fn vary_cells(chip: &Chip) {
    let change = (chip.cycle() / MS % 2) as u16;
    for number in 0..3 {
        let port = 'C';
        let cell = Pin { port, number };
        let code = CODE_MAX / 4 + change;
        chip.peripherals().devices.analogue.insert(cell, code);
    }
}

pub type Outcome = Result<(), Box<dyn Error>>;

/// Cycles of 170 MHz in a millisecond.
pub const MS: u64 = 170_000;

/// The rate of the host's line, baud.
pub const BAUD: u32 = 921_600;

/// A session with an image after its first ticks.
pub fn started_with(
    image: &Path,
    board: Board,
    ticks: usize,
) -> Result<ChipSession, Box<dyn Error>> {
    ticked(ChipSession::open(image)?.with_board(board), ticks)
}

/// A session that starts, after its first ticks.
pub fn ticked(mut session: ChipSession, ticks: usize) -> Result<ChipSession, Box<dyn Error>> {
    let settings = Settings::table_1().ok_or("no built-in settings")?;
    assert_eq!(session.ask(&Request::Start(settings))?, Reply::Started);
    for _ in 0..ticks {
        session.ask(&Request::Tick(resting_tick()))?;
    }
    Ok(session)
}

/// A session with the image as it is after its first ticks.
pub fn started(ticks: usize) -> Result<ChipSession, Box<dyn Error>> {
    started_with(&image(FirmwareImage::Stm32g474)?, Board::default(), ticks)
}

/// A session whose chip homes: its pulses are on.
pub fn driving(image: &Path, board: Board) -> Result<ChipSession, Box<dyn Error>> {
    let mut session = started_with(image, board, 10)?;
    drive(session.chip().ok_or("no chip")?)?;
    Ok(session)
}

/// Lets a chip home: its pulses are on.
pub fn drive(chip: &mut Chip) -> Outcome {
    identity(chip)?;
    let command = Command::Home;
    carry_out(chip, &HostRequest::Command { host: 1, command })?;
    let end = chip.cycle() + 5 * MS;
    while chip.cycle() < end {
        if chip.peripherals().devices.tim1.outputs().on {
            return Ok(());
        }
        chip.run(end);
    }
    Err("the chip does not drive".into())
}

/// Runs until a reset; none if none comes in time.
pub fn reset_within(chip: &mut Chip, cycles: u64) -> Option<ResetFlag> {
    let end = chip.cycle() + cycles;
    while chip.cycle() < end {
        if let Stop::Reset(cause) = chip.run(end) {
            return Some(cause);
        }
    }
    None
}

/// Sends a request over the chip's serial line.
pub fn send(chip: &mut Chip, request: &HostRequest) -> Outcome {
    let mut out = [0; MAX_FRAME];
    for &byte in frame::encode(1, request, &mut out)? {
        chip.peripherals().send(byte, BAUD);
    }
    Ok(())
}

/// Waits for the reply that is meant; earlier ones may still be on the line.
pub fn reply<T>(
    chip: &mut Chip,
    meant: impl Fn(HostReply) -> Option<T>,
) -> Result<T, Box<dyn Error>> {
    let mut decoder = Decoder::new();
    let end = chip.cycle() + 200 * MS;
    while chip.cycle() < end {
        chip.run(chip.cycle() + MS);
        while let Some(sent) = chip.peripherals().devices.lpuart.host_receive() {
            if let Some(Ok(frame)) = decoder.push(sent.byte)
                && let Some(found) = frame.message().and_then(&meant)
            {
                return Ok(found);
            }
        }
    }
    let place = chip.processor().place();
    let asleep = chip.processor().sleeps();
    let findings = findings(chip);
    Err(format!("the chip does not answer: at {place:x?}, asleep {asleep}, {findings:?}").into())
}

/// Asks for something, and waits until it is done.
pub fn carry_out(chip: &mut Chip, request: &HostRequest) -> Outcome {
    send(chip, request)?;
    done(chip)
}

/// Waits until what was asked for is done.
pub fn done(chip: &mut Chip) -> Outcome {
    reply(chip, |reply| (reply == HostReply::Done).then_some(()))
}

/// What the chip knows of itself.
pub fn telemetry(chip: &mut Chip) -> Result<Telemetry<f32>, Box<dyn Error>> {
    send(chip, &HostRequest::Telemetry)?;
    reply(chip, |reply| match reply {
        HostReply::Telemetry(report) => Some(report.telemetry),
        _ => None,
    })
}

/// Asks the chip what it is.
pub fn identity(chip: &mut Chip) -> Result<Identity, Box<dyn Error>> {
    let schema = HOST_SCHEMA;
    send(chip, &HostRequest::Identify(Hello { schema }))?;
    reply(chip, |reply| match reply {
        HostReply::Identified(identity) => Some(identity),
        _ => None,
    })
}

/// Lets a chip that starts come to its tasks, and asks what it is.
pub fn identity_after(chip: &mut Chip) -> Result<Identity, Box<dyn Error>> {
    let end = chip.cycle() + 60 * MS;
    while chip.cycle() < end {
        chip.run(end);
    }
    // The reset may have cut a reply off, and the rest of it never comes.
    while chip.peripherals().devices.lpuart.host_receive().is_some() {}
    identity(chip)
}

/// The settings that the chip uses.
pub fn settings(chip: &mut Chip) -> Result<Settings, Box<dyn Error>> {
    send(chip, &HostRequest::GetSettings)?;
    reply(chip, |reply| match reply {
        HostReply::Settings(settings) => Some(settings),
        _ => None,
    })
}

/// What the image did wrong up to now.
pub fn findings(chip: &Chip) -> Vec<String> {
    let peripherals = chip.peripherals();
    let list = peripherals.findings.list();
    list.iter().map(ToString::to_string).collect()
}

/// Settings that differ from the built-in ones.
pub fn other_settings() -> Result<Settings, Box<dyn Error>> {
    let mut settings = Settings::table_1().ok_or("no built-in settings")?;
    settings.limits.command_time_s *= 2.0;
    Ok(settings)
}

/// Measures how late the control interrupt's handler may begin: the longest time in which it could not, whenever it comes.
pub struct LatencyMeter {
    interrupt: u16,
    /// Since when it could not begin.
    since: Option<u64>,
    /// The longest up to now, cycles, and where it ended.
    pub worst: (u64, u32),
}

impl LatencyMeter {
    /// Of the control interrupt.
    pub fn new() -> Result<Self, Box<dyn Error>> {
        let interrupt = Facts::chip().interrupt("ADC1_2");
        Ok(Self {
            interrupt: interrupt.ok_or("no interrupt of the converters")?,
            since: None,
            worst: (0, 0),
        })
    }

    /// Runs to a cycle.
    pub fn run(&mut self, chip: &mut Chip, end: u64) {
        while chip.cycle() < end {
            let before = chip.cycle();
            chip.step(end);
            if chip.processor().holds_off(self.interrupt) {
                self.since.get_or_insert(before);
            } else if let Some(since) = self.since.take() {
                let held = chip.cycle() - since;
                self.worst = self.worst.max((held, chip.processor().pc()));
            }
        }
    }
}
