//! The log of the image, read from RAM as a debugger does: SEGGER's real-time transfer, channel 0.

use defmt_decoder::{DecodeError, Table};
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::image::Image;

/// The control block, by defmt-rtt's name.
const BLOCK: &str = "_SEGGER_RTT";

/// Where in the block channel 0 has its buffer, the buffer's size, and the places of the next write and read: after an
/// identifier of 16 bytes, two counts and a name.
const BUFFER: u32 = 28;
const SIZE: u32 = 32;
const WRITE: u32 = 36;
const READ: u32 = 40;

/// The lines since the last call; none where the image has no log.
pub fn lines(image: &Image, table: &Table, chip: &mut Chip) -> Vec<String> {
    unread(image, chip)
        .map(|bytes| decoded(table, &bytes))
        .unwrap_or_default()
}

/// Takes what is in the buffer.
fn unread(image: &Image, chip: &mut Chip) -> Option<Vec<u8>> {
    let block = image.symbol(BLOCK)?;
    let word = |chip: &Chip, at: u32| chip.processor().word(at);
    let [buffer, size, write, read] =
        [BUFFER, SIZE, WRITE, READ].map(|at| word(chip, block + at).unwrap_or_default());
    if write >= size || read >= size {
        return None;
    }
    let length = (write + size - read) % size;
    let bytes = (0..length).map(|at| {
        let at = buffer + (read + at) % size;
        word(chip, at & !3).map(|word| (word >> (8 * (at & 3))) as u8)
    });
    let bytes = bytes.collect::<Option<Vec<u8>>>()?;
    chip.set_word(block + READ, write).then_some(bytes)
}

fn decoded(table: &Table, bytes: &[u8]) -> Vec<String> {
    let mut decoder = table.new_stream_decoder();
    decoder.received(bytes);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => lines.push(frame.display(false).to_string()),
            Err(DecodeError::UnexpectedEof) => return lines,
            Err(DecodeError::Malformed) => lines.push("(a log frame was damaged)".to_owned()),
        }
    }
}
