//! Blocks that only keep what is written: SYSCFG and DBGMCU, whose bits others look at.

use crate::device::{Context, Device, RegisterFile};
use crate::facts::Block;

/// A block that keeps what is written.
#[derive(Clone, Debug)]
pub struct Plain(RegisterFile);

impl Plain {
    /// After a power-up.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        Self(RegisterFile::new(block))
    }

    /// Its registers.
    #[must_use]
    pub fn registers(&self) -> &RegisterFile {
        &self.0
    }
}

impl Device for Plain {
    fn reset(&mut self) {
        self.0.reset();
    }

    fn read(&mut self, offset: u32, _context: &mut Context<'_>) -> u32 {
        self.0.get(offset)
    }

    fn write(&mut self, offset: u32, value: u32, _context: &mut Context<'_>) {
        self.0.set(offset, value);
    }
}
