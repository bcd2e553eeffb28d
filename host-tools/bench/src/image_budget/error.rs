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

/// Why an image's needs are not known.
#[derive(Debug, Error)]
pub enum ImageBudgetError {
    /// The bytes are no ELF file for a 32-bit machine.
    #[error("the image is no ELF file that can be read: {0}")]
    Elf(#[from] object::read::Error),
    /// A symbol that the linker scripts define is missing.
    #[error("the image has no symbol `{name}`; link it with cortex-m-rt's script and memory.x")]
    NoSymbol {
        /// The symbol.
        name: String,
    },
    /// A part of the image lies outside the memories of memory.x.
    #[error("the image has bytes at {at}, outside the memories of memory.x")]
    Outside {
        /// Where the part begins.
        at: Address,
    },
    /// The image's vector table leads to an address without code.
    #[error("entry {number} of the vector table leads to {at}, where no function begins")]
    Vector {
        /// Number of the exception.
        number: usize,
        /// Where it leads.
        at: Address,
    },
    /// No function and no handler has the name of the root.
    #[error(
        "the image has no function `{name}` of its own; a handler may still be the default one"
    )]
    NoRoot {
        /// What was asked for.
        name: String,
    },
    /// The budget names other tasks than there are.
    #[error("the image has the tasks {found}; the budget in image_budget/budget.rs has {budgeted}")]
    OtherTasks {
        /// Those of the image.
        found: String,
        /// Those of the budget.
        budgeted: String,
    },
    /// A function sets the stack pointer to what its code does not show.
    #[error("{function} sets the stack pointer to an unknown place at {at}")]
    UnknownStack {
        /// The function.
        function: String,
        /// The instruction.
        at: Address,
    },
    /// A function's code ends within an instruction.
    #[error("{function} ends within the instruction at {at}")]
    CutOff {
        /// The function.
        function: String,
        /// The instruction.
        at: Address,
    },
    /// A function leads to an address without code.
    #[error("{function} leads to {to}, where there is no function")]
    NoFunction {
        /// The function that branches.
        function: String,
        /// Where it leads.
        to: Address,
    },
    /// Functions call each other in a circle, so that no bound on their stack is known.
    #[error(
        "a recursion has no bound on its stack: {}; for an indirect call in it, say in image_budget/indirect.rs what it can reach",
        .circle.join(" > ")
    )]
    Recursion {
        /// The functions, each calling the next and the last one the first.
        circle: Vec<String>,
    },
    /// A declaration of what indirect calls reach matches nothing.
    #[error(
        "{function} makes indirect calls to {declared}, of which the image has no function whose address is taken; look into image_budget/indirect.rs"
    )]
    NoTarget {
        /// The function that calls.
        function: String,
        /// What is declared.
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
