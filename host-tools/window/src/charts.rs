//! Signals over time, chosen by name.

use crate::history::{Column, History, KEPT_S};
use crate::places::place;
use crate::theme;
use eframe::egui::{ComboBox, Id, RichText, ScrollArea, TextEdit, Ui, Vec2b};
use egui_plot::{GridInput, GridMark, Line, Plot, PlotPoints};

/// Points of a line: more than a screen has.
const POINTS_MAX: usize = 1200;

/// Times that a chart may show, s.
const SPANS_S: [f64; 4] = [2.0, 5.0, 10.0, KEPT_S];

/// What is charted, and how.
pub struct Charts {
    /// The names of the signals, one chart each.
    chosen: Vec<&'static str>,
    span_s: f64,
    /// The time at which the charts stand still, s.
    paused_s: Option<f64>,
    /// A part of a name that is looked for.
    search: String,
}

impl Default for Charts {
    fn default() -> Self {
        Self {
            chosen: vec!["tip_error_mm", "tensions_n"],
            span_s: SPANS_S[2],
            paused_s: None,
            search: String::new(),
        }
    }
}

impl Charts {
    /// Shows the charts beside each other, or below where there is no room for that.
    pub fn show(&mut self, ui: &mut Ui, history: &History, now_s: f64, height: f32) {
        self.controls(ui, history, now_s);
        let until_s = self.paused_s.unwrap_or(now_s);
        if self.chosen.is_empty() {
            ui.label("Choose a signal to see it over time.");
        }
        let columns: Vec<Column> = self
            .chosen
            .iter()
            .filter_map(|name| history.named(name))
            .collect();
        if ui.available_width() > 560.0 && columns.len() > 1 {
            ui.columns(columns.len(), |parts| {
                for (part, column) in parts.iter_mut().zip(&columns) {
                    self.chart(part, history, *column, until_s, height);
                }
            });
        } else {
            for column in columns {
                self.chart(ui, history, column, until_s, height);
            }
        }
    }

    fn controls(&mut self, ui: &mut Ui, history: &History, now_s: f64) {
        ui.horizontal_wrapped(|ui| {
            ui.heading("Charts");
            let menu = ComboBox::from_id_salt("signals")
                .selected_text("Signals")
                .width(110.0);
            let menu = menu.show_ui(ui, |ui| self.choice(ui, history));
            place(&menu.response, "signals");
            let span =
                ComboBox::from_id_salt("span").selected_text(format!("{:.0} s", self.span_s));
            span.width(64.0).show_ui(ui, |ui| {
                for span_s in SPANS_S {
                    ui.selectable_value(&mut self.span_s, span_s, format!("{span_s:.0} s"));
                }
            });
            let (text, next) = match self.paused_s {
                None => ("Pause", Some(now_s)),
                Some(_) => ("Go on", None),
            };
            let pause = ui.button(text).on_hover_text(
                "A paused chart can be dragged and zoomed; a double click shows it whole.",
            );
            place(&pause, "pause");
            if pause.clicked() {
                self.paused_s = next;
            }
        });
    }

    fn choice(&mut self, ui: &mut Ui, history: &History) {
        ui.set_min_width(270.0);
        ui.add(TextEdit::singleline(&mut self.search).hint_text("part of a name"));
        ScrollArea::vertical().max_height(260.0).show(ui, |ui| {
            for column in history.columns() {
                let name = column.name();
                if !name.contains(self.search.trim()) {
                    continue;
                }
                let mut on = self.chosen.contains(&name);
                let response = ui.checkbox(&mut on, RichText::new(name).monospace());
                if response.on_hover_text(column.meaning()).changed() {
                    self.chosen.retain(|other| *other != name);
                    if on {
                        self.chosen.push(name);
                    }
                }
            }
        });
    }

    fn chart(&self, ui: &mut Ui, history: &History, column: Column, until_s: f64, height: f32) {
        let name = column.name();
        title(ui, &column);
        let paused = self.paused_s.is_some();
        let link = Id::unique("charts");
        let since_s = (until_s - self.span_s).max(0.0);
        let plot = Plot::new(name)
            .height((height - 24.0).max(60.0))
            .grid_color(theme::palette(ui.ctx()).line)
            .link_axis(link, Vec2b::new(true, false))
            .link_cursor(link, Vec2b::new(true, false))
            .allow_drag(paused)
            .allow_zoom(paused)
            .allow_scroll(paused)
            .allow_boxed_zoom(paused)
            .x_grid_spacer(|input| grid(&input, 4.0))
            .y_grid_spacer(|input| grid(&input, 4.0))
            .x_axis_formatter(|mark, _| format!("{} s", short(mark.value)))
            .y_axis_formatter(|mark, _| short(mark.value))
            .y_axis_min_width(44.0);
        let colours: Vec<_> = (0..column.width)
            .map(|i| theme::series(ui.ctx(), i))
            .collect();
        plot.show(ui, |plot| {
            if !paused {
                plot.set_plot_bounds_x(since_s..=(since_s + self.span_s));
                plot.set_auto_bounds(Vec2b::new(false, true));
            }
            for (number, colour) in colours.into_iter().enumerate() {
                // A paused chart may be dragged to what was before.
                let from_s = if paused { until_s - KEPT_S } else { since_s };
                let points = history.line(column, number, from_s);
                let points = thinned(
                    points
                        .take_while(|[time_s, _]| *time_s <= until_s)
                        .collect(),
                );
                let label = if column.width > 1 {
                    (number + 1).to_string()
                } else {
                    String::new()
                };
                plot.line(
                    Line::new(label, PlotPoints::from(points))
                        .color(colour)
                        .width(1.6),
                );
            }
        });
    }
}

/// The name of a signal, and the colours of its numbers.
fn title(ui: &mut Ui, column: &Column) {
    ui.horizontal(|ui| {
        let name = RichText::new(column.name()).monospace().size(12.0);
        ui.label(name).on_hover_text(column.meaning());
        for number in 0..column.width {
            if column.width > 1 {
                let words = format!("● {}", number + 1);
                let colour = theme::series(ui.ctx(), number);
                ui.label(RichText::new(words).size(12.0).color(colour));
            }
        }
    });
}

/// Some lines of a grid at round numbers.
fn grid(input: &GridInput, lines: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let step_size = round_step((high - low) / lines);
    let first = (low / step_size).ceil();
    // A plot of no height has no lines.
    let count = ((high - low) / step_size).min(100.0) as u32;
    let mark = |line: u32| GridMark {
        value: (first + f64::from(line)) * step_size,
        step_size,
    };
    let marks = (0..=count).map(mark);
    // What is beyond the edge would have its label there.
    marks.filter(|mark| mark.value <= high).collect()
}

/// The next larger of 1, 2 and 5 with any power of ten.
fn round_step(step: f64) -> f64 {
    let unit = 10_f64.powf(step.max(1e-9).log10().floor());
    let part = step / unit;
    let round = [1.0, 2.0, 5.0].into_iter().find(|round| part <= *round);
    unit * round.unwrap_or(10.0)
}

/// A number without what its rounding leaves.
fn short(value: f64) -> String {
    // Adding zero takes the sign of one away.
    let rounded = (value * 1e6).round() / 1e6 + 0.0;
    format!("{rounded}")
}

/// The lowest and the highest point of each of so many parts: no peak is lost.
fn thinned(points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    if points.len() <= POINTS_MAX {
        return points;
    }
    let size = points.len().div_ceil(POINTS_MAX / 2);
    let mut kept = Vec::with_capacity(POINTS_MAX);
    for part in points.chunks(size) {
        let lowest = part.iter().min_by(|a, b| a[1].total_cmp(&b[1]));
        let highest = part.iter().max_by(|a, b| a[1].total_cmp(&b[1]));
        let (Some(a), Some(b)) = (lowest, highest) else {
            continue;
        };
        let [first, second] = if a[0] <= b[0] { [*a, *b] } else { [*b, *a] };
        kept.push(first);
        kept.push(second);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::{POINTS_MAX, round_step, short, thinned};

    #[test]
    fn lines_of_a_grid_are_at_round_numbers() {
        for (step, round) in [
            (1.0, 1.0),
            (1.1, 2.0),
            (0.03, 0.05),
            (37.0, 50.0),
            (60.0, 100.0),
        ] {
            assert!((round_step(step) / round - 1.0).abs() < 1e-12, "{step}");
        }
        assert!(round_step(0.0) > 0.0);
        assert_eq!(
            [0.1 + 0.2, -0.0, 1.0 / 3.0].map(short),
            ["0.3", "0", "0.333333"]
        );
    }

    #[test]
    fn no_peak_is_lost() {
        let mut points: Vec<[f64; 2]> = (0..20_000).map(|i| [f64::from(i), 0.0]).collect();
        points[7_777][1] = 5.0;
        points[13_131][1] = -3.0;
        let kept = thinned(points);
        assert!(kept.len() <= POINTS_MAX);
        assert!(kept.contains(&[7_777.0, 5.0]) && kept.contains(&[13_131.0, -3.0]));
        assert!(kept.is_sorted_by(|a, b| a[0] <= b[0]));
        let few = vec![[0.0, 1.0], [1.0, 2.0]];
        assert_eq!(thinned(few.clone()), few);
    }
}
