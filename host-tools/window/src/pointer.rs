//! Where the pointer pressed or drew something.

use egui::{Event, PointerButton, Pos2, Response};

/// Where something is pressed or dragged; where it was let go, if it was: a slow page sees the pointer's way from there in the same
/// frame.
#[must_use]
pub fn place(response: &Response) -> Option<Pos2> {
    let now = response.interact_pointer_pos()?;
    if !response.clicked() && !response.drag_stopped() {
        return Some(now);
    }
    let released = response.ctx.input(|input| {
        input.events.iter().find_map(|event| match event {
            Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed: false,
                ..
            } => Some(*pos),
            _ => None,
        })
    });
    released.or(Some(now))
}
