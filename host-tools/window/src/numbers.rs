//! The leg in numbers that stay in their places.

use crate::places::{place, place_rect};
use crate::seen_leg::SeenLeg;
use crate::theme::{self, palette};
use egui::{Color32, Grid, RichText, Ui};
use leg_base::angles;

/// What is shown as zero has no sign.
fn unsigned_zero(value: f32) -> f32 {
    if value.abs() < 0.05 { 0.0 } else { value }
}

/// Shows them.
pub fn show(ui: &mut Ui, leg: &SeenLeg<'_>) {
    let Some(telemetry) = &leg.telemetry else {
        return;
    };
    let [azimuth_deg, tilt_deg] = angles::angles_deg(telemetry.pose.map(f64::from));
    let palette = palette(ui.ctx());
    let faint = |words: &str| RichText::new(words).color(palette.faint);
    let doubt = leg.doubt();
    let estimated = if doubt.is_some() {
        palette.faint
    } else {
        palette.text
    };
    let grid = Grid::new("numbers")
        .num_columns(2)
        .spacing([12.0, 3.0])
        .min_row_height(16.0);
    let shown = grid.show(ui, |ui| {
        let simulated = leg.is_true;
        if simulated {
            row(
                ui,
                faint("off target, true"),
                leg.error_mm,
                "mm",
                palette.text,
            );
        }
        let from = if leg.is_heard {
            "from the sensors:"
        } else {
            "last heard:"
        };
        let source = if simulated {
            "What the leg concludes from its sensors. The leg is drawn as it truly is."
        } else {
            "What the leg concludes from its sensors. The leg is drawn like that."
        };
        ui.label(faint(from)).on_hover_text(source);
        if let Some(words) = doubt {
            let words = RichText::new(format!("✖ {words}")).color(palette.error);
            place(&ui.label(words), "doubt");
        }
        ui.end_row();
        if !simulated {
            row(ui, faint("off target"), leg.error_mm, "mm", estimated);
        }
        row(ui, faint("azimuth"), azimuth_deg, "°", estimated);
        row(ui, faint("tilt"), tilt_deg, "°", estimated);
        let payload_kg = telemetry.payload_kg.into();
        row(ui, faint("payload"), payload_kg, "kg", estimated);
        let elongation = f64::from(telemetry.elongation_factor);
        // Only where the leg has found that its tendons are not as the settings say.
        if elongation != 1.0 {
            row(ui, faint("elongation"), elongation, "×", estimated);
        }
        ui.label(faint("tensions"));
        tensions(ui, telemetry.tensions_n);
        ui.end_row();
    });
    place_rect(ui.ctx(), shown.response.rect, "numbers");
}

fn row(ui: &mut Ui, name: RichText, value: f64, unit: &str, colour: Color32) {
    ui.label(name);
    let words = RichText::new(format!("{value:8.2} {unit}")).monospace();
    ui.label(words.color(colour));
    ui.end_row();
}

fn tensions(ui: &mut Ui, tensions_n: [f32; 3]) {
    ui.horizontal(|ui| {
        for (tendon, tension_n) in tensions_n.into_iter().enumerate() {
            let words = RichText::new(format!("{:5.1}", unsigned_zero(tension_n)));
            ui.label(words.monospace().color(theme::series(ui.ctx(), tendon)));
        }
        ui.label(RichText::new("N").monospace());
    });
}
