//! The registers as ST's own description has them, in the crate `stm32g4`.

/// A peripheral's registers.
pub struct DescribedBlock {
    pub name: &'static str,
    pub base: u32,
    /// In the order of their offsets; several of one offset where a register has several views.
    pub registers: &'static [DescribedRegister],
}

/// A register, or a view of it.
pub struct DescribedRegister {
    pub name: &'static str,
    pub offset: u32,
    pub reset: u32,
    pub read: bool,
    pub write: bool,
    /// Names and masks.
    pub fields: &'static [(&'static str, u32)],
}

include!(concat!(env!("OUT_DIR"), "/description.rs"));

/// The registers of the block at an address; none where it is not described.
pub fn registers(base: u32) -> &'static [DescribedRegister] {
    // What is described as `FDCAN` lies where the message memory is.
    let mut known = BLOCKS.iter().filter(|block| block.name != "FDCAN");
    known
        .find(|block| block.base == base)
        .map_or(&[], |block| block.registers)
}
