//! What is promised of the firmware, measured: accuracy, equal bits, instructions, images, the figures of the paper.

pub mod check;
pub mod cost;
pub mod image_budget;
pub mod paper;
pub mod precision;
pub mod run_charts;
pub mod sensitivity;
