//! What each image may take.

use super::{ImageBudgetError, ImageNeeds, Root, Usage};
use leg_boards::image::Board;
use serde::Serialize;

/// What an image may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageBudget {
    /// Bytes of flash.
    pub flash: Bounds,
    /// Bytes of RAM for static variables.
    pub ram: Bounds,
    /// Bytes of stack, all handlers on top of each other.
    pub stack: Bounds,
    /// Bytes of stack of each task.
    pub tasks: &'static [(&'static str, Bounds)],
    /// Handlers that must neither reach a panic nor write to the log.
    pub hot: &'static [&'static str],
}

/// Bounds on a number of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Bounds {
    /// The fewest that are believed: fewer means that something is missing, or no longer seen.
    pub lowest: u32,
    /// The most that are allowed.
    pub highest: u32,
}

/// Something that an image must keep.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Check {
    /// What it is.
    pub what: String,
    /// What was found, and what of: bytes, or panics within reach of a handler.
    pub usage: Usage,
    /// What may be used.
    pub bounds: Bounds,
    /// Whether that is kept, and no more used than there is.
    pub held: bool,
}

impl Bounds {
    const fn new(lowest: u32, highest: u32) -> Self {
        Self { lowest, highest }
    }

    fn check(self, what: impl Into<String>, usage: Usage) -> Check {
        let bounded = (self.lowest..=self.highest).contains(&usage.used);
        Check {
            what: what.into(),
            usage,
            bounds: self,
            held: bounded && usage.used <= usage.size,
        }
    }
}

const STM32G474_TASKS: &[(&str, Bounds)] = &[
    ("can_bus::serve", Bounds::new(18_100, 24_100)),
    ("housekeeping::keep_house", Bounds::new(1_900, 2_500)),
    ("leg_stm32g474::embassy_main", Bounds::new(25_000, 33_300)),
    ("serial::serve", Bounds::new(17_500, 23_300)),
    ("settings_task::keep_settings", Bounds::new(12_700, 16_900)),
];

const QEMU_TASKS: &[(&str, Bounds)] = &[("leg_qemu::answer_host", Bounds::new(26_500, 35_300))];

/// The budget of a board's image: about a tenth below and a fifth above what it took when it was last looked at.
#[must_use]
pub const fn of(board: Board) -> ImageBudget {
    match board {
        Board::Stm32g474 => ImageBudget {
            flash: Bounds::new(165_000, 220_000),
            ram: Bounds::new(31_300, 41_700),
            stack: Bounds::new(38_000, 51_000),
            tasks: STM32G474_TASKS,
            hot: &["ADC1_2"],
        },
        Board::Qemu => ImageBudget {
            flash: Bounds::new(172_000, 229_000),
            ram: Bounds::new(10_600, 14_200),
            stack: Bounds::new(33_000, 44_000),
            tasks: QEMU_TASKS,
            hot: &[],
        },
    }
}

/// What an image must keep: the board's memories and its budget.
///
/// # Errors
/// [`ImageBudgetError::NoRoot`] if the budget names a handler that the image does not have, and
/// [`ImageBudgetError::OtherTasks`] unless it names the image's tasks.
pub fn checks(needs: &ImageNeeds, budget: &ImageBudget) -> Result<Vec<Check>, ImageBudgetError> {
    let mut checks = vec![
        budget.flash.check("flash", needs.flash),
        budget.ram.check("static variables", needs.ram),
        budget.stack.check("stack", needs.stack),
    ];
    checks.extend(of_tasks(needs, budget)?);
    for name in budget.hot {
        let root = needs.roots.iter().find(|root| root.name == *name);
        let root = root.ok_or_else(|| ImageBudgetError::NoRoot {
            name: (*name).into(),
        })?;
        checks.push(none("panic", root, root.panic.is_some()));
        checks.push(none("log", root, root.log.is_some()));
    }
    Ok(checks)
}

fn of_tasks(needs: &ImageNeeds, budget: &ImageBudget) -> Result<Vec<Check>, ImageBudgetError> {
    let found: Vec<&str> = needs.tasks.iter().map(|task| task.name.as_str()).collect();
    let budgeted: Vec<&str> = budget.tasks.iter().map(|(name, _)| *name).collect();
    if found != budgeted {
        return Err(ImageBudgetError::OtherTasks {
            found: found.join(", "),
            budgeted: budgeted.join(", "),
        });
    }
    let bounds = budget.tasks.iter().map(|(_, bounds)| bounds);
    Ok(needs
        .tasks
        .iter()
        .zip(bounds)
        .map(|(task, bounds)| {
            let usage = Usage {
                used: task.stack_bytes,
                size: needs.stack.size,
            };
            bounds.check(format!("stack of {}", task.name), usage)
        })
        .collect())
}

fn none(what: &str, root: &Root, there: bool) -> Check {
    let usage = Usage {
        used: u32::from(there),
        size: 1,
    };
    Bounds::new(0, 0).check(format!("no {what} from {}", root.name), usage)
}
