//! Calibration step by step: what will move, how far, what to take off; what came of it, beside what is set.

pub mod cells;
pub mod jog;
mod panel;
mod panel_cells;
mod panel_jog;
mod panel_zero;
mod picture;

use crate::shown_leg::ShownLeg;
use cells::Cells;
use jog::Jog;
pub(super) use panel::show;

/// Which of them is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Guide {
    #[default]
    Cells,
    Motor,
    Zero,
}

/// All of them.
#[derive(Debug, Default)]
pub struct Steps {
    guide: Guide,
    cells: Cells,
    jog: Jog,
    /// Whether homing was started here.
    homing: bool,
}

impl Steps {
    /// Goes on with what takes longer than a frame, whatever is shown.
    pub fn advance(&mut self, leg: &mut ShownLeg) {
        self.cells.advance(leg);
        self.jog.advance(leg);
    }
}
