//! One emulator with the firmware in it, as a [`Link`].

use super::Config;
use super::connection::Connection;
use leg_firmware_bench::protocol::{BoardInfo, Reply, Request};
use leg_sim::link::{self, Link, LinkError};

/// A booted firmware that answers. Dropping it ends QEMU and removes the pipes.
#[derive(Debug)]
pub struct Session {
    link: Connection,
    info: BoardInfo,
}

impl Session {
    /// Boots the firmware and introduces the host to it.
    ///
    /// # Errors
    /// [`LinkError`] if QEMU, the image or the firmware fails, or the firmware was built from other sources.
    pub fn open(config: &Config) -> Result<Self, LinkError> {
        let mut link = Connection::open(config)?;
        let info = link::greet(&mut link)?;
        Ok(Self { link, info })
    }

    /// What the firmware said of itself.
    #[must_use]
    pub const fn info(&self) -> &BoardInfo {
        &self.info
    }

    /// Number of QEMU's process.
    #[must_use]
    pub fn process_id(&self) -> u32 {
        self.link.process_id()
    }

    /// The firmware's last log lines.
    #[must_use]
    pub fn log(&self) -> Vec<String> {
        self.link.last_lines()
    }

    /// Closes the link and waits for the firmware to end by itself.
    ///
    /// # Errors
    /// [`LinkError::Died`] if it ends in another way than by the closed link.
    pub fn close(self) -> Result<(), LinkError> {
        self.link.close()
    }
}

impl Link for Session {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        self.link.ask(request)
    }
}
