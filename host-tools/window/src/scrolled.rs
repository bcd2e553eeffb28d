//! What may be higher than its room, with a scroll bar beside it.

use egui::{ScrollArea, Ui};

/// What a bar takes at the right, whether it is shown or not, points: nothing moves, and nothing is below it.
pub const BAR: f32 = 8.0;

/// As high as what is in it, up to the room that there is.
pub fn shrunk<R>(ui: &mut Ui, id: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let area = ScrollArea::vertical()
        .id_salt(id)
        .auto_shrink([false, true]);
    show(ui, area, contents)
}

/// All of the room.
pub fn whole<R>(ui: &mut Ui, id: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let area = ScrollArea::vertical().id_salt(id).auto_shrink(false);
    show(ui, area, contents)
}

fn show<R>(ui: &mut Ui, area: ScrollArea, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let shown = area.show(ui, |ui| {
        ui.set_max_width(ui.available_width() - BAR);
        contents(ui)
    });
    shown.inner
}
