//! What an ELF file holds of an image: its code, its constants and the linker's symbols.

use super::error::ImageBudgetError;
use object::elf::{SHF_ALLOC, SHF_EXECINSTR};
use object::read::elf::{ElfFile32, ElfSection32, ElfSymbol32};
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags, SectionIndex, SymbolKind};
use std::collections::BTreeMap;
use std::ops::Range;

/// The section that only the core reads.
const VECTOR_TABLE: &str = ".vector_table";

/// An image's ELF file.
pub(super) struct ElfFile<'a> {
    pub(super) file: ElfFile32<'a>,
}

/// Bytes of the image at their address on the board.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    /// Address of the first.
    pub(super) address: u32,
    /// The bytes.
    pub(super) bytes: &'a [u8],
}

/// The symbols of one function.
#[derive(Clone, Default)]
pub(super) struct FunctionSymbols<'a> {
    /// Its names as the linker knows them.
    pub(super) names: Vec<&'a str>,
    /// How many bytes it has; zero if the file does not give it.
    pub(super) size: u32,
}

/// Where a stretch of instructions or of data begins within code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Mapping {
    /// Where it begins.
    pub(super) address: u32,
    /// Whether it holds instructions.
    pub(super) code: bool,
}

impl<'a> ElfFile<'a> {
    pub(super) fn parse(bytes: &'a [u8]) -> Result<Self, ImageBudgetError> {
        let file = ElfFile32::parse(bytes)?;
        Ok(Self { file })
    }

    /// The value of a symbol that a linker script defines.
    pub(super) fn value(&self, name: &str) -> Result<u32, ImageBudgetError> {
        let found = self.file.symbol_by_name(name);
        found
            .map(|symbol| narrow(symbol.address()))
            .ok_or_else(|| ImageBudgetError::NoSymbol(name.into()))
    }

    /// The stretches of code.
    pub(super) fn code(&self) -> Result<Vec<Bytes<'a>>, ImageBudgetError> {
        self.sections(|section| has(section, SHF_EXECINSTR))
    }

    /// The constants and what static variables begin with; the vector table is none of them.
    pub(super) fn constants(&self) -> Result<Vec<Bytes<'a>>, ImageBudgetError> {
        self.sections(|section| !has(section, SHF_EXECINSTR) && !is_vector_table(section))
    }

    /// The vector table; empty if the image has none.
    pub(super) fn vector_table(&self) -> Result<Vec<u32>, ImageBudgetError> {
        let sections = self.sections(is_vector_table)?;
        Ok(sections.iter().flat_map(Bytes::words).collect())
    }

    /// The functions' symbols by address, those without a size too.
    pub(super) fn functions(&self) -> BTreeMap<u32, FunctionSymbols<'a>> {
        let mut functions = BTreeMap::<u32, FunctionSymbols<'a>>::new();
        let symbols = self.code_symbols();
        for (name, symbol) in symbols.filter(|(_, symbol)| symbol.kind() == SymbolKind::Text) {
            // The lowest bit says that the code is Thumb.
            let address = narrow(symbol.address()) & !1;
            let function = functions.entry(address).or_default();
            function.names.push(name);
            function.size = function.size.max(narrow(symbol.size()));
        }
        functions
    }

    /// Where instructions and data take turns within code, by address.
    pub(super) fn mappings(&self) -> Vec<Mapping> {
        let mut found: Vec<Mapping> = self
            .code_symbols()
            .filter(|(name, _)| name.starts_with("$t") || name.starts_with("$d"))
            .map(|(name, symbol)| Mapping {
                address: narrow(symbol.address()),
                code: name.starts_with("$t"),
            })
            .collect();
        found.sort_unstable();
        found
    }

    /// The symbols that lie in code, by their names.
    fn code_symbols(&self) -> impl Iterator<Item = (&'a str, ElfSymbol32<'a, '_>)> {
        let sections = self.file.sections();
        let code: Vec<SectionIndex> = sections
            .filter(|section| has(section, SHF_EXECINSTR))
            .map(|section| section.index())
            .collect();
        let symbols = self.file.symbols();
        symbols
            .filter(move |symbol| {
                symbol
                    .section_index()
                    .is_some_and(|index| code.contains(&index))
            })
            .filter_map(|symbol| Some((symbol.name().ok()?, symbol)))
    }

    fn sections(
        &self,
        wanted: impl Fn(&ElfSection32<'a, '_>) -> bool,
    ) -> Result<Vec<Bytes<'a>>, ImageBudgetError> {
        let loaded = self.file.sections();
        loaded
            .filter(|section| has(section, SHF_ALLOC) && wanted(section))
            .map(|section| {
                Ok(Bytes {
                    address: narrow(section.address()),
                    bytes: section.data()?,
                })
            })
            .collect()
    }
}

impl<'a> Bytes<'a> {
    /// Those at the addresses of a range.
    pub(super) fn part(&self, range: &Range<u32>) -> Self {
        let index = |address: u32| address.saturating_sub(self.address) as usize;
        let part = index(range.start)..index(range.end);
        Self {
            address: range.start,
            bytes: self.bytes.get(part).unwrap_or_default(),
        }
    }

    /// The words at addresses that are multiples of four.
    pub(super) fn words(&self) -> impl Iterator<Item = u32> + use<'a> {
        let ahead = self.address.next_multiple_of(4) - self.address;
        let aligned = self.bytes.get(ahead as usize..).unwrap_or_default();
        let whole = aligned.chunks_exact(4);
        whole.filter_map(|word| Some(u32::from_le_bytes(word.try_into().ok()?)))
    }
}

fn has(section: &ElfSection32<'_, '_>, flag: u32) -> bool {
    match section.flags() {
        SectionFlags::Elf { sh_flags } => sh_flags & u64::from(flag) != 0,
        _ => false,
    }
}

fn is_vector_table(section: &ElfSection32<'_, '_>) -> bool {
    section.name() == Ok(VECTOR_TABLE)
}

/// An address of a 32-bit machine.
fn narrow(address: u64) -> u32 {
    u32::try_from(address).unwrap_or(u32::MAX)
}
