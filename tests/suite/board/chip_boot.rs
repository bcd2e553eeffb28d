//! The board's image from its reset to its first ticks, on the emulated chip.

use crate::common::chip::{
    BAUD, MS, Outcome, carry_out, driving, findings, identity, identity_after, image,
    other_settings, reset_within, resting_tick, send, settings, started, started_with, ticked,
};
use crate::common::chip_bus::started_on_can;
use leg_boards::chip::ChipSession;
use leg_boards::image::{FirmwareImage, workspace_root};
use leg_firmware::board::timing::TICK_CYCLES;
use leg_firmware::can::LegAddress;
use leg_firmware::command::Command;
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostRequest, ResetCause};
use leg_firmware::sensors::CODE_MAX;
use leg_firmware_bench::protocol::Request;
use leg_sim::link::{Link, LinkError};
use std::error::Error;
use std::ops::Range;
use std::{env, fs};
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::Stop;
use stm32g474_emulator::configuration;
use stm32g474_emulator::image::{ChipImageError, Image};
use stm32g474_emulator::rcc::ResetFlag;
use stm32g474_emulator::trace;

/// After these the serial line is set up.
const TRACED_TICKS: usize = 4;
/// After these it is open.
const CONFIGURED_TICKS: usize = 10;
/// The chip is asked something every so many ticks; by then a leg that was asked to home is driven.
const ASKED_TICKS: usize = 100;
const HOMING_TICKS: usize = 2 * ASKED_TICKS + 30;
/// For so long a copy is compared.
const COPIED_TICKS: usize = 800;
/// After these the chip takes part in the CAN bus.
const TICKS_TO_BUS: usize = 60;

#[test]
fn the_boot_writes_what_was_reviewed() -> Outcome {
    let board = Board {
        records_writes: true,
        ..Board::default()
    };
    let mut session = started_with(&image(FirmwareImage::Stm32g474)?, board, TRACED_TICKS)?;
    let chip = session.chip().ok_or("no chip")?;
    let writes = chip.peripherals().checks.take_recorded();
    is_as_reviewed("chip_boot.txt", &trace::lines(&writes))
}

/// The same in words: clocks, pins, pulses and breaks, converters, line, watchdogs.
#[test]
fn the_boot_sets_up_what_was_reviewed() -> Outcome {
    let mut session = started(CONFIGURED_TICKS)?;
    let chip = session.chip().ok_or("no chip")?;
    let lines = configuration::lines(&chip.peripherals());
    is_as_reviewed("chip_configuration.txt", &lines)
}

/// On a CAN bus: what differs from that, `-` on the serial line alone and `+` on the bus alone.
#[test]
fn the_boot_on_a_bus_sets_up_what_was_reviewed() -> Outcome {
    let image = image(FirmwareImage::Stm32g474)?;
    let [_, leg, ..] = LegAddress::ALL;
    let lines = |mut session: ChipSession| -> Result<Vec<String>, Box<dyn Error>> {
        let chip = session.chip().ok_or("no chip")?;
        Ok(configuration::lines(&chip.peripherals()))
    };
    let serial = lines(started(CONFIGURED_TICKS)?)?;
    let on_can = lines(started_on_can(&image, leg, TICKS_TO_BUS)?)?;
    let only = |sign: char, one: &[String], other: &[String]| {
        let alone = one.iter().filter(|line| !other.contains(line));
        alone.map(|line| format!("{sign} {line}")).collect()
    };
    let differing: [Vec<_>; 2] = [only('-', &serial, &on_can), only('+', &on_can, &serial)];
    is_as_reviewed("chip_configuration_can.txt", &differing.concat())
}

fn is_as_reviewed(golden: &str, lines: &[String]) -> Outcome {
    let found = lines.join("\n") + "\n";
    let golden = workspace_root().join("tests/golden").join(golden);
    if env::var_os("LEG_OVERWRITE").is_some() {
        fs::write(&golden, &found)?;
    }
    let expected = fs::read_to_string(&golden)?;
    let differing = found.lines().zip(expected.lines()).find(|(a, b)| a != b);
    assert!(
        found == expected,
        "the boot differs from {}, first (found, expected): {differing:?}; read the difference, and accept it with \
         LEG_OVERWRITE=1",
        golden.display()
    );
    Ok(())
}

/// In the midst of homing: what is asked of both has the same answers, to the bit, and at the same cycle.
#[test]
fn a_copied_chip_goes_on_as_its_original() -> Outcome {
    let mut original = started(0)?;
    let schema = HOST_SCHEMA;
    let command = Command::Home;
    let mut asked = [
        HostRequest::Identify(Hello { schema }),
        HostRequest::Command { host: 1, command },
    ]
    .into_iter();
    let mut ask = |session: &mut ChipSession, tick: usize| {
        let mut request = resting_tick();
        // Constant codes are a fault.
        request.sensors.cell_codes = [CODE_MAX / 4 + tick as u16 % 8; 3];
        if tick % ASKED_TICKS == ASKED_TICKS - 1
            && let Some(next) = asked.next()
        {
            let mut out = [0; MAX_FRAME];
            let bytes = frame::encode(tick as u16, &next, &mut out).unwrap_or_default();
            request.link.extend_from_slice(bytes).unwrap_or_default();
        }
        session.ask(&Request::Tick(request))
    };
    for tick in 0..HOMING_TICKS {
        ask(&mut original, tick)?;
    }
    let chip = original.chip().ok_or("no chip")?;
    assert!(chip.peripherals().devices.tim1.outputs().on);
    let mut copy = original.copy()?;
    for tick in HOMING_TICKS..HOMING_TICKS + COPIED_TICKS {
        let replies = [ask(&mut original, tick)?, ask(&mut copy, tick)?];
        assert_eq!(replies[0], replies[1], "tick {tick}");
    }
    let [first, second] = [&mut original, &mut copy].map(|session| {
        let chip = session.chip().map(|chip| (chip.cycle(), chip.place()));
        (chip, session.latency_max())
    });
    assert_eq!(first, second);
    // What happens to one does not happen to the other.
    let chip = copy.chip().ok_or("no chip")?;
    chip.reset(ResetFlag::Pin);
    assert!(original.ask(&Request::Tick(resting_tick())).is_ok());
    Ok(())
}

#[test]
fn the_chip_tells_why_it_started() -> Outcome {
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    assert_eq!(identity(chip)?.reset, ResetCause::Power);
    chip.reset(ResetFlag::Pin);
    assert_eq!(identity_after(chip)?.reset, ResetCause::Pin);
    chip.cycle_power(1);
    assert_eq!(identity_after(chip)?.reset, ResetCause::Power);
    assert_eq!(findings(chip), [""; 0]);
    Ok(())
}

#[test]
fn settings_are_kept_over_a_reset() -> Outcome {
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    let other = other_settings()?;
    carry_out(chip, &HostRequest::SetSettings(other.clone()))?;
    carry_out(chip, &HostRequest::SaveSettings)?;
    chip.reset(ResetFlag::Pin);
    identity_after(chip)?;
    assert_eq!(settings(chip)?, other);
    assert_eq!(findings(chip), [""; 0]);
    Ok(())
}

#[test]
fn a_host_with_another_rate_is_a_finding_and_the_next_one_is_heard() -> Outcome {
    let mut session = started(10)?;
    let chip = session.chip().ok_or("no chip")?;
    for byte in 0..40 {
        chip.peripherals().send(byte, BAUD * 9 / 10);
    }
    let end = chip.cycle() + 5 * MS;
    while chip.cycle() < end {
        chip.run(end);
    }
    let reported = findings(chip);
    assert!(
        reported.iter().any(|finding| finding.contains("baud")),
        "{reported:?}"
    );
    send(chip, &HostRequest::Telemetry)?;
    identity(chip)?;
    Ok(())
}

#[test]
fn a_crystal_that_stops_ends_the_pulses_and_is_told() -> Outcome {
    let image = image(FirmwareImage::Stm32g474)?;
    let mut session = driving(&image, Board::default())?;
    let chip = session.chip().ok_or("no chip")?;
    chip.stop_crystal();
    assert!(!chip.peripherals().devices.tim1.outputs().on);
    assert_eq!(reset_within(chip, 100 * MS), Some(ResetFlag::Software));
    chip.start_crystal(Board::default().crystal_hz);
    let identity = identity_after(chip)?;
    assert_eq!(
        (identity.reset, identity.crash_report.as_str()),
        (ResetCause::Software, "the crystal has stopped")
    );
    Ok(())
}

/// Without it the chip says nothing and drives nothing. It does not wait for it without an end: it starts anew, and says so once it runs.
#[test]
fn a_crystal_that_does_not_start_is_told() -> Outcome {
    let mut session = started(40)?;
    let chip = session.chip().ok_or("no chip")?;
    identity(chip)?;
    chip.reset(ResetFlag::Pin);
    chip.stop_crystal();
    while chip.peripherals().devices.lpuart.host_receive().is_some() {}
    // From the third one on the next start is put off, so that a debugger has time to attach.
    for within in [50, 50, 1_000, 1_000] {
        assert_eq!(reset_within(chip, within * MS), Some(ResetFlag::Software));
        assert!(!chip.peripherals().devices.tim1.outputs().on);
        send(chip, &HostRequest::Telemetry)?;
    }
    assert_eq!(chip.peripherals().devices.lpuart.host_receive(), None);
    chip.start_crystal(Board::default().crystal_hz);
    let identity = identity_after(chip)?;
    assert_eq!(
        (identity.reset, identity.crash_report.as_str()),
        (ResetCause::Software, "the crystal does not start")
    );
    Ok(())
}

/// Fields of the header of an ELF file of 32 bits, and its length: where the program headers are, where the section headers
/// are, and how many these are.
const PROGRAM_HEADERS: Range<usize> = 0x1c..0x20;
const SECTION_HEADERS: Range<usize> = 0x20..0x24;
const SECTION_COUNTS: Range<usize> = 0x30..0x34;
const ELF_HEADER: usize = 0x34;

#[test]
fn what_is_no_image_of_the_chip_is_refused() -> Outcome {
    let qemu = fs::read(image(FirmwareImage::Qemu)?)?;
    let other = Image::parse(&qemu).err();
    assert!(
        matches!(other, Some(ChipImageError::Outside { address: 0, .. })),
        "{other:?}"
    );
    let host = Image::parse(&fs::read(env::current_exe()?)?).err();
    assert!(
        matches!(host, Some(ChipImageError::OtherProcessor(_))),
        "{host:?}"
    );
    let mut elf = fs::read(image(FirmwareImage::Stm32g474)?)?;
    let start = usize::try_from(u32::from_le_bytes(elf[PROGRAM_HEADERS].try_into()?))?;
    assert_eq!(start, ELF_HEADER, "the first program header");
    // It begins with the vector table.
    let vectors = usize::try_from(u32::from_le_bytes(elf[start + 4..start + 8].try_into()?))?;
    let mut stripped = elf.clone();
    stripped[SECTION_HEADERS].fill(0);
    stripped[SECTION_COUNTS].fill(0);
    let stripped = Image::parse(&stripped).err();
    assert!(
        matches!(stripped, Some(ChipImageError::NoSymbols)),
        "{stripped:?}"
    );
    // A stack at the end of the RAM of a larger chip.
    elf[vectors..vectors + 4].copy_from_slice(&0x2004_0000_u32.to_le_bytes());
    let larger = Image::parse(&elf).err();
    assert!(
        matches!(
            larger,
            Some(ChipImageError::NoVectorTable {
                stack: 0x2004_0000,
                ..
            })
        ),
        "{larger:?}"
    );
    let text = Image::parse(b"no ELF").err();
    assert!(matches!(text, Some(ChipImageError::NotElf(_))), "{text:?}");
    let missing = ChipSession::open("no-such-image".as_ref()).err();
    assert!(matches!(missing, Some(LinkError::System { .. })));
    Ok(())
}

/// The harness lets some cycles of a tick pass to see a break end the pulses: an update of the timer meanwhile, or a reset,
/// must not be taken for nothing.
#[test]
fn an_unexpected_stop_within_a_tick_is_told() -> Outcome {
    let mut session = driving(&image(FirmwareImage::Stm32g474)?, Board::default())?;
    let chip = session.chip().ok_or("no chip")?;
    while chip.run(u64::MAX) != Stop::Update {}
    let update = chip.cycle() + u64::from(TICK_CYCLES);
    while chip.run(update - 40) != Stop::Time {}
    let mut pressed = resting_tick();
    pressed.sensors.emergency_stop = true;
    let Err(error) = session.ask(&Request::Tick(pressed)) else {
        return Err("the tick passes".into());
    };
    let expected = "the emulated chip comes to the next update of TIM1 too soon";
    assert!(error.to_string().contains(expected), "{error}");
    Ok(())
}

/// `udf` and `b .`.
const UNDEFINED: u16 = 0xde00;
const ENDLESS: u16 = 0xe7fe;

/// Where the instruction at an address is in an ELF file.
fn place_in_file(elf: &[u8], address: u32) -> Option<Range<usize>> {
    let word = |at: usize| Some(u32::from_le_bytes(elf.get(at..at + 4)?.try_into().ok()?));
    // Program headers of 32 bytes: type, place in the file, two addresses, size.
    let headers = (0..).map(|header| ELF_HEADER + 32 * header);
    for header in headers.take(6) {
        let [place, start, size] = [word(header + 4)?, word(header + 8)?, word(header + 16)?];
        if (start..start + size).contains(&address) {
            let at = (place + address - start) as usize;
            return Some(at..at + 2);
        }
    }
    None
}

/// A program that faults, one that faults in its fault's handler, and one that never comes to a tick: each ends with where it
/// was.
#[test]
fn a_program_without_a_tick_is_told_with_its_place() -> Outcome {
    let elf = fs::read(image(FirmwareImage::Stm32g474)?)?;
    let parsed = Image::parse(&elf)?;
    for (functions, instruction, how) in [
        (&["main"][..], UNDEFINED, "was reset (Software)"),
        (&["main", "HardFault"], UNDEFINED, "is locked up"),
        (&["main"], ENDLESS, "starts no tick"),
    ] {
        let mut changed = elf.clone();
        for function in functions {
            let address = parsed.symbol(function).ok_or("no such function")? & !1;
            let at = place_in_file(&elf, address).ok_or("no such place")?;
            changed[at].copy_from_slice(&instruction.to_le_bytes());
        }
        let file = tempfile::NamedTempFile::new()?;
        fs::write(file.path(), changed)?;
        let error = ticked(ChipSession::open(file.path())?, 1).err();
        let told = error.ok_or("the tick passes")?.to_string();
        assert!(told.contains(how) && told.contains(" in main"), "{told}");
    }
    Ok(())
}
