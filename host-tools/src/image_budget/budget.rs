//! What each image may take.

use super::{ImageBudgetError, ImageNeeds, Root, Usage};
use crate::image::Board;
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
    /// Handlers that must not reach a panic.
    pub panic_free: &'static [&'static str],
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

/// The budget of a board's image: about a tenth below and a fifth above what it took when it was last looked at.
#[must_use]
pub const fn of(board: Board) -> ImageBudget {
    match board {
        Board::Stm32g474 => ImageBudget {
            flash: Bounds::new(165_000, 220_000),
            ram: Bounds::new(31_300, 41_700),
            stack: Bounds::new(38_000, 51_000),
            panic_free: &["ADC1_2"],
        },
        Board::Qemu => ImageBudget {
            flash: Bounds::new(172_000, 229_000),
            ram: Bounds::new(10_600, 14_200),
            stack: Bounds::new(26_300, 35_000),
            panic_free: &[],
        },
    }
}

/// What an image must keep: the board's memories and its budget.
///
/// # Errors
/// [`ImageBudgetError::NoRoot`] if the budget names a handler that the image does not have.
pub fn checks(needs: &ImageNeeds, budget: &ImageBudget) -> Result<Vec<Check>, ImageBudgetError> {
    let mut checks = vec![
        budget.flash.check("flash", needs.flash),
        budget.ram.check("static variables", needs.ram),
        budget.stack.check("stack", needs.stack),
    ];
    for name in budget.panic_free {
        let root = needs.roots.iter().find(|root| root.name == *name);
        let root = root.ok_or_else(|| ImageBudgetError::NoRoot {
            name: (*name).into(),
        })?;
        checks.push(no_panic(root));
    }
    Ok(checks)
}

fn no_panic(root: &Root) -> Check {
    let usage = Usage {
        used: u32::from(root.panic.is_some()),
        size: 1,
    };
    Bounds::new(0, 0).check(format!("no panic from {}", root.name), usage)
}
