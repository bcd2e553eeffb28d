//! The switch without which nothing of a live leg moves.

use crate::live_leg::LiveLeg;
use crate::places::place;
use crate::theme::palette;
use egui::{Frame, Label, RichText, Stroke, Ui};
use leg_base::description::WITHOUT_HOST;

/// Shows it, and who drives.
pub fn show(ui: &mut Ui, leg: &mut LiveLeg) {
    let palette = palette(ui.ctx());
    let role = leg.role();
    let colour = if role.drives {
        palette.warning
    } else {
        palette.line
    };
    let frame = Frame::group(ui.style()).stroke(Stroke::new(1.5, colour));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        let mut unlocked = role.drives;
        let free = leg.failure().is_none() && !role.other_drives;
        let switch = ui.add_enabled_ui(free || role.drives, |ui| {
            ui.checkbox(&mut unlocked, RichText::new("Unlock this leg").strong())
        });
        let switch = switch.inner;
        place(&switch, "unlock");
        let clicked = switch.clicked();
        switch
            .on_hover_text(
                format!("This page then drives a real machine: nobody may reach into it. Locked again, {WITHOUT_HOST}."),
            )
            .on_disabled_hover_text("One page drives at a time, while the leg answers.");
        if clicked {
            leg.unlock(unlocked);
        }
        let words = match (role.drives, role.other_drives) {
            (true, _) => "This page drives.",
            (false, true) => "Another page drives. STOP works from here, too.",
            (false, false) => "Locked: no page drives. STOP works all the same.",
        };
        let words = RichText::new(words).small().color(palette.faint);
        ui.add(Label::new(words).wrap());
    });
    ui.add_space(4.0);
}
