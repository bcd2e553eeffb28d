//! Boards without hardware: builds the firmware images, installs what that needs, and runs the firmware under QEMU.
//!
//! Begin with [`setup`], which makes sure that the Rust target and QEMU are there; [`image::FirmwareImage::build`] then
//! compiles the firmware, and [`qemu::QemuSession`] boots it and answers requests as a
//! [`Link`](leg_sim::link::Link). The same code without an emulator is
//! [`InProcess`](leg_sim::link::InProcess).
//!
//! ```no_run
//! use leg_boards::image::FirmwareImage;
//! use leg_boards::qemu::{QemuConfig, QemuSession};
//! use leg_boards::setup;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut report = |doing: &str| eprintln!("{doing}");
//! setup::ensure_target(&mut report)?;
//! let qemu = setup::ensure_qemu(&mut report)?;
//! let image = FirmwareImage::Qemu.build()?;
//! let session = QemuSession::open(&QemuConfig::new(qemu, image))?;
//! println!("{:?}", session.info());
//! session.close()?;
//! # Ok(())
//! # }
//! ```

pub mod chip;
pub mod image;
pub mod qemu;
pub mod setup;
pub mod window_page;
