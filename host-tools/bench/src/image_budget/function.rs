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
        let mut function = Self {
            names,
            range: range.clone(),
            ..Self::default()
        };
        let mut goes_on = false;
        // The lower halves that registers were last set to.
        let mut halves = BTreeMap::new();
        for (stretch, code) in stretches(&range, mappings) {
            let bytes = section.part(&stretch);
            if code {
                goes_on = function
                    .read_instructions(&bytes, &mut halves)?
                    .unwrap_or(goes_on);
            } else {
                function.words.extend(bytes.words());
            }
        }
        // Without a branch or a return at its end, execution continues in the next function.
        if goes_on {
            function.leads_to.insert(range.end);
        }
        Ok(function)
    }

    /// Reads a stretch of instructions, and returns whether the core goes on behind it, if anything there tells.
    fn read_instructions(
        &mut self,
        stretch: &Bytes<'_>,
        halves: &mut BTreeMap<u32, u32>,
    ) -> Result<Option<bool>, ImageBudgetError> {
        let mut goes_on = None;
        let mut at = stretch.address;
        let mut rest = stretch.bytes;
        while !rest.is_empty() {
            let Some(Instruction { length, effect }) = thumb::decode(rest, at) else {
                return Err(ImageBudgetError::CutOff(self.name().into(), Address(at)));
            };
            self.add(effect, at, halves)?;
            if effect != Effect::Filler {
                goes_on = Some(!effect.may_end());
            }
            at = at.wrapping_add(length);
            rest = rest.get(length as usize..).unwrap_or_default();
        }
        Ok(goes_on)
    }

    fn add(
        &mut self,
        effect: Effect,
        at: u32,
        halves: &mut BTreeMap<u32, u32>,
    ) -> Result<(), ImageBudgetError> {
        match effect {
            Effect::Down(bytes) => self.frame += bytes,
            Effect::UnknownStack => {
                let function = self.name().into();
                return Err(ImageBudgetError::UnknownStack(function, Address(at)));
            }
            Effect::Call(to) => self.leads_to.extend([to]),
            // A branch within the function is none of its calls.
            Effect::Branch(to) | Effect::MayBranch(to) => {
                self.leads_to
                    .extend((!self.range.contains(&to)).then_some(to));
            }
            Effect::BranchRegister if self.name().starts_with(VENEER) => self.follow_veneer(),
            Effect::CallRegister | Effect::BranchRegister => self.indirect_calls += 1,
            Effect::Low(register, value) => {
                halves.insert(register, value);
            }
            Effect::High(register, value) => {
                let low = halves.get(&register);
                self.words.extend(low.map(|low| value << 16 | low));
            }
            Effect::Other | Effect::Filler | Effect::Switch | Effect::Return | Effect::Trap => {}
        }
        Ok(())
    }

    /// The address is the one that was made, and is not taken for anything else.
    fn follow_veneer(&mut self) {
        match self.words.pop_last() {
            Some(to) => self.leads_to.extend([to & !1]),
            None => self.indirect_calls += 1,
        }
    }
}

/// The stretches of a range, and whether they hold instructions.
fn stretches(range: &Range<u32>, mappings: &[Mapping]) -> impl Iterator<Item = (Range<u32>, bool)> {
    let ends = mappings.iter().skip(1).map(|mapping| mapping.address);
    let stretches = mappings.iter().zip(ends.chain([range.end]));
    stretches
        .map(|(mapping, end)| {
            let stretch = mapping.address.max(range.start)..end.min(range.end);
            (stretch, mapping.code)
        })
        .filter(|(stretch, _)| !stretch.is_empty())
}
