//! What calls by address can reach, where that is less than every function whose address is taken.
//!
//! An ELF file does not say it, so it is declared here. A caller without a declaration may reach every function whose
//! address is taken, and every caller may reach those that no declaration names: leaving one out leads to a larger
//! bound or to a recursion, which is an error, never to less.

use super::error::ImageBudgetError;
use super::function::Function;
use super::program::Program;
use std::collections::BTreeSet;

/// Names of functions, or parts of them where they hold `::`.
type Names = &'static [&'static str];

/// What the indirect calls of some functions reach.
#[derive(Debug)]
struct Declaration {
    /// The callers.
    callers: Names,
    /// The most indirect calls that a caller makes: more are others than those declared.
    calls: usize,
    /// The targets.
    targets: Names,
    /// Whether the targets may lead back to the callers, [`NESTED`] times on one stack.
    nested: bool,
}

/// How many calls of nested declarations stand on one stack at most.
///
/// The deepest that is known is the message of a panic about an error: the panic, its message, the error behind a
/// reference, the error itself, what pads it, and what writes its letters.
pub(super) const NESTED: usize = 8;

/// What polls a task: its name has the task's.
pub(super) const TASK: &str = "embassy_executor::raw::TaskStorage<";

/// The functions that embassy's executor is handed for a task.
const POLLS: Names = &[TASK, "raw::poll_exited"];

/// The functions behind a waker: each image has those of embassy's executor alone.
const WAKERS: Names = &["embassy_executor::raw::waker::"];

static DECLARATIONS: [Declaration; 17] = [
    // What pads a value's letters hands them to what writes.
    writes(
        &["core::fmt::Formatter>::"],
        &["core::fmt::Write>::", "core::fmt::Write::"],
    ),
    // Values write themselves, and values in them, to what writes letters.
    writes(&["core::fmt::"], &["core::fmt::"]),
    wakers(&[TASK], 2),
    wakers(&["_embassy_time_schedule_wake"], 3),
    // The alarm of embassy's clock, on the STM32 and under QEMU.
    wakers(&["TIM1_BRK_TIM15", "TIMER1"], 2),
    // The serial line's interrupt wakes who reads and who writes.
    wakers(&["LPUART1"], 6),
    // So does that of the bus, and who watches the controller's errors.
    wakers(
        &[
            "FDCAN2_IT0",
            "embassy_stm32::can::_version::RxMode>::on_interrupt",
        ],
        5,
    ),
    wakers(
        &["embassy_stm32::can::_version::Info>::adjust_reference_counter"],
        2,
    ),
    wakers(&["leg_stm32g474::can_bus::Bus>::wait::"], 9),
    // Of the flash, too, and who waits for it registers himself.
    wakers(&["FLASH"], 2),
    wakers(
        &[
            "leg_stm32g474::flash::CheckedFlash as embedded_storage_async",
            "leg_firmware::store::sealed::Sealed<leg_stm32g474::flash::CheckedFlash>>::renew::",
        ],
        3,
    ),
    wakers(&["sequential_storage::map::MapStorage<"], 1),
    // Settings to keep wake the task that keeps them.
    wakers(&["leg_stm32g474::link::Session>::turn"], 1),
    polls(&["embassy_executor::platform::thread::Executor>::run"]),
    polls(&["LINK"]),
    // What a task does may be a function of its own.
    wakers(&["leg_qemu::__answer_host_task::"], 1),
    // What is counted under QEMU.
    plain(
        &["leg_qemu::counter::ticks_of"],
        1,
        &[
            "leg_firmware_bench::kernels::",
            "leg_firmware_bench::virtual_leg::tick",
            "leg_qemu::counter::",
        ],
    ),
];

const fn writes(callers: Names, targets: Names) -> Declaration {
    Declaration {
        nested: true,
        ..plain(callers, usize::MAX, targets)
    }
}

const fn wakers(callers: Names, calls: usize) -> Declaration {
    plain(callers, calls, WAKERS)
}

const fn polls(callers: Names) -> Declaration {
    plain(callers, 1, POLLS)
}

const fn plain(callers: Names, calls: usize, targets: Names) -> Declaration {
    Declaration {
        callers,
        calls,
        targets,
        nested: false,
    }
}

/// Where the functions begin that the indirect calls of a function of the program may reach, and whether these calls
/// count towards [`NESTED`].
pub(super) fn reach(
    function: &Function,
    program: &Program,
) -> Result<(BTreeSet<u32>, bool), ImageBudgetError> {
    if function.indirect_calls == 0 {
        return Ok((BTreeSet::new(), false));
    }
    let Some(declaration) = find_declaration(function) else {
        return Ok((program.taken.clone(), false));
    };
    if function.indirect_calls > declaration.calls {
        return Err(ImageBudgetError::MoreCalls {
            function: function.name().into(),
            found: function.indirect_calls,
            declared: declaration.calls,
        });
    }
    let declared_targets = taken_functions(program, |target| target.is_called(declaration.targets));
    if declared_targets.is_empty() {
        return Err(ImageBudgetError::NoTarget {
            function: function.name().into(),
            declared: declaration.targets.join(", "),
        });
    }
    let unnamed = taken_functions(program, |target| {
        !DECLARATIONS
            .iter()
            .any(|declaration| target.is_called(declaration.targets))
    });
    let targets = declared_targets.into_iter().chain(unnamed).collect();
    Ok((targets, declaration.nested))
}

/// Whether it is declared what the indirect calls of a function reach.
pub(super) fn is_declared(function: &Function) -> bool {
    find_declaration(function).is_some()
}

/// The first one that fits: the narrower stand before the wider.
fn find_declaration(function: &Function) -> Option<&'static Declaration> {
    DECLARATIONS
        .iter()
        .find(|declaration| function.is_called(declaration.callers))
}

fn taken_functions(program: &Program, wanted: impl Fn(&Function) -> bool) -> BTreeSet<u32> {
    let is_wanted = |address: &&u32| program.functions.get(address).is_some_and(&wanted);
    program.taken.iter().filter(is_wanted).copied().collect()
}
