//! The leg in numbers that stay in their places.

use crate::places::place_rect;
use crate::seen_leg::SeenLeg;
use crate::theme::{self, palette};
use eframe::egui::{Grid, RichText, Ui};
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
    let grid = Grid::new("numbers")
        .num_columns(2)
        .spacing([12.0, 3.0])
        .min_row_height(16.0);
    let shown = grid.show(ui, |ui| {
        let simulated = leg.is_true;
        if simulated {
            row(ui, faint("off target, true"), leg.error_mm, "mm");
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
        ui.end_row();
        if !simulated {
            row(ui, faint("off target"), leg.error_mm, "mm");
        }
        row(ui, faint("azimuth"), azimuth_deg, "°");
        row(ui, faint("tilt"), tilt_deg, "°");
        row(ui, faint("payload"), telemetry.payload_kg.into(), "kg");
        ui.label(faint("tensions"));
        tensions(ui, telemetry.tensions_n);
        ui.end_row();
    });
    place_rect(ui.ctx(), shown.response.rect, "numbers");
}

fn row(ui: &mut Ui, name: RichText, value: f64, unit: &str) {
    ui.label(name);
    ui.label(RichText::new(format!("{value:8.2} {unit}")).monospace());
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
