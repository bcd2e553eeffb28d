//! All functions of an image, and which of them can be called by address.

use super::elf_file::{Bytes, CodeSymbol, ElfFile, Mapping};
use super::error::{Address, ImageBudgetError};
use super::function::Function;
use std::collections::{BTreeMap, BTreeSet};

/// All functions of an image, by the address where each begins.
#[derive(Clone, Debug, Default)]
pub(super) struct Program {
    pub(super) functions: BTreeMap<u32, Function>,
    /// Names that the linker knows, and where they lead.
    pub(super) names: BTreeMap<String, u32>,
    /// Where the functions begin whose address is taken.
    pub(super) taken: BTreeSet<u32>,
}

impl Program {
    pub(super) fn read(elf: &ElfFile<'_>) -> Result<Self, ImageBudgetError> {
        let symbols = elf.functions();
        let names = symbols
            .iter()
            .map(|symbol| (symbol.name.into(), symbol.address));
        let mut program = Self {
            names: names.collect(),
            ..Self::default()
        };
        let mappings = elf.mappings();
        for section in elf.code()? {
            program.read_section(&section, &symbols, &mappings)?;
        }
        program.taken = program.taken_addresses(&elf.constants()?);
        program.check_targets()?;
        Ok(program)
    }

    fn read_section(
        &mut self,
        section: &Bytes<'_>,
        symbols: &[CodeSymbol<'_>],
        mappings: &[Mapping],
    ) -> Result<(), ImageBudgetError> {
        let end = section
            .address
            .saturating_add(u32::try_from(section.bytes.len()).unwrap_or(u32::MAX));
        let within = symbols
            .iter()
            .filter(|symbol| (section.address..end).contains(&symbol.address));
        let mut by_address: BTreeMap<u32, Vec<&CodeSymbol<'_>>> = BTreeMap::new();
        for symbol in within {
            by_address.entry(symbol.address).or_default().push(symbol);
        }
        for (address, aliases) in &by_address {
            let next = by_address.range(address + 1..).next();
            let limit = next.map_or(end, |(next, _)| *next);
            let range = *address..function_end(aliases, limit);
            let function = Function::read(readable(aliases), range, section, mappings)?;
            self.functions.insert(*address, function);
        }
        Ok(())
    }

    /// The function that holds an address.
    pub(super) fn function_at(&self, address: u32) -> Option<&Function> {
        let (_, function) = self.functions.range(..=address).next_back()?;
        function.range.contains(&address).then_some(function)
    }

    /// The functions whose address is a word of any code or constant; in it, the lowest bit says that the code is Thumb.
    fn taken_addresses(&self, constants: &[Bytes<'_>]) -> BTreeSet<u32> {
        let of_code = self
            .functions
            .values()
            .flat_map(|function| function.words.iter().copied());
        let words = constants.iter().flat_map(Bytes::words).chain(of_code);
        words
            .filter(|word| word & 1 == 1)
            .map(|word| word & !1)
            .filter(|address| self.functions.contains_key(address))
            .collect()
    }

    /// A branch to where no function is would end a path unseen.
    fn check_targets(&self) -> Result<(), ImageBudgetError> {
        for function in self.functions.values() {
            for to in &function.leads_to {
                if self.function_at(*to).is_none() {
                    return Err(ImageBudgetError::NoFunction {
                        function: function.name().into(),
                        to: Address(*to),
                    });
                }
            }
        }
        Ok(())
    }
}

/// Where a function ends: by its size, else where the next one begins.
///
/// Code in hand-written assembly may have a symbol within another function; such a function ends there and goes on with
/// the other.
fn function_end(aliases: &[&CodeSymbol<'_>], limit: u32) -> u32 {
    let size = aliases.iter().map(|symbol| symbol.size).max().unwrap_or(0);
    match aliases.first() {
        Some(symbol) if size > 0 => symbol.address.saturating_add(size).min(limit),
        _ => limit,
    }
}

/// A function's names without the compiler's hash, the shortest first.
fn readable(aliases: &[&CodeSymbol<'_>]) -> Vec<String> {
    let names = aliases.iter().map(|symbol| symbol.name);
    let mut names: Vec<String> = names
        .map(|name| format!("{:#}", rustc_demangle::demangle(name)))
        .collect();
    names.sort_by(|a, b| (a.len(), a).cmp(&(b.len(), b)));
    names
}
