//! Who calls whom, how deep the stack gets by it, and whether a panic can be reached.

use super::error::ImageBudgetError;
use super::function::Function;
use super::indirect::{self, NESTED};
use super::program::Program;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, VecDeque};

/// Names of functions that begin a line in the log, or parts of them.
pub(super) const LOGS: [&str; 2] = ["defmt::export::", "_defmt_acquire"];

/// Names of functions that begin a panic, or parts of them.
pub(super) const PANICS: [&str; 3] = ["core::panicking::", PANIC_HANDLER, "_defmt_panic"];

/// What every panic ends in.
const PANIC_HANDLER: &str = "::rust_begin_unwind";

/// How many panics stand on one stack at most: a handler logs the first and stops at one that the log raises.
const PANICS_ON_A_STACK: usize = 2;

/// A call from one function to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Edge {
    to: u32,
    kind: CallKind,
}

/// What a call counts towards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CallKind {
    /// Nothing: it stands on a stack once, else it is a recursion.
    Once,
    /// [`NESTED`].
    Nested,
    /// [`PANICS_ON_A_STACK`].
    Panic,
}

/// Who calls whom.
pub(super) struct CallGraph<'a> {
    program: &'a Program,
    edges: BTreeMap<u32, Vec<Edge>>,
}

/// Bytes of the deepest stack below a function, itself included, and what comes next on it.
type Depth = (u32, Option<StackFrame>);

fn calls(function: &Function, program: &Program) -> Result<Vec<Edge>, ImageBudgetError> {
    let direct = function
        .leads_to
        .iter()
        .filter_map(|to| program.function_at(*to));
    let direct = direct.map(|called| Edge {
        to: called.range.start,
        kind: if called.is_called(&[PANIC_HANDLER]) {
            CallKind::Panic
        } else {
            CallKind::Once
        },
    });
    let (targets, nested) = indirect::reach(function, program)?;
    let kind = if nested {
        CallKind::Nested
    } else {
        CallKind::Once
    };
    let indirect = targets.into_iter().map(|to| Edge { to, kind });
    Ok(direct.chain(indirect).collect())
}

/// A function on a stack, and how many counted calls may still stand above it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct StackFrame {
    function: u32,
    nested: usize,
    panics: usize,
}

impl StackFrame {
    /// What a call leads to; nothing if it is counted and there are enough of its kind.
    fn call(self, edge: &Edge) -> Option<Self> {
        let (nested, panics) = match edge.kind {
            CallKind::Once => (self.nested, self.panics),
            CallKind::Nested => (self.nested.checked_sub(1)?, self.panics),
            CallKind::Panic => (self.nested, self.panics.checked_sub(1)?),
        };
        Some(Self {
            function: edge.to,
            nested,
            panics,
        })
    }
}

/// A stack and the functions whose frames it holds, the root first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Stack {
    pub(super) bytes: u32,
    pub(super) functions: Vec<String>,
}

impl<'a> CallGraph<'a> {
    pub(super) fn new(program: &'a Program) -> Result<Self, ImageBudgetError> {
        let functions = program.functions.iter();
        let edges: Result<_, ImageBudgetError> = functions
            .map(|(address, function)| Ok((*address, calls(function, program)?)))
            .collect();
        Ok(Self {
            program,
            edges: edges?,
        })
    }

    fn edges(&self, from: u32) -> &[Edge] {
        self.edges.get(&from).map_or(&[], Vec::as_slice)
    }

    fn function(&self, address: u32) -> Option<&'a Function> {
        self.program.functions.get(&address)
    }

    fn name(&self, address: u32) -> String {
        self.function(address)
            .map_or_else(String::new, |function| function.name().into())
    }

    /// The deepest stack below a root.
    pub(super) fn stack(&self, root: u32) -> Result<Stack, ImageBudgetError> {
        let mut depths = BTreeMap::new();
        let start = StackFrame {
            function: root,
            nested: NESTED,
            panics: PANICS_ON_A_STACK,
        };
        let (bytes, _) = self.depth(start, &mut depths, &mut Vec::new())?;
        let next = |frame: &StackFrame| depths.get(frame).and_then(|(_, next)| *next);
        let frames = std::iter::successors(Some(start), next);
        Ok(Stack {
            bytes,
            functions: frames.map(|frame| self.name(frame.function)).collect(),
        })
    }

    fn depth(
        &self,
        frame: StackFrame,
        known: &mut BTreeMap<StackFrame, Depth>,
        callers: &mut Vec<StackFrame>,
    ) -> Result<Depth, ImageBudgetError> {
        if let Some(depth) = known.get(&frame) {
            return Ok(*depth);
        }
        if let Some(first) = callers.iter().position(|other| *other == frame) {
            return Err(self.recursion(callers.get(first..).unwrap_or_default()));
        }
        callers.push(frame);
        let (mut most, mut deepest) = (0, None);
        let calls = self.edges(frame.function).iter();
        for next in calls.filter_map(|edge| frame.call(edge)) {
            let (bytes, _) = self.depth(next, known, callers)?;
            if deepest.is_none() || bytes > most {
                (most, deepest) = (bytes, Some(next));
            }
        }
        callers.pop();
        let function = self.function(frame.function);
        let depth = (
            function.map_or(0, |function| function.frame) + most,
            deepest,
        );
        known.insert(frame, depth);
        Ok(depth)
    }

    fn recursion(&self, circle: &[StackFrame]) -> ImageBudgetError {
        let names = circle.iter().map(|frame| self.name(frame.function));
        ImageBudgetError::Recursion(names.collect())
    }

    /// The functions that a root can reach and that make calls by address.
    pub(super) fn indirect_callers(&self, root: u32) -> Vec<&'a Function> {
        let reached = self.came_from(root).into_keys();
        reached
            .filter_map(|address| self.function(address))
            .filter(|function| function.indirect_calls > 0)
            .collect()
    }

    /// The shortest path from a root to a function that is called so.
    pub(super) fn shortest_path(&self, names: &[&str], root: u32) -> Option<Vec<String>> {
        let came_from = self.came_from(root);
        let begins = |address: &&u32| {
            self.function(**address)
                .is_some_and(|function| function.is_called(names))
        };
        let paths = came_from
            .keys()
            .filter(begins)
            .map(|end| self.path(*end, &came_from));
        paths.min_by_key(Vec::len)
    }

    /// From which function each one is reached first, breadth first.
    fn came_from(&self, root: u32) -> BTreeMap<u32, Option<u32>> {
        let mut came_from = BTreeMap::from([(root, None)]);
        let mut open = VecDeque::from([root]);
        while let Some(from) = open.pop_front() {
            for edge in self.edges(from) {
                if let Entry::Vacant(new) = came_from.entry(edge.to) {
                    new.insert(Some(from));
                    open.push_back(edge.to);
                }
            }
        }
        came_from
    }

    fn path(&self, end: u32, came_from: &BTreeMap<u32, Option<u32>>) -> Vec<String> {
        let caller = |at: &u32| came_from.get(at).copied().flatten();
        let backwards = std::iter::successors(Some(end), caller);
        let mut path: Vec<String> = backwards.map(|at| self.name(at)).collect();
        path.reverse();
        path
    }
}
