//! Where execution can begin: after a reset, and by each exception that has a handler of its own.

use super::error::{Address, ImageBudgetError};
use super::function::Function;
use super::program::Program;
use serde::Serialize;

/// The handler of all exceptions that have none of their own.
const DEFAULT_HANDLER: &str = "DefaultHandler";

/// Number of the reset among the exceptions.
const RESET: usize = 1;

/// Number of the first interrupt among the exceptions.
const FIRST_INTERRUPT: usize = 16;

/// What begins at a root.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RootKind {
    /// What runs while no exception does: from the reset on.
    Thread,
    /// An exception of the core, and the handler for all that have none.
    Exception,
    /// An interrupt of a device.
    Interrupt,
}

/// Where execution can begin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct VectorEntry {
    pub(super) name: String,
    pub(super) kind: RootKind,
    /// Where its code begins.
    pub(super) address: u32,
}

/// The entries of a vector table, each handler once.
pub(super) fn entries(
    table: &[u32],
    program: &Program,
) -> Result<Vec<VectorEntry>, ImageBudgetError> {
    let default = program.names.get(DEFAULT_HANDLER).copied();
    let mut found: Vec<VectorEntry> = Vec::new();
    // The first word is where the stack begins; a zero is a number that the core does not use.
    let numbered = table.iter().enumerate().skip(RESET);
    for (number, vector) in numbered.filter(|(_, vector)| **vector != 0) {
        let address = vector & !1;
        let Some(function) = program.functions.get(&address) else {
            return Err(ImageBudgetError::Vector(number, Address(*vector)));
        };
        if !found.iter().any(|entry| entry.address == address) {
            found.push(entry(number, function, default == Some(address)));
        }
    }
    Ok(found)
}

/// The function of a name, as what the vector table makes it.
pub(super) fn named(
    name: &str,
    table: &[u32],
    program: &Program,
) -> Result<VectorEntry, ImageBudgetError> {
    let no_root = || ImageBudgetError::NoRoot(name.into());
    let address = *program.names.get(name).ok_or_else(no_root)?;
    let function = program.functions.get(&address).ok_or_else(no_root)?;
    let mut entries = entries(table, program)?.into_iter();
    match entries.find(|entry| entry.address == address) {
        // The name of an exception without a handler is another name of the default one.
        Some(entry) if entry.name == DEFAULT_HANDLER && name != DEFAULT_HANDLER => Err(no_root()),
        Some(entry) => Ok(VectorEntry {
            name: name.into(),
            ..entry
        }),
        None => Ok(VectorEntry {
            name: name.into(),
            ..entry(RESET, function, false)
        }),
    }
}

fn entry(number: usize, function: &Function, is_default: bool) -> VectorEntry {
    let name = if is_default {
        DEFAULT_HANDLER
    } else {
        function.name()
    };
    let kind = match number {
        RESET => RootKind::Thread,
        FIRST_INTERRUPT.. if !is_default => RootKind::Interrupt,
        _ => RootKind::Exception,
    };
    VectorEntry {
        name: name.into(),
        kind,
        address: function.range.start,
    }
}
