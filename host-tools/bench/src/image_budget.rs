//! What a firmware image needs of flash, RAM and stack, and whether a panic can be reached, from its ELF file alone.
//!
//! The stack is an upper bound: every function's instructions that take stack are added up, whichever of them run; the
//! deepest chain of calls counts; and all handlers stand on top of each other. What the bound rests on besides the code
//! is declared: what calls by address reach and how deep they nest (`indirect.rs`), and how many panics stand on one
//! stack (`call_graph.rs`). Stack that foreign code takes in ways that this does not see is an error, not a gap.
//!
//! A panic is found by the names of the functions that begin one. Faults of the core, `udf` and endless loops are none.

mod budget;
mod call_graph;
mod elf_file;
mod error;
mod function;
mod indirect;
mod memory;
mod program;
mod task;
#[cfg(test)]
mod tests;
mod thumb;
mod vector_table;

pub use budget::{BudgetCheck, ByteBounds, ImageBudget, checks};
pub use error::{Address, ImageBudgetError};
pub use memory::MemoryUsage;
pub use task::Task;
pub use vector_table::RootKind;

use call_graph::{CallGraph, LOGS, PANICS};
use elf_file::ElfFile;
use memory::Memories;
use program::Program;
use serde::Serialize;
use vector_table::VectorEntry;

/// Bytes that the core puts on the stack when an exception begins: 26 words where the floating-point unit is in use,
/// and one to align them.
pub const EXCEPTION_ENTRY: u32 = 27 * 4;

/// What an image needs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ImageNeeds {
    /// Flash, against what memory.x gives.
    pub flash: MemoryUsage,
    /// RAM for static variables, against what memory.x gives.
    pub ram: MemoryUsage,
    /// Stack with all roots on top of each other, against the RAM that static variables leave.
    pub stack: MemoryUsage,
    /// Where execution can begin.
    pub roots: Vec<Root>,
    /// The tasks, whose stack is part of that of the root whose executor polls them.
    pub tasks: Vec<Task>,
}

/// Where execution can begin, and what it needs from there on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Root {
    /// The handler's or function's name.
    pub name: String,
    /// What begins here.
    pub kind: RootKind,
    /// The most stack that it takes, bytes, without what the core adds when an exception begins.
    pub stack_bytes: u32,
    /// The functions whose frames that stack holds, the root first.
    pub deepest: Vec<String>,
    /// The shortest path to a panic, the root first, if there is one.
    pub panic: Option<Vec<String>>,
    /// The shortest path to a line in the log, the root first, if there is one.
    pub log: Option<Vec<String>>,
    /// The functions within reach that call by address.
    pub indirect: Vec<IndirectCaller>,
}

/// A function that calls by address.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct IndirectCaller {
    /// Its name.
    pub function: String,
    /// Such calls among its instructions.
    pub calls: usize,
    /// Whether what they reach is declared; else it is every function whose address is taken.
    pub declared: bool,
}

/// What an image with a vector table and the symbols of memory.x needs; `elf` are the bytes of its ELF file.
///
/// # Errors
/// [`ImageBudgetError`] for a file that cannot be read and for stack that has no known bound.
pub fn needs(elf: &[u8]) -> Result<ImageNeeds, ImageBudgetError> {
    let elf = ElfFile::parse(elf)?;
    let program = Program::read(&elf)?;
    let graph = CallGraph::new(&program)?;
    let entries = vector_table::entries(&elf.vector_table()?, &program)?;
    let roots: Result<Vec<Root>, _> = entries
        .into_iter()
        .map(|entry| Root::new(entry, &graph))
        .collect();
    let roots = roots?;
    let memories = Memories::read(&elf)?;
    Ok(ImageNeeds {
        flash: memories.flash(&elf)?,
        ram: memories.ram(&elf)?,
        stack: MemoryUsage {
            used: nested_stack(&roots),
            size: memory::stack_size(&elf)?,
        },
        tasks: task::tasks(&program, &graph)?,
        roots,
    })
}

/// What one function of an image needs, by the name that the linker has for it; a vector table is not needed.
///
/// # Errors
/// [`ImageBudgetError::NoRoot`] if there is no such function or it is the handler of all that have none, and those of
/// [`needs`].
pub fn root(elf: &[u8], name: &str) -> Result<Root, ImageBudgetError> {
    let elf = ElfFile::parse(elf)?;
    let program = Program::read(&elf)?;
    let entry = vector_table::named(name, &elf.vector_table()?, &program)?;
    Root::new(entry, &CallGraph::new(&program)?)
}

impl Root {
    fn new(entry: VectorEntry, graph: &CallGraph<'_>) -> Result<Self, ImageBudgetError> {
        let stack = graph.stack(entry.address)?;
        let callers = graph.indirect_callers(entry.address).into_iter();
        // The root's function may be another handler's, too, and have that one's name.
        let renamed = |path: Vec<String>| {
            let rest = path.into_iter().skip(1);
            [entry.name.clone()].into_iter().chain(rest).collect()
        };
        Ok(Self {
            name: entry.name.clone(),
            kind: entry.kind,
            stack_bytes: stack.bytes,
            deepest: renamed(stack.functions),
            panic: graph.shortest_path(&PANICS, entry.address).map(renamed),
            log: graph.shortest_path(&LOGS, entry.address).map(renamed),
            indirect: callers
                .map(|function| IndirectCaller {
                    function: function.name().into(),
                    calls: function.indirect_calls,
                    declared: indirect::is_declared(function),
                })
                .collect(),
        })
    }

    /// The most stack that it takes with what the core adds, bytes.
    #[must_use]
    pub fn stack_with_entry(&self) -> u32 {
        match self.kind {
            RootKind::Thread => self.stack_bytes,
            RootKind::Exception | RootKind::Interrupt => self.stack_bytes + EXCEPTION_ENTRY,
        }
    }
}

/// Each handler interrupts the one before: priorities, which allow less, are set as the image runs.
fn nested_stack(roots: &[Root]) -> u32 {
    roots.iter().map(Root::stack_with_entry).sum()
}
