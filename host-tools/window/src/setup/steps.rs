//! Calibration step by step: what will move, how far, what to take off; what came of it, beside what is set.

pub mod cells;
mod controls;
pub mod jog;
mod page_leg;
mod panel;
mod panel_cells;
mod panel_jog;
mod panel_tune;
mod panel_turns;
mod panel_zero;
mod picture;
pub mod tune;
pub mod turns;

use super::editor::Editor;
use crate::shown_leg::ShownLeg;
use cells::Cells;
use jog::Jog;
pub(super) use panel::show;
use tune::Tune;
use turns::Turns;

/// Which of them is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Guide {
    #[default]
    Cells,
    Turns,
    Motor,
    Zero,
    Tune,
}

/// All of them.
#[derive(Debug, Default)]
pub struct Steps {
    guide: Guide,
    cells: Cells,
    turns: Turns,
    jog: Jog,
    tune: Tune,
    /// Whether homing was started here.
    homing: bool,
}

impl Steps {
    /// Why a motor was not measured to the end.
    #[must_use]
    pub fn measure_failed(&self) -> Option<&str> {
        self.tune.failure()
    }

    /// Looks at a leg that has reported something.
    pub fn look(&mut self, leg: &mut ShownLeg) {
        self.tune.look(leg);
    }

    /// Goes on with what takes longer than a frame, whatever is shown.
    pub fn advance(&mut self, leg: &mut ShownLeg, editor: Option<&Editor>) {
        self.cells.advance(leg);
        if let Some(editor) = editor {
            self.turns.advance(leg, editor);
        }
        self.jog.advance(leg);
    }
}
