//! What is shown of rig files and settings, as data: for tests, and for those who hear the page.

use super::editor::Editor;
use crate::notice::Notice;
use crate::shown_leg::ShownLeg;
use serde::Serialize;

/// It at a time.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SetupState {
    /// What became of what the user did last.
    pub notice: Option<String>,
    /// More about it: a refusal with its place.
    details: Option<String>,
    /// Settings that are not as in the file.
    changed: Vec<String>,
    /// Why the last change was refused.
    refused: Option<String>,
    /// What a live leg's board is busy with.
    board_busy: Option<&'static str>,
    /// What the board made of what it was asked.
    board_told: Option<String>,
    /// Why a motor was not measured to the end.
    measure_failed: Option<String>,
}

impl SetupState {
    pub(super) fn new(
        notice: Option<&Notice>,
        editor: Option<&Editor>,
        leg: Option<&ShownLeg>,
        measure_failed: Option<&str>,
    ) -> Self {
        let board = leg.and_then(ShownLeg::live).map(|live| live.board());
        let changed = editor.map_or_else(Vec::new, Editor::changes);
        let told = board.and_then(|board| board.told());
        Self {
            notice: notice.map(|notice| notice.title.clone()),
            details: notice.map(|notice| notice.text.clone()),
            changed: changed.into_iter().map(|change| change.name).collect(),
            refused: editor
                .and_then(Editor::refused)
                .map(|refused| refused.words.clone()),
            board_busy: board.and_then(|board| board.busy()),
            measure_failed: measure_failed.map(Into::into),
            board_told: told.map(|told| told.unwrap_or_else(|words| words).into()),
        }
    }
}
