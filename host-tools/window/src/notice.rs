//! What became of something that the user did, until it is closed: across the window, whatever is shown below.

use crate::places::{place, place_rect};
use crate::theme::palette;
use egui::{Frame, Label, Panel, RichText, ScrollArea, Stroke, Ui};

/// Its height at most, points.
const HEIGHT_MAX: f32 = 190.0;

/// One message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Whether it went well.
    pub good: bool,
    /// What it is about.
    pub title: String,
    /// More about it: lines whose columns matter.
    pub text: String,
}

/// Shows it, if there is one, above what is shown next.
pub fn show(ui: &mut Ui, notice: &mut Option<Notice>) {
    let Some(Notice { good, title, text }) = &*notice else {
        return;
    };
    let palette = palette(ui.ctx());
    let colour = if *good { palette.good } else { palette.error };
    let frame = Frame::side_top_panel(ui.style())
        .fill(palette.card)
        .stroke(Stroke::new(1.5, colour))
        .inner_margin(10.0);
    let panel = Panel::top("notice").frame(frame).resizable(false);
    let shown = panel.show(ui, |ui| {
        let closed = ui
            .horizontal(|ui| {
                let close = ui.button("Close");
                place(&close, "notice_close");
                let title = RichText::new(title).strong().color(colour);
                ui.add(Label::new(title).wrap());
                close.clicked()
            })
            .inner;
        if !text.is_empty() {
            let scroll = ScrollArea::both()
                .id_salt("notice")
                .max_height(HEIGHT_MAX)
                // The panel is as high as what is in it, and not the other way round.
                .min_scrolled_height(HEIGHT_MAX);
            scroll.show(ui, |ui| {
                let text = RichText::new(text).monospace();
                ui.add(Label::new(text).extend().selectable(true));
            });
        }
        closed
    });
    place_rect(ui.ctx(), shown.response.rect, "notice");
    if shown.inner {
        *notice = None;
    }
}
