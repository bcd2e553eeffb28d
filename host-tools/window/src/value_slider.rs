//! A value that is dragged, or typed, while the leg reports it anew in every frame.

use crate::places::place;
use crate::text::{left, why};
use egui::{Slider, SliderClamping, Ui};
use std::ops::RangeInclusive;

/// What a slider leaves for its name and its value, points.
const LABEL_WIDTH: f32 = 68.0;
const VALUE_WIDTH: f32 = 112.0;

/// A slider with its value beside it.
pub struct ValueSlider {
    /// Its name for tests.
    pub name: &'static str,
    /// What its row says.
    pub text: &'static str,
    /// What stands behind the value.
    pub unit: &'static str,
    /// Digits of the value after the point.
    pub decimals: usize,
    /// From one value to the next; 0 for any.
    pub step: f64,
}

impl ValueSlider {
    /// Shows a value, which may be beyond the slider's ends; gives the one that was chosen by hand. A typed one is chosen by Enter,
    /// or by leaving its field: its first digit is none.
    pub fn show(
        &self,
        ui: &mut Ui,
        value: f64,
        range: RangeInclusive<f64>,
        locked: Option<&str>,
    ) -> Option<f64> {
        ui.horizontal(|ui| {
            left(ui, LABEL_WIDTH, self.text);
            ui.spacing_mut().slider_width = (ui.available_width() - VALUE_WIDTH).clamp(60.0, 220.0);
            // A value that changes under what is typed would take that away.
            let kept = ui.scope_id().with(self.name);
            let mut shown = ui.data(|data| data.get_temp(kept)).unwrap_or(value);
            let slider = Slider::new(&mut shown, range)
                .suffix(self.unit)
                .step_by(self.step)
                .fixed_decimals(self.decimals)
                .clamping(SliderClamping::Edits)
                .update_while_editing(false)
                .custom_parser(number);
            let response = ui.add_enabled(locked.is_none(), slider);
            place(&response, self.name);
            let typing = response.has_focus() && ui.ctx().text_edit_focused();
            ui.data_mut(|data| {
                if typing {
                    data.insert_temp(kept, shown);
                } else {
                    data.remove::<f64>(kept);
                }
            });
            why(response, locked).changed().then_some(shown)
        })
        .inner
    }
}

/// A number that is typed, with or without a long minus.
fn number(text: &str) -> Option<f64> {
    let number: f64 = text.trim().replace('−', "-").parse().ok()?;
    number.is_finite().then_some(number)
}
