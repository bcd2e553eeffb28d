//! An image for the chip: its bytes and its names, from the ELF file that is flashed.

use crate::memory_map::{FLASH, RAM};
use object::{Architecture, Object, ObjectSegment, ObjectSymbol, SymbolKind};
use std::collections::BTreeMap;
use std::ops::Range;
use thiserror::Error;

/// Why a file is no image for this chip.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum ChipImageError {
    /// It is no ELF file.
    #[error("the image is no ELF file ({0}); build it with `cargo image-stm32g474`")]
    NotElf(String),
    /// It is for another processor.
    #[error("the image is for {0}, not for a 32-bit Arm; build it with `cargo image-stm32g474`")]
    OtherProcessor(String),
    /// Something of it lies where the chip has no flash.
    #[error(
        "the image has {size} bytes at {address:#010x}, where the chip has no flash ({:#010x} to {:#010x})",
        FLASH.start, FLASH.end
    )]
    Outside {
        /// Where.
        address: u32,
        /// How many.
        size: usize,
    },
    /// There is nothing at the place of the vector table, or it makes no sense.
    #[error(
        "the image's vector table gives stack {stack:#010x} and start {start:#010x}: it is linked for another chip"
    )]
    NoVectorTable {
        /// First word.
        stack: u32,
        /// Second word.
        start: u32,
    },
    /// Its functions have no names.
    #[error("the image has no symbols; flash it as it is built, without stripping it")]
    NoSymbols,
}

/// An image.
#[derive(Clone, Debug)]
pub struct Image {
    /// The flash's bytes from its start on.
    pub flash: Vec<u8>,
    /// Start and readable name of each function, by address.
    functions: BTreeMap<u32, (u32, String)>,
    /// The static variables, by their readable names.
    variables: BTreeMap<String, u32>,
    /// All symbols by the linker's names.
    symbols: BTreeMap<String, u32>,
}

impl Image {
    /// Reads an ELF file.
    ///
    /// # Errors
    /// [`ChipImageError`] for a file that is no image of this chip.
    pub fn parse(elf: &[u8]) -> Result<Self, ChipImageError> {
        let file = object::File::parse(elf).map_err(|e| ChipImageError::NotElf(e.to_string()))?;
        if file.architecture() != Architecture::Arm {
            return Err(ChipImageError::OtherProcessor(format!(
                "{:?}",
                file.architecture()
            )));
        }
        let mut image = Self {
            flash: flash_bytes(&loads(elf)?)?,
            functions: BTreeMap::new(),
            variables: BTreeMap::new(),
            symbols: BTreeMap::new(),
        };
        image.check_vectors()?;
        image.read_symbols(&file);
        if image.functions.is_empty() {
            return Err(ChipImageError::NoSymbols);
        }
        Ok(image)
    }

    /// The flash's bytes alone.
    #[cfg(test)]
    pub fn unnamed(flash: Vec<u8>) -> Self {
        Self {
            flash,
            functions: BTreeMap::new(),
            variables: BTreeMap::new(),
            symbols: BTreeMap::new(),
        }
    }

    fn read_symbols(&mut self, file: &object::File<'_>) {
        for symbol in file.symbols() {
            let (Ok(name), Ok(address)) = (symbol.name(), u32::try_from(symbol.address())) else {
                continue;
            };
            let readable = format!("{:#}", rustc_demangle::demangle(name));
            if symbol.kind() == SymbolKind::Data {
                // The compiler numbers a variable that it has changed.
                let name = readable.trim_end_matches(".0").to_owned();
                self.variables.insert(name, address);
            }
            if symbol.kind() == SymbolKind::Text {
                let size = u32::try_from(symbol.size()).unwrap_or(u32::MAX);
                self.functions.insert(address & !1, (size, readable));
            }
            self.symbols.insert(name.to_owned(), address);
        }
    }

    fn check_vectors(&self) -> Result<(), ChipImageError> {
        let word = |at: usize| match self.flash.get(at..at + 4) {
            Some(&[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]),
            _ => 0,
        };
        let (stack, start) = (word(0), word(4));
        let stack_fits = stack > RAM.start && stack <= RAM.end;
        if stack_fits && FLASH.contains(&start) && start & 1 == 1 {
            Ok(())
        } else {
            Err(ChipImageError::NoVectorTable { stack, start })
        }
    }

    /// Where the program is in the flash.
    #[must_use]
    pub fn program(&self) -> Range<u32> {
        let length = self.flash.iter().rposition(|byte| *byte != 0xff);
        FLASH.start..FLASH.start + length.map_or(0, |last| last as u32 + 1)
    }

    /// The value of a symbol, by the linker's name.
    #[must_use]
    pub fn symbol(&self, name: &str) -> Option<u32> {
        self.symbols.get(name).copied()
    }

    /// The readable name of the function that an address is in.
    #[must_use]
    pub fn function_at(&self, address: u32) -> Option<&str> {
        let (start, (size, name)) = self.functions.range(..=address).next_back()?;
        // Functions of assembly have no size.
        (*size == 0 || address - start < *size).then_some(name)
    }

    /// The address of a static variable, by its readable name.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<u32> {
        self.variables.get(name).copied()
    }

    /// The starts of the functions whose readable name ends so.
    #[must_use]
    pub fn functions_ending(&self, end: &str) -> Vec<u32> {
        let found = self.functions.iter().filter(|(_, f)| f.1.ends_with(end));
        found.map(|(start, _)| *start).collect()
    }
}

/// What is loaded where: an image's initial data lie elsewhere in the flash than they are used.
fn loads(elf: &[u8]) -> Result<Vec<(u32, Vec<u8>)>, ChipImageError> {
    use object::read::elf::{ElfFile32, ProgramHeader};
    let refused = |error: object::Error| ChipImageError::NotElf(error.to_string());
    let file: ElfFile32<'_> = ElfFile32::parse(elf).map_err(refused)?;
    let endian = file.endian();
    let mut loads = Vec::new();
    for segment in file.segments() {
        let header = segment.elf_program_header();
        if header.p_filesz(endian) > 0 {
            let bytes = segment.data().map_err(refused)?;
            loads.push((header.p_paddr(endian), bytes.to_vec()));
        }
    }
    Ok(loads)
}

fn flash_bytes(loads: &[(u32, Vec<u8>)]) -> Result<Vec<u8>, ChipImageError> {
    let mut flash = vec![0xff; FLASH.len()];
    for (address, bytes) in loads {
        let outside = ChipImageError::Outside {
            address: *address,
            size: bytes.len(),
        };
        let start = address.checked_sub(FLASH.start);
        let place = start.and_then(|start| {
            let start = start as usize;
            flash.get_mut(start..start.checked_add(bytes.len())?)
        });
        place.ok_or(outside)?.copy_from_slice(bytes);
    }
    Ok(flash)
}
