//! A function as its instructions show: the stack that it takes, and where it leads.

use super::elf_file::{Bytes, Mapping};
use super::error::{Address, ImageBudgetError};
use super::thumb::{self, Effect, Instruction};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// What the names of the linker's veneers begin with: each makes an address in a register, and branches there.
const VENEER: &str = "__Thumbv7ABSLongThunk_";

/// A function.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Function {
    /// Its names, readable, the shortest first: the linker may have found several functions to be one.
    pub(super) names: Vec<String>,
    /// The addresses of its code.
    pub(super) range: Range<u32>,
    /// Bytes of stack that it takes: the sum of all that its instructions take, whichever of them are run.
    pub(super) frame: u32,
    /// Where it calls and branches to, itself too if it calls itself.
    pub(super) leads_to: BTreeSet<u32>,
    /// How many of its calls and branches go to an address that is only known as it runs.
    pub(super) indirect_calls: usize,
    /// Words among its instructions, and numbers that it makes of two halves: any may be a function's address.
    pub(super) words: BTreeSet<u32>,
}

impl Function {
    /// The shortest of its names.
    pub(super) fn name(&self) -> &str {
        self.names.first().map_or("", String::as_str)
    }

    /// Whether one of its names is one of these texts or, where the text holds a path's `::`, holds it.
    pub(super) fn is_called(&self, texts: &[&str]) -> bool {
        let fits =
            |name: &str, text: &str| name == text || (text.contains("::") && name.contains(text));
        let mut names = self.names.iter();
        names.any(|name| texts.iter().any(|text| fits(name, text)))
    }

    /// Reads the code of `range`.
    pub(super) fn read(
        names: Vec<String>,
        range: Range<u32>,
        section: &Bytes<'_>,
        mappings: &[Mapping],
    ) -> Result<Self, ImageBudgetError> {
        let mut reader = Reader::new(names, range.clone());
        for (stretch, code) in stretches(&range, mappings) {
            let bytes = section_bytes(section, &stretch);
            if code {
                reader.instructions(&bytes)?;
            } else {
                reader.function.words.extend(bytes.words());
            }
        }
        Ok(reader.end())
    }
}

/// The stretches of a range, and whether they hold instructions.
fn stretches<'a>(
    range: &Range<u32>,
    mappings: &'a [Mapping],
) -> impl Iterator<Item = (Range<u32>, bool)> + use<'a> {
    let before = mappings.partition_point(|mapping| mapping.address <= range.start);
    let (start, end) = (range.start, range.end);
    let relevant = mappings.get(before.saturating_sub(1)..).unwrap_or_default();
    let ends = relevant.iter().skip(1).map(|mapping| mapping.address);
    let ends = ends.chain([end]);
    relevant
        .iter()
        .zip(ends)
        .map(move |(mapping, next)| (mapping.address.max(start)..next.min(end), mapping.code))
        .take_while(move |(stretch, _)| stretch.start < end)
        .filter(|(stretch, _)| !stretch.is_empty())
}

/// The bytes of a section within a range.
fn section_bytes<'a>(section: &Bytes<'a>, range: &Range<u32>) -> Bytes<'a> {
    let at = |address: u32| address.saturating_sub(section.address) as usize;
    Bytes {
        address: range.start,
        bytes: section
            .bytes
            .get(at(range.start)..at(range.end))
            .unwrap_or_default(),
    }
}

struct Reader {
    function: Function,
    /// The lower halves that registers were last set to.
    halves: BTreeMap<u32, u32>,
    /// Whether the core goes on behind the last instruction.
    goes_on: bool,
}

impl Reader {
    fn new(names: Vec<String>, range: Range<u32>) -> Self {
        let function = Function {
            names,
            range,
            ..Function::default()
        };
        Self {
            function,
            halves: BTreeMap::new(),
            goes_on: false,
        }
    }

    fn instructions(&mut self, stretch: &Bytes<'_>) -> Result<(), ImageBudgetError> {
        let mut at = stretch.address;
        let mut rest = stretch.bytes;
        while !rest.is_empty() {
            let Some(Instruction { length, effect }) = thumb::decode(rest, at) else {
                return Err(ImageBudgetError::CutOff {
                    function: self.function.name().into(),
                    at: Address(at),
                });
            };
            self.instruction(effect, at)?;
            at = at.wrapping_add(length);
            rest = rest.get(length as usize..).unwrap_or_default();
            if effect != Effect::Filler {
                self.goes_on = !effect.may_end();
            }
        }
        Ok(())
    }

    fn instruction(&mut self, effect: Effect, at: u32) -> Result<(), ImageBudgetError> {
        match effect {
            Effect::Down(bytes) => self.function.frame += bytes,
            Effect::UnknownStack => {
                return Err(ImageBudgetError::UnknownStack {
                    function: self.function.name().into(),
                    at: Address(at),
                });
            }
            Effect::Call(to) => {
                self.function.leads_to.insert(to);
            }
            Effect::Branch(to) | Effect::MayBranch(to) => self.branch(to),
            Effect::BranchRegister if self.function.name().starts_with(VENEER) => self.veneer(),
            Effect::CallRegister | Effect::BranchRegister => self.function.indirect_calls += 1,
            Effect::Low { register, value } => {
                self.halves.insert(register, value);
            }
            Effect::High { register, value } => self.high(register, value),
            Effect::None | Effect::Filler | Effect::Switch | Effect::Return | Effect::Trap => {}
        }
        Ok(())
    }

    /// The address is the one that was made, and is not taken for anything else.
    fn veneer(&mut self) {
        match self.function.words.pop_last() {
            Some(to) => {
                self.function.leads_to.insert(to & !1);
            }
            None => self.function.indirect_calls += 1,
        }
    }

    /// A branch within the function is none of its calls.
    fn branch(&mut self, to: u32) {
        if !self.function.range.contains(&to) {
            self.function.leads_to.insert(to);
        }
    }

    fn high(&mut self, register: u32, value: u32) {
        if let Some(low) = self.halves.get(&register) {
            self.function.words.insert(value << 16 | low);
        }
    }

    /// A function whose last instruction goes on goes on with the next function.
    fn end(mut self) -> Function {
        if self.goes_on {
            self.function.leads_to.insert(self.function.range.end);
        }
        self.function
    }
}
