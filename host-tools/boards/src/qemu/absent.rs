//! Where there are no named pipes in the file system: no firmware under QEMU.

use super::QemuConfig;
use leg_firmware_bench::protocol::{BoardInfo, Reply, Request};
use leg_sim::link::{Link, LinkError};
use std::io::ErrorKind;

/// There is none.
#[derive(Debug)]
pub enum QemuSession {}

impl QemuSession {
    /// Says so.
    ///
    /// # Errors
    /// [`LinkError::System`], always.
    pub fn open(_: &QemuConfig) -> Result<Self, LinkError> {
        let action = "reach a firmware under QEMU on this system: take --on sim or --on chip";
        Err(LinkError::system(action)(ErrorKind::Unsupported))
    }

    /// What the firmware said of itself.
    #[must_use]
    pub const fn info(&self) -> Option<&BoardInfo> {
        match *self {}
    }
}

impl Link for QemuSession {
    fn ask(&mut self, _: &Request) -> Result<Reply, LinkError> {
        match *self {}
    }
}
