//! Systems without pseudo-terminals: an emulated board is on TCP there.

use crate::byte_port::BytePort;
use std::io;

/// There is none.
#[derive(Debug)]
pub enum PseudoTerminal {}

impl PseudoTerminal {
    /// Says so.
    ///
    /// # Errors
    /// [`io::ErrorKind::Unsupported`], always.
    pub fn open() -> io::Result<Self> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

impl BytePort for PseudoTerminal {
    fn name(&self) -> String {
        match *self {}
    }

    fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
        match *self {}
    }

    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        match *self {}
    }
}
