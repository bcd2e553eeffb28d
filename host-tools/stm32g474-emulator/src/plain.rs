//! Blocks that only keep what is written: SYSCFG and DBGMCU, whose bits others look at.

use crate::device::{Context, Device, FieldPlace, RegisterFile};
use crate::facts::Block;

/// A block that keeps what is written.
#[derive(Clone, Debug)]
pub struct Plain {
    registers: RegisterFile,
    /// Offsets of the registers whose ones stay until a reset.
    lasting: Vec<u32>,
}

impl Plain {
    /// After a power-up.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        Self {
            registers: RegisterFile::new(block),
            lasting: Vec::new(),
        }
    }

    /// The same, with registers whose bits only a reset clears.
    #[must_use]
    pub fn with_lasting(mut self, registers: &[&str]) -> Self {
        let offsets = registers.iter().map(|name| self.registers.offset(name));
        self.lasting = offsets.collect();
        self
    }

    /// Its registers.
    #[must_use]
    pub fn registers(&self) -> &RegisterFile {
        &self.registers
    }

    /// Sets a field, as a debugger does.
    pub fn set_value(&mut self, field: FieldPlace, value: u32) {
        self.registers.set_value(field, value);
    }
}

impl Device for Plain {
    fn reset(&mut self) {
        self.registers.reset();
    }

    fn read(&mut self, offset: u32, _context: &mut Context<'_>) -> u32 {
        self.registers.get(offset)
    }

    fn write(&mut self, offset: u32, value: u32, _context: &mut Context<'_>) {
        let lasts = self.lasting.contains(&offset);
        let kept = if lasts { self.registers.get(offset) } else { 0 };
        self.registers.set(offset, value | kept);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::DeviceBench;

    #[test]
    fn only_a_reset_clears_what_lasts() {
        let new = |block| Plain::new(block).with_lasting(&["CFGR2"]);
        let mut bench = DeviceBench::new("SYSCFG", new);
        bench.write("CFGR2", 0b101);
        bench.write("CFGR2", 0);
        bench.write("MEMRMP", 1);
        bench.write("MEMRMP", 0);
        assert_eq!([bench.read("CFGR2"), bench.read("MEMRMP")], [0b101, 0]);
        bench.device.reset();
        assert_eq!(bench.read("CFGR2"), 0);
    }
}
