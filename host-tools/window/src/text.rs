//! Text in its place.

use egui::{Align, Label, Layout, Response, RichText, Ui, vec2};

/// Text at the left of a field of some width.
pub fn left(ui: &mut Ui, width: f32, text: &str) {
    let size = vec2(width, ui.spacing().interact_size.y);
    let layout = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_size(size);
        ui.add(Label::new(RichText::new(text)).truncate());
    });
}

/// Says of a control that is disabled why it is.
#[must_use]
pub fn why(response: Response, locked: Option<&str>) -> Response {
    match locked {
        Some(words) => response.on_disabled_hover_text(words),
        None => response,
    }
}
