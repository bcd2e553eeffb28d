//! Every fault that the leg reports: what raised it, what it led to, and what to do.

use crate::fault_words;
use crate::places::place;
use crate::theme::{Palette, palette};
use egui::{CollapsingHeader, Color32, Frame, Label, RichText, Stroke, Ui};
use leg_firmware::supervisor::{Clearing, Fault, FaultEntry, FaultSet, Reaction};
use leg_rig::rig_file::RigFile;

/// The list of faults.
#[derive(Default)]
pub struct FaultList {
    /// Those of the last frame.
    shown: FaultSet,
}

impl FaultList {
    /// Shows the faults of a leg with this rig; without one, that there is none. The first explanation is open, the others open by
    /// a press. None where it is not known whether there are some.
    pub fn show(&mut self, ui: &mut Ui, faults: Option<FaultSet>, rig: &RigFile) {
        let palette = palette(ui.ctx());
        let heading = ui.horizontal(|ui| {
            ui.heading("Faults");
            match faults {
                None => ui.label(RichText::new("not known").color(palette.error)),
                Some(faults) if !faults.any() => {
                    ui.label(RichText::new("✔ none").color(palette.good))
                }
                Some(_) => ui.response(),
            }
        });
        place(&heading.response, "faults");
        let Some(faults) = faults else {
            return;
        };
        let first = if self.shown.any() {
            None
        } else {
            faults.faults().next()
        };
        for fault in faults.faults() {
            let new = !self.shown.has(fault);
            card(
                ui,
                fault,
                new.then_some(first == Some(fault)),
                rig,
                &palette,
            );
        }
        self.shown = faults;
    }
}

/// How grave a fault is, as a colour.
#[must_use]
pub fn colour(fault: Fault, palette: &Palette) -> Color32 {
    if fault.reaction() == Reaction::Limit {
        palette.warning
    } else {
        palette.error
    }
}

/// Its code and its name.
#[must_use]
pub fn title(fault: Fault) -> String {
    format!("{} · {}", fault.code(), fault.entry().name)
}

/// A fault; `open` opens or closes its explanation.
fn card(ui: &mut Ui, fault: Fault, open: Option<bool>, rig: &RigFile, palette: &Palette) {
    let colour = colour(fault, palette);
    let frame = Frame::group(ui.style())
        .fill(palette.card)
        .stroke(Stroke::new(1.5, colour))
        .inner_margin(6.0);
    let shown = frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        let title = RichText::new(title(fault))
            .strong()
            .size(13.0)
            .color(colour);
        let header = CollapsingHeader::new(title);
        let header = header.id_salt(fault.code()).open(open);
        header.show_unindented(ui, |ui| rows(ui, fault.entry(), rig));
    });
    place(&shown.response, format!("fault_{}", fault.code()));
}

/// What to do stands first: where there is little room the rest is below the edge.
fn rows(ui: &mut Ui, entry: &FaultEntry, rig: &RigFile) {
    ui.spacing_mut().item_spacing.y = 3.0;
    let rows = [
        ("Remedy", fault_words::with_values(entry.remedy, rig)),
        ("Cause", fault_words::with_values(entry.cause, rig)),
        ("Reaction", reaction(entry).into()),
        ("Ends", clearing(entry.clears).into()),
    ];
    for (what, words) in rows {
        let text = format!("{what}: {words}");
        let row = ui.add(Label::new(RichText::new(text).small()).wrap());
        place(
            &row,
            format!("fault_{}_{}", entry.fault.code(), what.to_lowercase()),
        );
    }
}

/// What the leg does about it. A tendon that is cut holds nothing, whatever its motor does.
const fn reaction(entry: &FaultEntry) -> &'static str {
    match (entry.reaction, entry.fault) {
        (Reaction::Limit, _) => "the leg goes on with what is possible",
        (Reaction::Hold, Fault::Slack | Fault::TensionJump) => {
            "the motors stop on their screws; if a tendon is cut, the tip falls"
        }
        (Reaction::Hold, _) => "the motors stop, and their screws hold the leg",
        (Reaction::RampDown, _) => "the tendons are paid out, then the drivers are switched off",
        (Reaction::GateOff, _) => "the drivers are switched off at once; the screws hold",
    }
}

const fn clearing(clearing: Clearing) -> &'static str {
    match clearing {
        Clearing::CauseGone => "by itself, with its cause",
        Clearing::Command => "by Clear, once its cause is gone",
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::FaultList;
    use egui::epaint::ClippedShape;
    use egui::{Context, RawInput, Rect, Shape, pos2};
    use leg_firmware::supervisor::{Fault, FaultSet};
    use leg_rig::rig_file::RigFile;

    fn words(shape: &Shape) -> String {
        match shape {
            Shape::Text(text) => text.galley.text().to_owned(),
            Shape::Vec(shapes) => shapes.iter().map(words).collect(),
            _ => String::new(),
        }
    }

    /// What is shown when the faults have stayed for a second.
    fn shown(list: &mut FaultList, ctx: &Context, faults: FaultSet, from_s: f64) -> String {
        let rig = RigFile::load(None).unwrap();
        let mut shapes: Vec<ClippedShape> = Vec::new();
        for frame in 0..10 {
            let input = RawInput {
                time: Some(from_s + 0.1 * f64::from(frame)),
                screen_rect: Some(Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 900.0))),
                ..RawInput::default()
            };
            let mut output = ctx.run_ui(input, |ui| list.show(ui, Some(faults), &rig));
            output.textures_delta.clear();
            shapes = output.shapes;
        }
        shapes.iter().map(|clipped| words(&clipped.shape)).collect()
    }

    fn is_open(shown: &str, fault: Fault) -> bool {
        assert!(shown.contains(fault.entry().name), "{shown}");
        shown.contains("Cause: ") && shown.contains(fault.entry().remedy)
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
