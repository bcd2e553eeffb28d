//! An STM32G474 that runs the image of the board, and reports what the image does wrong.
//!
//! The processor is [`rsemu`]'s; the peripherals that the image uses are here. What a register is (its address, fields,
//! access, reset value, clock) is not typed by hand: see [`facts`]. An access or a state that the real chip forbids is a
//! [`ChipFinding`](findings::ChipFinding), and a run with findings fails.
//!
//! Begin with [`image::Image::parse`], which reads the file that is flashed; [`chip::Chip::run`] lets it run on a
//! [`Board`](board::Board) until something happens, and [`chip::Chip::peripherals`] has what was found.
//!
//! ```no_run
//! use stm32g474_emulator::board::Board;
//! use stm32g474_emulator::chip::Chip;
//! use stm32g474_emulator::image::Image;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let elf = std::fs::read("target/thumbv7em-none-eabihf/firmware/leg-stm32g474")?;
//! let image = Image::parse(&elf)?;
//! let mut chip = Chip::new(&image, &Board::default())?;
//! let stop = chip.run(100_000);
//! println!("{stop:?} at cycle {}", chip.cycle());
//! for finding in chip.peripherals().findings.list() {
//!     println!("{finding:?}");
//! }
//! # Ok(())
//! # }
//! ```
//!
//! | module | what is in it |
//! |---|---|
//! | [`facts`] | what the chip's makers say of its registers, pins and interrupts |
//! | [`findings`] | what an image did wrong |
//! | [`image`] | an image's bytes and names |
//! | [`chip`] | processor, memories and peripherals in step |
//! | [`device`] | what a peripheral is to the rest of the chip |
//!
//! What it does not show is in `README.md`.

pub mod access;
pub mod adc;
#[cfg(test)]
mod bench;
pub mod board;
mod bus;
pub mod chip;
pub mod clocks;
pub mod configuration;
pub mod device;
pub mod devices;
pub mod encoder_timer;
pub mod facts;
pub mod fdcan;
pub mod findings;
pub mod flash;
pub mod gpio;
pub mod image;
pub mod iwdg;
pub mod lpuart;
mod memory_map;
pub mod peripherals;
pub mod plain;
pub mod processor;
pub mod pwr;
pub mod rcc;
pub mod tim1;
pub mod tim15;
pub mod timer;
pub mod trace;
pub mod wwdg;
