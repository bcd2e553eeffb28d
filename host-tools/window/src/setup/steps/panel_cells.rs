//! A load cell by known weights, as its user does it.

use super::cells::{CellStep, Cells, weights};
use super::controls::{button, drivers_off, faint, sentence};
use super::picture::{self, StepPicture};
use crate::places::place;
use crate::setup::editor::Editor;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use egui::{Grid, Label, ProgressBar, RichText, TextEdit, Ui};
use leg_rig::cell_fit::CellFit;

pub(super) fn show(ui: &mut Ui, cells: &mut Cells, editor: &mut Editor, leg: &mut ShownLeg) {
    let settings = editor.settings();
    let weight = matches!(cells.step(), CellStep::Hang | CellStep::Read(..));
    picture::show(
        ui,
        &StepPicture {
            tendon: Some(cells.cell),
            weight_kg: cells.weight_kg().filter(|_| weight),
            ..StepPicture::default()
        },
    );
    match cells.step().clone() {
        CellStep::Choose => choose(ui, cells, f64::from(settings.rig.gravity_m_per_s2), leg),
        CellStep::Hang => hang(ui, cells, leg),
        CellStep::Read(..) => {
            let bar = ProgressBar::new(cells.progress()).show_percentage();
            place(&ui.add(bar.desired_width(260.0)), "cells_progress");
            faint(ui, "The cell is read. Do not touch the weight.");
        }
        CellStep::Done(result) => done(ui, cells, &result, editor, leg),
    }
}

fn choose(ui: &mut Ui, cells: &mut Cells, gravity_m_per_s2: f64, leg: &mut ShownLeg) {
    sentence(
        ui,
        1,
        "Which load cell, and which weights? Nothing moves: the motors stay off.",
    );
    ui.horizontal_wrapped(|ui| {
        for cell in 0..3 {
            let text = format!("Cell {}", cell + 1);
            let chosen = ui.selectable_value(&mut cells.cell, cell, text);
            place(&chosen, format!("cell_{}", cell + 1));
        }
        ui.label("weights");
        let typed = TextEdit::singleline(&mut cells.typed).desired_width(130.0);
        place(&ui.add(typed), "cell_weights");
        ui.label("kg");
    });
    sentence(
        ui,
        2,
        "Take the tendon off that cell. Keep a hook in its place: 0 kg is the empty hook.",
    );
    let off = drivers_off(ui, leg);
    let wrong = weights(&cells.typed).err();
    if let Some(words) = &wrong {
        let colour = palette(ui.ctx()).error;
        ui.add(Label::new(RichText::new(words).color(colour)).wrap());
    }
    let why = leg
        .locked()
        .or(wrong.as_deref())
        .or((!off).then_some("Disarm the leg first."));
    if button(ui, "Start", "cells_start", why).clicked() {
        // The weights were read above.
        let _ = cells.start(gravity_m_per_s2);
    }
}

fn hang(ui: &mut Ui, cells: &mut Cells, leg: &mut ShownLeg) {
    let [place, count] = cells.place();
    let kg = cells.weight_kg().unwrap_or_default();
    let words = format!(
        "Weight {place} of {count}: hang {kg} kg on load cell {} in the place of its tendon, and let it come to rest.",
        cells.cell + 1
    );
    sentence(ui, place as u8, &words);
    ui.horizontal(|ui| {
        let why = leg.locked();
        if button(ui, "It hangs still: read it", "cells_read", why).clicked() {
            cells.read(leg);
        }
        if button(ui, "Give up", "cells_cancel", None).clicked() {
            cells.cancel(leg);
        }
    });
}

fn done(
    ui: &mut Ui,
    cells: &mut Cells,
    result: &Result<CellFit, String>,
    editor: &mut Editor,
    leg: &mut ShownLeg,
) {
    let palette = palette(ui.ctx());
    match result {
        Ok(found) => {
            let settings = editor.settings();
            table(ui, cells, found, &settings.axes[cells.cell.min(2)]);
            sentence(ui, 1, "Put the tendon back on its cell.");
            sentence(
                ui,
                2,
                "Put the result into the settings; apply or set them there. The leg has to home then.",
            );
            if button(ui, "Put it into the settings", "cells_take", None).clicked() {
                for (key, value) in cells.values(found, &settings) {
                    editor.set("calibration", key, &value);
                }
                cells.cancel(leg);
                return;
            }
        }
        Err(words) => {
            let words = RichText::new(words).monospace().color(palette.error);
            place(&ui.add(Label::new(words).wrap()), "cells_failed");
        }
    }
    if button(ui, "Once more", "cells_again", None).clicked() {
        cells.cancel(leg);
    }
}

/// The result beside what is set.
fn table(
    ui: &mut Ui,
    cells: &Cells,
    found: &CellFit,
    set: &leg_firmware::settings::AxisCalibration,
) {
    let mono = |ui: &mut Ui, text: String| ui.label(RichText::new(text).monospace());
    let grid = Grid::new("cells result")
        .num_columns(3)
        .spacing([16.0, 3.0]);
    let shown = grid.show(ui, |ui| {
        for heading in ["", "found", "set"] {
            ui.strong(heading);
        }
        ui.end_row();
        ui.label("tension by code, N");
        mono(ui, format!("{:.6}", found.n_per_code));
        mono(ui, format!("{:.6}", set.cell_n_per_code));
        ui.end_row();
        ui.label("code without tension");
        mono(ui, format!("{:.1}", found.zero_code));
        mono(ui, format!("{:.1}", set.cell_zero_code));
        ui.end_row();
        for weighing in cells.weighings() {
            let found_n = (weighing.code - found.zero_code) * found.n_per_code;
            ui.label(format!("{:.2} N hung, found", weighing.newtons));
            mono(ui, format!("{found_n:.3} N"));
            let set_n =
                (weighing.code - f64::from(set.cell_zero_code)) * f64::from(set.cell_n_per_code);
            mono(ui, format!("{set_n:.3} N"));
            ui.end_row();
        }
        ui.label("off the line at most");
        mono(ui, format!("{:.3} N", found.residual_n));
        ui.end_row();
    });
    place(&shown.response, "cells_result");
}
