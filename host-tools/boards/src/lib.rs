//! Boards without hardware: builds the images, and runs the firmware under QEMU.

pub mod evaluate;
pub mod image;
pub mod qemu;
pub mod setup;
