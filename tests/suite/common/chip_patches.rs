//! Changes to a program that runs on the emulated chip, as a debugger makes them.

use super::chip::{Outcome, driving, image};
use leg_boards::chip::ChipSession;
use leg_boards::image::FirmwareImage;
use std::error::Error;
use std::fs;
use stm32g474_emulator::board::Board;
use stm32g474_emulator::chip::Chip;
use stm32g474_emulator::image::Image;

/// Bytes between variables and stack that nothing may write; they begin at a multiple of their number.
pub const GUARD: u32 = 1_024;

/// Words of a task's storage in which the executor keeps the function that polls it.
const HEADER: u32 = 16;

/// A task of the image, by the endings of the names of its storage and of the function that polls it.
#[derive(Clone, Copy)]
pub struct ImageTask {
    storage: &'static str,
    poll: &'static str,
}

/// Serves the host.
pub const LINK: ImageTask = ImageTask {
    storage: "leg_stm32g474::serial::serve::POOL",
    poll: "serial::__serve_task::__serve_task_inner_function::{closure#0}>>::poll",
};

/// Keeps settings.
pub const SETTINGS: ImageTask = ImageTask {
    storage: "leg_stm32g474::settings_task::keep_settings::POOL",
    poll: "settings_task::__keep_settings_task::__keep_settings_task_inner_function::{closure#0}>>::poll",
};

/// A chip that drives, and its image.
pub fn driven() -> Result<(ChipSession, Image), Box<dyn Error>> {
    let path = image(FirmwareImage::Stm32g474)?;
    let parsed = Image::parse(&fs::read(&path)?)?;
    Ok((driving(&path, Board::default())?, parsed))
}

/// Lets a function begin with other instructions of two bytes.
pub fn replace(chip: &mut Chip, image: &Image, function: &str, instructions: &[u32]) -> Outcome {
    let mut address = image.symbol(function).ok_or("no such function")? & !1;
    for instruction in instructions {
        let shift = 8 * (address & 2);
        let word = chip.processor().word(address & !3).ok_or("no memory")?;
        let word = word & !(0xffff << shift) | instruction << shift;
        assert!(chip.set_word(address & !3, word));
        address += 2;
    }
    Ok(())
}

/// Where the guard of the stack begins.
pub fn guard(image: &Image) -> Result<u32, Box<dyn Error>> {
    let end = image.symbol("__sheap").ok_or("no variables")?;
    Ok(end.next_multiple_of(GUARD))
}

/// Puts words at the end of the stack's place, which the program does not reach; their address.
pub fn place_words(chip: &mut Chip, image: &Image, words: &[u32]) -> Result<u32, Box<dyn Error>> {
    let address = guard(image)? + GUARD;
    for (at, word) in (address..).step_by(4).zip(words) {
        assert!(chip.set_word(at, *word));
    }
    Ok(address)
}

/// Lets a task be polled by other instructions, which begin at an address.
pub fn poll_by(chip: &mut Chip, image: &Image, task: ImageTask, address: u32) -> Outcome {
    let storage = image.variable(task.storage).ok_or("no such task")?;
    let polls = image.functions_ending(task.poll);
    let is_poll = |at: &u32| {
        let word = chip.processor().word(*at).unwrap_or_default();
        polls.contains(&(word & !1))
    };
    let at = (storage..storage + 4 * HEADER).step_by(4).find(is_poll);
    assert!(chip.set_word(at.ok_or("no function that polls")?, address | 1));
    Ok(())
}
