//! Every fault that the leg reports: what raised it, what it led to, and what to do.

use crate::theme::{Palette, palette};
use eframe::egui::{CollapsingHeader, Frame, Label, RichText, Stroke, Ui};
use leg_firmware::supervisor::{Clearing, Fault, FaultEntry, FaultSet, Reaction};

/// The list of faults.
#[derive(Default)]
pub struct FaultList {
    /// Those of the last frame.
    shown: FaultSet,
}

impl FaultList {
    /// Shows the faults; without one, that there is none. The first explanation is open, the others open by a press.
    pub fn show(&mut self, ui: &mut Ui, faults: FaultSet) {
        let palette = palette(ui.ctx());
        ui.heading("Faults");
        if !faults.any() {
            ui.label(RichText::new("✔ none").color(palette.good));
        }
        let first = if self.shown.any() {
            None
        } else {
            faults.faults().next()
        };
        for fault in faults.faults() {
            let new = !self.shown.has(fault);
            card(ui, fault, new.then_some(first == Some(fault)), &palette);
        }
        self.shown = faults;
    }

    /// Shows the faults if there are any.
    pub fn show_any(&mut self, ui: &mut Ui, faults: FaultSet) {
        if faults.any() {
            self.show(ui, faults);
        } else {
            self.shown = faults;
        }
    }
}

/// A fault; `open` opens or closes its explanation.
fn card(ui: &mut Ui, fault: Fault, open: Option<bool>, palette: &Palette) {
    let entry = fault.entry();
    let colour = if entry.reaction == Reaction::Limit {
        palette.warning
    } else {
        palette.error
    };
    let frame = Frame::group(ui.style())
        .fill(palette.card)
        .stroke(Stroke::new(1.5, colour))
        .inner_margin(6.0);
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        let title = format!("{} · {}", fault.code(), entry.name);
        let header = CollapsingHeader::new(RichText::new(title).strong().color(colour));
        let header = header.id_salt(fault.code()).open(open);
        header.show_unindented(ui, |ui| rows(ui, entry));
    });
}

fn rows(ui: &mut Ui, entry: &FaultEntry) {
    for (what, words) in [
        ("Cause", entry.cause),
        ("Reaction", reaction(entry.reaction)),
        ("Remedy", entry.remedy),
        ("Ends", clearing(entry.clears)),
    ] {
        let text = format!("{what}: {words}");
        ui.add(Label::new(RichText::new(text).size(12.5)).wrap());
    }
}

/// What the leg does about it.
const fn reaction(reaction: Reaction) -> &'static str {
    match reaction {
        Reaction::Limit => "the leg goes on with what is possible",
        Reaction::Hold => "the leg stays where it is, its motors at rest on their screws",
        Reaction::RampDown => "the tendons are paid out, then the drivers are switched off",
        Reaction::GateOff => "the drivers are switched off at once; the screws hold",
    }
}

const fn clearing(clearing: Clearing) -> &'static str {
    match clearing {
        Clearing::CauseGone => "by itself, with its cause",
        Clearing::Command => "by Clear, once its cause is gone",
    }
}

#[cfg(test)]
mod tests {
    use super::FaultList;
    use eframe::egui::{Context, RawInput, Rect, Shape, pos2};
    use eframe::epaint::ClippedShape;
    use leg_firmware::supervisor::{Fault, FaultSet};

    fn words(shape: &Shape) -> String {
        match shape {
            Shape::Text(text) => text.galley.text().to_owned(),
            Shape::Vec(shapes) => shapes.iter().map(words).collect(),
            _ => String::new(),
        }
    }

    /// What is shown when the faults have stayed for a second.
    fn shown(list: &mut FaultList, ctx: &Context, faults: FaultSet, from_s: f64) -> String {
        let mut shapes: Vec<ClippedShape> = Vec::new();
        for frame in 0..10 {
            let input = RawInput {
                time: Some(from_s + 0.1 * f64::from(frame)),
                screen_rect: Some(Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 900.0))),
                ..RawInput::default()
            };
            let mut output = ctx.run_ui(input, |ui| list.show(ui, faults));
            output.textures_delta.clear();
            shapes = output.shapes;
        }
        shapes.iter().map(|clipped| words(&clipped.shape)).collect()
    }

    fn is_open(shown: &str, fault: Fault) -> bool {
        assert!(shown.contains(fault.entry().name), "{shown}");
        shown.contains(fault.entry().cause)
    }

    #[test]
    fn the_first_of_faults_that_come_together_is_open() {
        let (ctx, mut list) = (Context::default(), FaultList::default());
        let (first, second) = (Fault::Slack, Fault::TensionJump);
        let both = FaultSet::single(second).union(FaultSet::single(first));
        let shown_both = shown(&mut list, &ctx, both, 0.0);
        assert!(is_open(&shown_both, first) && !is_open(&shown_both, second));
        // The same faults once more, the other way round.
        shown(&mut list, &ctx, FaultSet::NONE, 1.0);
        let alone = shown(&mut list, &ctx, FaultSet::single(second), 2.0);
        assert!(is_open(&alone, second));
        let later = shown(&mut list, &ctx, both, 3.0);
        assert!(is_open(&later, second) && !is_open(&later, first));
    }
}
