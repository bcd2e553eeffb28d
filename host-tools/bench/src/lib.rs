//! What is promised of the firmware, measured: accuracy, equal bits, instructions, images, the figures of the paper.
//!
//! Begin with [`check`], which compares a firmware with f64 by the [`precision`] table, and bit by bit with the same code
//! on the host. [`cost`] counts instructions on an emulated board, [`image_budget`] bounds flash, RAM and stack of an
//! image from its ELF file, and [`paper`] compares the model with the published numbers. [`strikes`] lets faults
//! strike the simulated leg in every state, [`moves`] judges how it moves, and [`bode`] measures the margins of its
//! loops; all three on a [`stand`]. [`sensitivity`] and [`run_charts`] serve `leg run`, and [`plot`]
//! draws what all of them and the command line show.
//!
//! ```
//! use leg_bench::{check, precision};
//! use leg_sim::link::InProcess;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut firmware = InProcess::new();
//! let states = check::random(20, 1);
//! let report = check::run(&mut firmware, &precision::TABLE, &states, || ())?;
//! assert!(report.bits.differences.is_empty());
//! # Ok(())
//! # }
//! ```

pub mod bode;
pub mod check;
pub mod cost;
mod draw;
pub mod image_budget;
pub mod moves;
pub mod paper;
pub mod plot;
pub mod precision;
pub mod recorder_charts;
pub mod run_charts;
pub mod sensitivity;
pub mod stand;
pub mod strikes;
mod time_charts;
