//! Why an image's needs are not known.

use std::fmt;
use thiserror::Error;

/// An address as it is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address(pub u32);

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#010x}", self.0)
    }
}

/// Why an image's needs are not known. Functions are given by their names.
#[derive(Debug, Error)]
pub enum ImageBudgetError {
    /// The bytes are no ELF file for a 32-bit machine.
    #[error("the image is no ELF file that can be read: {0}")]
    Elf(#[from] object::read::Error),
    /// This symbol, which the linker scripts define, is missing.
    #[error("the image has no symbol `{0}`; link it with cortex-m-rt's script and memory.x")]
    NoSymbol(String),
    /// A part of the image that begins here lies outside the memories of memory.x.
    #[error("the image has bytes at {0}, outside the memories of memory.x")]
    OutOfMemories(Address),
    /// The entry of this exception in the vector table leads to an address without code.
    #[error("entry {0} of the vector table leads to {1}, where no function begins")]
    Vector(usize, Address),
    /// No function and no handler has this name of a root.
    #[error("the image has no function `{0}` of its own; a handler may still be the default one")]
    NoRoot(String),
    /// The budget names other tasks than there are.
    #[error("the image has the tasks {found}; the budget in image_budget/budget.rs has {budgeted}")]
    OtherTasks {
        /// Those of the image.
        found: String,
        /// Those of the budget.
        budgeted: String,
    },
    /// An instruction of a function sets the stack pointer to what its code does not show.
    #[error("{0} sets the stack pointer to an unknown place at {1}")]
    UnknownStack(String, Address),
    /// A function's code ends within an instruction.
    #[error("{0} ends within the instruction at {1}")]
    CutOff(String, Address),
    /// A function leads to an address without code.
    #[error("{0} leads to {1}, where there is no function")]
    NoFunction(String, Address),
    /// Functions, each calling the next and the last one the first: no bound on their stack is known.
    #[error(
        "a recursion has no bound on its stack: {}; for an indirect call in it, say in image_budget/indirect.rs what it can reach",
        .0.join(" > ")
    )]
    Recursion(Vec<String>),
    /// What is declared of a function's indirect calls matches nothing.
    #[error(
        "{function} makes indirect calls to {declared}, of which the image has no function whose address is taken; look into image_budget/indirect.rs"
    )]
    NoTarget {
        /// The function that calls.
        function: String,
        /// The declared targets.
        declared: String,
    },
    /// A function makes more indirect calls than are declared.
    #[error(
        "{function} makes {found} indirect calls, {declared} are declared; look into image_budget/indirect.rs"
    )]
    MoreCalls {
        /// The function that calls.
        function: String,
        /// Its indirect calls.
        found: usize,
        /// Those that are declared.
        declared: usize,
    },
}
