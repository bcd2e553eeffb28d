//! All functions of an image, and which of them can be called by address.

use super::elf_file::{Bytes, ElfFile};
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
        let mut program = Self::default();
        let (symbols, mappings) = (elf.functions(), elf.mappings());
        for section in elf.code()? {
            let end = section
                .address
                .saturating_add(u32::try_from(section.bytes.len()).unwrap_or(u32::MAX));
            for (&address, function) in symbols.range(section.address..end) {
                let next = symbols.range(address + 1..end).next();
                let limit = next.map_or(end, |(next, _)| *next);
                let range = address..function_end(address, function.size, limit);
                let names = readable(&function.names);
                let read = Function::read(names, range, &section, &mappings)?;
                program.functions.insert(address, read);
            }
        }
        for (address, function) in symbols {
            let names = function.names.into_iter();
            program
                .names
                .extend(names.map(|name| (name.into(), address)));
        }
        program.taken = program.taken_addresses(&elf.constants()?);
        program.check_targets()?;
        Ok(program)
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
            let mut targets = function.leads_to.iter();
            if let Some(to) = targets.find(|to| self.function_at(**to).is_none()) {
                let name = function.name().into();
                return Err(ImageBudgetError::NoFunction(name, Address(*to)));
            }
        }
        Ok(())
    }
}

/// Where a function ends: by its size, else where the next one begins.
///
/// Code in hand-written assembly may have a symbol within another function; such a function ends there and goes on with
/// the other.
fn function_end(address: u32, size: u32, limit: u32) -> u32 {
    match size {
        0 => limit,
        _ => address.saturating_add(size).min(limit),
    }
}

/// A function's names without the compiler's hash, the shortest first.
fn readable(names: &[&str]) -> Vec<String> {
    let readable = |name: &&str| format!("{:#}", rustc_demangle::demangle(name));
    let mut names: Vec<String> = names.iter().map(readable).collect();
    names.sort_by(|a, b| (a.len(), a).cmp(&(b.len(), b)));
    names
}
