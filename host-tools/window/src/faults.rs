//! Every fault that the leg reports: what raised it, what it led to, and what to do.

use crate::theme::{Palette, palette};
use eframe::egui::{CollapsingHeader, Frame, Label, RichText, Stroke, Ui};
use leg_firmware::supervisor::{Clearing, Fault, FaultEntry, FaultSet, Reaction};

/// Shows the faults; without one, that there is none. What came first is open, the others open by a press.
pub fn show(ui: &mut Ui, faults: FaultSet) {
    let palette = palette(ui.ctx());
    ui.heading("Faults");
    if !faults.any() {
        ui.label(RichText::new("✔ none").color(palette.good));
    }
    let alone = faults.faults().count() == 1;
    for fault in faults.faults() {
        card(ui, fault, alone, &palette);
    }
}

fn card(ui: &mut Ui, fault: Fault, open: bool, palette: &Palette) {
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
        let header = header.id_salt(fault.code()).default_open(open);
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
