//! What an image takes of the board's memories.

use super::elf_file::ElfFile;
use super::error::{Address, ImageBudgetError};
use object::Endianness;
use object::elf::{PT_LOAD, ProgramHeader32};
use object::read::elf::ProgramHeader;
use serde::Serialize;
use std::ops::Range;

/// What is used of a memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MemoryUsage {
    /// Bytes that are used, gaps between them included.
    pub used: u32,
    /// Bytes that there are.
    pub size: u32,
}

/// The board's memories, whose sizes the image has from memory.x.
pub(super) struct Memories {
    flash: Range<u32>,
    ram: Range<u32>,
    /// RAM that holds code and nothing else, where the linker script has some: it is bounded there.
    code: Option<Range<u32>>,
}

impl Memories {
    pub(super) fn read(elf: &ElfFile<'_>) -> Result<Self, ImageBudgetError> {
        Ok(Self {
            flash: elf.value("_flash_start")?..elf.value("_flash_end")?,
            ram: elf.value("_ram_start")?..elf.value("_ram_end")?,
            code: code(elf),
        })
    }

    /// Flash: code, constants, and what static variables begin with.
    pub(super) fn flash(&self, elf: &ElfFile<'_>) -> Result<MemoryUsage, ImageBudgetError> {
        let stored = segments(elf).map(|segment| {
            let start = segment.p_paddr(Endianness::Little);
            start..start.saturating_add(segment.p_filesz(Endianness::Little))
        });
        usage(&self.flash, stored.filter(|part| !part.is_empty()))
    }

    /// RAM: static variables, without the stack.
    pub(super) fn ram(&self, elf: &ElfFile<'_>) -> Result<MemoryUsage, ImageBudgetError> {
        let live = segments(elf).map(|segment| {
            let start = segment.p_vaddr(Endianness::Little);
            start..start.saturating_add(segment.p_memsz(Endianness::Little))
        });
        let elsewhere = |part: &Range<u32>| {
            let mut memories = [&self.flash].into_iter().chain(&self.code);
            memories.any(|memory| holds(memory, part))
        };
        usage(&self.ram, live.filter(|part| !elsewhere(part)))
    }
}

/// The RAM for code, of an image that has some.
fn code(elf: &ElfFile<'_>) -> Option<Range<u32>> {
    Some(elf.value("_code_ram_start").ok()?..elf.value("_code_ram_end").ok()?)
}

/// Bytes that the linker script leaves to the stack.
pub(super) fn stack_size(elf: &ElfFile<'_>) -> Result<u32, ImageBudgetError> {
    let (lowest, start) = (elf.value("_stack_end")?, elf.value("_stack_start")?);
    Ok(start.saturating_sub(lowest))
}

fn segments<'a>(elf: &ElfFile<'a>) -> impl Iterator<Item = &'a ProgramHeader32<Endianness>> {
    let headers = elf.file.elf_program_headers().iter();
    headers.filter(|header| {
        header.p_type(Endianness::Little) == PT_LOAD && header.p_memsz(Endianness::Little) > 0
    })
}

fn holds(memory: &Range<u32>, part: &Range<u32>) -> bool {
    memory.start <= part.start && part.end <= memory.end
}

/// What parts take of a memory, up to the end of the last one.
fn usage(
    memory: &Range<u32>,
    parts: impl Iterator<Item = Range<u32>>,
) -> Result<MemoryUsage, ImageBudgetError> {
    let mut end = memory.start;
    for part in parts {
        if !holds(memory, &part) {
            return Err(ImageBudgetError::OutOfMemories(Address(part.start)));
        }
        end = end.max(part.end);
    }
    Ok(MemoryUsage {
        used: end - memory.start,
        size: memory.end - memory.start,
    })
}
