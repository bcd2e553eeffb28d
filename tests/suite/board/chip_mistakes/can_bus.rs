//! A chip that is leg 1 on a CAN bus, and a host there that asks it what it is.

use crate::common::chip_bus::{bus_frame, started_on_can, with_node};
use leg_firmware::can::{CanFrame, Identifier, LegAddress, Segmenter};
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostRequest};
use std::error::Error;
use std::path::Path;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::facts::Facts;
use stm32g474_emulator::fdcan::{Reception, TransmitOutcome};

/// Ticks after which the chip takes part in the bus: 5 ms.
const BOOT_TICKS: usize = 40;

/// Cycles of 170 MHz in which it has to answer, 50 ms.
const ANSWER_CYCLES: u64 = 8_500_000;

/// What passes from one look at the bus to the next, cycles.
const STEP: u64 = 17_000;

/// Boots, and lets a host ask.
pub fn asked(image: &Path) -> Result<(), Box<dyn Error>> {
    let mut session = started_on_can(image, LegAddress::ALL[0], BOOT_TICKS)?;
    let chip = session.chip().unwrap();
    let [leg, other] = [1, 2].map(|number| LegAddress::new(number).unwrap());
    hear(chip, &question(other))?;
    if waiting(chip) {
        return Err("FDCAN2 keeps a frame to another leg".into());
    }
    hear(chip, &question(leg))?;
    if !waiting(chip) {
        return Err("FDCAN2 keeps no frame that is meant for it".into());
    }
    let end = chip.cycle() + ANSWER_CYCLES;
    while chip.cycle() < end {
        chip.run(chip.cycle() + STEP);
        let answer = with_node(chip, |node, context| {
            let frame = node.take_transmission(context)?;
            node.transmission_ends(TransmitOutcome::Acknowledged, context);
            Some(frame)
        });
        found(chip)?;
        if answer.is_some_and(|frame| frame.identifier == Identifier::ToHost(leg).bits()) {
            return Ok(());
        }
    }
    Err("FDCAN2 sends no answer".into())
}

/// The host's question, which fits into one frame.
fn question(leg: LegAddress) -> CanFrame {
    let mut out = [0; MAX_FRAME];
    let schema = HOST_SCHEMA;
    let request = HostRequest::Identify(Hello { schema });
    let bytes = frame::encode(1, &request, &mut out).unwrap();
    let mut segmenter = Segmenter::new(Identifier::ToLeg(leg));
    segmenter.segments(bytes).unwrap().next().unwrap()
}

/// A frame comes over the bus, as the board's documents have it: 1 Mbit/s, and 5 Mbit/s for data.
fn hear(chip: &mut Chip, frame: &CanFrame) -> Result<(), Box<dyn Error>> {
    let frame = bus_frame(frame);
    let said = with_node(chip, |node, context| node.bus_receive(&frame, context));
    found(chip)?;
    match said {
        Reception::Acknowledged => Ok(()),
        said => Err(format!("FDCAN2 says to a frame: {said:?}").into()),
    }
}

/// Whether the first receive FIFO holds a frame.
fn waiting(chip: &Chip) -> bool {
    let block = Facts::chip().block("FDCAN2").unwrap();
    let status = block.register("RXF0S").unwrap();
    let value = chip.peripherals().read(block.base + status.offset, 4);
    status.field("FFL").unwrap().value(value) > 0
}

/// What the image does wrong.
fn found(chip: &Chip) -> Result<(), Box<dyn Error>> {
    let peripherals = chip.peripherals();
    match peripherals.findings.list() {
        [] => Ok(()),
        [first, ..] => Err(first.to_string().into()),
    }
}
