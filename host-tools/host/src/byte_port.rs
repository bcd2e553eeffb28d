//! Where an emulated board is connected to other programs.

use std::io;

/// The board's end. Nothing of it waits.
pub trait BytePort {
    /// What `--port` of the other commands takes.
    fn name(&self) -> String;

    /// What has come; 0 if nothing has.
    ///
    /// # Errors
    /// What the system says when the port has failed.
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize>;

    /// Writes, and returns how many bytes there was room for.
    ///
    /// # Errors
    /// As [`Self::read`].
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize>;
}
