//! The leg in numbers that stay in their places.

use crate::simulation::Simulation;
use crate::theme::{self, palette};
use eframe::egui::{Grid, RichText, Ui};
use leg_base::angles;

/// What is shown as zero has no sign.
fn unsigned_zero(value: f32) -> f32 {
    if value.abs() < 0.05 { 0.0 } else { value }
}

/// Shows them.
pub fn show(ui: &mut Ui, simulation: &Simulation) {
    let Some(telemetry) = simulation.telemetry() else {
        return;
    };
    let comparison = simulation.leg().comparison();
    let [azimuth_deg, tilt_deg] = angles::angles_deg(telemetry.pose.map(f64::from));
    let rows = [
        ("off target", comparison.commanded_error_mm(), "mm"),
        ("azimuth", azimuth_deg, "°"),
        ("tilt", tilt_deg, "°"),
        ("payload, felt", telemetry.payload_kg.into(), "kg"),
    ];
    let palette = palette(ui.ctx());
    Grid::new("numbers")
        .num_columns(2)
        .spacing([12.0, 3.0])
        .min_row_height(16.0)
        .show(ui, |ui| {
            for (name, value, unit) in rows {
                ui.label(RichText::new(name).color(palette.faint));
                ui.label(RichText::new(format!("{value:8.2} {unit}")).monospace());
                ui.end_row();
            }
            ui.label(RichText::new("tensions").color(palette.faint));
            ui.horizontal(|ui| {
                for (tendon, tension_n) in telemetry.tensions_n.into_iter().enumerate() {
                    let colour = theme::series(ui.ctx(), tendon);
                    ui.label(
                        RichText::new(format!("{:5.1}", unsigned_zero(tension_n)))
                            .monospace()
                            .color(colour),
                    );
                }
                ui.label(RichText::new("N").monospace());
            });
            ui.end_row();
        });
}
