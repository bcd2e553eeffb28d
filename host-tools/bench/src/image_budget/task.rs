//! The tasks of embassy's executors.

use super::call_graph::CallGraph;
use super::error::ImageBudgetError;
use super::indirect::TASK;
use super::program::Program;
use serde::Serialize;

/// A task, and what it needs from its poll on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Task {
    /// Its module and its name.
    pub name: String,
    /// The most stack that it takes, bytes.
    pub stack_bytes: u32,
    /// The functions whose frames that stack holds, the poll first.
    pub deepest: Vec<String>,
}

/// Every task, by its name.
pub(super) fn tasks(
    program: &Program,
    graph: &CallGraph<'_>,
) -> Result<Vec<Task>, ImageBudgetError> {
    let named = program.functions.iter().filter_map(|(address, function)| {
        let name = name(function.name())?;
        Some((*address, name))
    });
    let mut tasks = named
        .map(|(address, name)| {
            let stack = graph.stack(address)?;
            Ok(Task {
                name,
                stack_bytes: stack.bytes,
                deepest: stack.functions,
            })
        })
        .collect::<Result<Vec<_>, ImageBudgetError>>()?;
    tasks.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(tasks)
}

/// The name of a task whose poll is called so: embassy's macro puts a task `serve` of a module `can_bus` into
/// `can_bus::__serve_task::__serve_task_inner_function`.
fn name(function: &str) -> Option<String> {
    let future = function.split(TASK).nth(1)?;
    if !function.ends_with("::poll") {
        return None;
    }
    let (path, _) = future.split_once("_task_inner_function")?;
    let mut words = path.rsplit("::");
    let name = words.next()?.trim_start_matches('_');
    let module = words.nth(1)?;
    Some(format!("{module}::{name}"))
}

#[cfg(test)]
mod tests {
    use super::name;

    #[test]
    fn a_task_is_named_as_it_was_written() {
        let poll = "<embassy_executor::raw::TaskStorage<leg::settings_task::__keep_settings_task::\
                    __keep_settings_task_inner_function::{closure#0}>>::poll";
        assert_eq!(name(poll).as_deref(), Some("settings_task::keep_settings"));
        let other = poll.replace("poll", "spawn");
        assert_eq!(name(&other), None);
        assert_eq!(name("core::future::poll"), None);
    }
}
