//! What each image may take.

use super::{ImageBudgetError, ImageNeeds, MemoryUsage, Root};
use leg_boards::image::FirmwareImage;
use serde::Serialize;

/// What an image may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageBudget {
    /// Bytes of flash.
    pub flash: ByteBounds,
    /// Bytes of RAM for static variables.
    pub ram: ByteBounds,
    /// Bytes of stack, all handlers on top of each other.
    pub stack: ByteBounds,
    /// Bytes of stack of each task.
    pub tasks: &'static [(&'static str, ByteBounds)],
    /// Handlers that must neither reach a panic nor write to the log.
    pub hot: &'static [&'static str],
}

/// Bounds on a number of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ByteBounds {
    /// Fewer mean that something is missing, or no longer seen.
    pub lowest: u32,
    /// More are not allowed.
    pub highest: u32,
}

/// A bound that an image must keep.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BudgetCheck {
    /// What it is.
    pub what: String,
    /// What was found, and what of: bytes, or panics within reach of a handler.
    pub usage: MemoryUsage,
    /// What may be used.
    pub bounds: ByteBounds,
    /// Whether that is kept, and no more used than there is.
    pub passed: bool,
}

impl ByteBounds {
    pub(super) const fn new(lowest: u32, highest: u32) -> Self {
        Self { lowest, highest }
    }

    fn check(self, what: impl Into<String>, usage: MemoryUsage) -> BudgetCheck {
        let bounded = (self.lowest..=self.highest).contains(&usage.used);
        BudgetCheck {
            what: what.into(),
            usage,
            bounds: self,
            passed: bounded && usage.used <= usage.size,
        }
    }
}

const STM32G474_TASKS: &[(&str, ByteBounds)] = &[
    ("can_bus::serve", ByteBounds::new(14_900, 19_900)),
    ("housekeeping::keep_house", ByteBounds::new(1_900, 2_500)),
    (
        "leg_stm32g474::embassy_main",
        ByteBounds::new(14_200, 19_000),
    ),
    ("serial::serve", ByteBounds::new(14_300, 19_100)),
    (
        "settings_task::keep_settings",
        ByteBounds::new(12_700, 16_900),
    ),
];

const QEMU_TASKS: &[(&str, ByteBounds)] =
    &[("leg_qemu::answer_host", ByteBounds::new(28_400, 37_800))];

impl ImageBudget {
    /// The budget of an image: about a tenth below and a fifth above what it took when it was last set.
    #[must_use]
    pub const fn new(image: FirmwareImage) -> Self {
        match image {
            FirmwareImage::Stm32g474 => Self {
                flash: ByteBounds::new(200_000, 266_000),
                ram: ByteBounds::new(55_300, 73_700),
                stack: ByteBounds::new(32_300, 43_200),
                tasks: STM32G474_TASKS,
                hot: &["ADC1_2"],
            },
            FirmwareImage::Qemu => Self {
                flash: ByteBounds::new(206_000, 275_000),
                ram: ByteBounds::new(38_500, 51_300),
                stack: ByteBounds::new(35_500, 47_300),
                tasks: QEMU_TASKS,
                hot: &[],
            },
        }
    }
}

/// What an image must keep: the board's memories and its budget.
///
/// # Errors
/// [`ImageBudgetError::NoRoot`] if the budget names a handler that the image does not have, and
/// [`ImageBudgetError::OtherTasks`] unless it names the image's tasks.
pub fn checks(
    needs: &ImageNeeds,
    budget: &ImageBudget,
) -> Result<Vec<BudgetCheck>, ImageBudgetError> {
    let mut checks = vec![
        budget.flash.check("flash", needs.flash),
        budget.ram.check("static variables", needs.ram),
        budget.stack.check("stack", needs.stack),
    ];
    checks.extend(task_checks(needs, budget)?);
    for name in budget.hot {
        let root = needs.roots.iter().find(|root| root.name == *name);
        let root = root.ok_or_else(|| ImageBudgetError::NoRoot((*name).into()))?;
        checks.push(absence("panic", root, root.panic.is_some()));
        checks.push(absence("log", root, root.log.is_some()));
    }
    Ok(checks)
}

fn task_checks(
    needs: &ImageNeeds,
    budget: &ImageBudget,
) -> Result<Vec<BudgetCheck>, ImageBudgetError> {
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
            let usage = MemoryUsage {
                used: task.stack_bytes,
                size: needs.stack.size,
            };
            bounds.check(format!("stack of {}", task.name), usage)
        })
        .collect())
}

fn absence(what: &str, root: &Root, there: bool) -> BudgetCheck {
    let usage = MemoryUsage {
        used: u32::from(there),
        size: 1,
    };
    ByteBounds::new(0, 0).check(format!("no {what} from {}", root.name), usage)
}
