//! The faults where there is little room: one line that is always there, and explanations above the leg, by a press.

use crate::faults::{self, FaultList};
use crate::places::place;
use crate::scrolled;
use crate::theme::palette;
use crate::top_bar::NOT_KNOWN;
use egui::{Area, Button, Frame, Id, Rect, RichText, Sense, Stroke, Ui, vec2};
use leg_firmware::supervisor::FaultSet;
use leg_rig::rig_file::RigFile;

/// Its height, points.
const HEIGHT: f32 = 30.0;

/// The line, and whether it is explained.
#[derive(Default)]
pub struct FaultStrip {
    list: FaultList,
    open: bool,
}

impl FaultStrip {
    /// Shows it; what explains it covers `over`, so that nothing else moves.
    pub fn show(&mut self, ui: &mut Ui, faults: Option<FaultSet>, rig: &RigFile, over: Rect) {
        let palette = palette(ui.ctx());
        let first = faults.and_then(|faults| faults.faults().next());
        self.open &= first.is_some();
        let (words, colour) = match (faults, first) {
            (None, _) => (format!("Faults: {NOT_KNOWN}"), palette.error),
            (_, None) => ("✔ no faults".into(), palette.good),
            (Some(faults), Some(first)) => {
                let more = faults.faults().count() - 1;
                let more = if more > 0 {
                    format!(", {more} more")
                } else {
                    String::new()
                };
                let what = if self.open { "close" } else { "what to do" };
                let words = format!("{}{more}: {what}", faults::title(first));
                (words, faults::colour(first, &palette))
            }
        };
        let text = RichText::new(words).color(colour).strong();
        let size = vec2(ui.available_width(), HEIGHT);
        let button = Button::new(text)
            .truncate()
            .fill(palette.card)
            .stroke(Stroke::new(1.0, colour));
        let sense = if first.is_some() {
            Sense::click()
        } else {
            Sense::hover()
        };
        let strip = ui.add(button.min_size(size).sense(sense));
        place(&strip, "fault_strip");
        if strip.clicked() {
            self.open = !self.open;
        }
        if self.open {
            self.explain(ui, faults, rig, over);
        }
    }

    fn explain(&mut self, ui: &Ui, faults: Option<FaultSet>, rig: &RigFile, over: Rect) {
        let area = Area::new(Id::unique("fault strip")).fixed_pos(over.min);
        area.show(ui.ctx(), |ui| {
            let frame = Frame::NONE.fill(palette(ui.ctx()).back).inner_margin(8.0);
            frame.show(ui, |ui| {
                let size = over.size() - vec2(16.0, 16.0);
                ui.set_min_size(size);
                ui.set_max_size(size);
                scrolled::shrunk(ui, "fault strip", |ui| self.list.show(ui, faults, rig));
            });
        });
    }
}
