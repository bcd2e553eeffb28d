//! One chart: a signal over time, or its spectrum.

use super::Charts;
use super::cursors::{NAMES, values_words};
use super::lines::{LABEL_PART, grid, label_width, labelled, least_range, lines, short, thinned};
use super::signal_source::ShownSignals;
use super::spectrum::Spectrum;
use crate::history::Column;
use crate::places::place;
use crate::pointer;
use crate::theme;
use egui::{Align2, FontId, Id, Response, RichText, Ui, Vec2b, pos2};
use egui_plot::{Line, Plot, PlotPoint, PlotPoints, PlotUi, VLine};

/// Height of a line of words above a chart, points.
const TITLE_HEIGHT: f32 = 32.0;
pub(super) const VALUES_HEIGHT: f32 = 15.0;

/// The least height of a chart, points.
const HEIGHT_MIN: f32 = 60.0;

/// A signal as it was drawn last: as long as nothing changes it is drawn so again.
pub(super) struct Kept {
    drawn_s: [f64; 2],
    lines: Vec<Vec<[f64; 2]>>,
    /// None until they are looked at.
    spectra: Option<Vec<Option<Spectrum>>>,
}

impl Kept {
    /// The highest peak of its first number.
    pub fn peak(&self) -> Option<[f64; 2]> {
        let spectra = self.spectra.as_ref()?;
        spectra.first()?.as_ref()?.peak
    }
}

impl Charts {
    /// A chart of a signal. The time at which it was pressed, s.
    pub(super) fn chart(
        &mut self,
        ui: &mut Ui,
        shown: ShownSignals<'_>,
        column: Column,
        height: f32,
    ) -> Option<f64> {
        let kept = self.take_kept(&shown, column);
        let pressed_s = if self.spectra {
            spectrum(ui, &kept, column, height);
            None
        } else {
            self.draw_times(ui, shown, column, &kept, height)
        };
        self.kept.insert(column.name(), kept);
        pressed_s
    }

    /// What is drawn of a signal: what was drawn before, if that is still so.
    fn take_kept(&mut self, shown: &ShownSignals<'_>, column: Column) -> Kept {
        let same = |kept: &Kept| shown.still && kept.drawn_s == shown.drawn_s;
        let before = self.kept.remove(column.name()).filter(same);
        let mut kept = before.unwrap_or_else(|| Kept {
            drawn_s: shown.drawn_s,
            lines: lines(shown.history, column, shown.drawn_s),
            spectra: None,
        });
        if self.spectra {
            kept.spectra
                .get_or_insert_with(|| kept.lines.iter().map(|line| Spectrum::new(line)).collect());
        }
        kept
    }

    fn draw_times(
        &mut self,
        ui: &mut Ui,
        shown: ShownSignals<'_>,
        column: Column,
        kept: &Kept,
        height: f32,
    ) -> Option<f64> {
        title(ui, &column);
        let used = self.values(ui, &shown, column);
        let still = shown.still;
        let recorded = shown.moment_s.is_some();
        let drags = still && self.cursors.is_none();
        let link = Id::unique(if recorded { "recorded" } else { "charts" });
        let thin: Vec<_> = kept.lines.iter().map(|line| thinned(line)).collect();
        let plot = Plot::new((column.name(), recorded))
            .height((height - TITLE_HEIGHT - used).max(HEIGHT_MIN))
            .grid_color(theme::palette(ui.ctx()).line)
            .link_axis(link, Vec2b::new(true, false))
            .link_cursor(link, Vec2b::new(true, false))
            .allow_drag(drags)
            .allow_zoom(still)
            .allow_scroll(still)
            .allow_boxed_zoom(drags)
            .x_grid_spacer(|input| grid(&input, LABEL_PART))
            .y_grid_spacer(|input| grid(&input, 0.0))
            .x_axis_formatter(|mark, _| format!("{} s", short(mark.value)))
            .y_axis_formatter(|mark, _| labelled(mark.value, column.unit()))
            .y_axis_min_width(label_width(column.unit()));
        let least = least_range(&thin).into_iter().flatten();
        let plot = least.fold(plot, Plot::include_y);
        let colours = colours(ui, column);
        let palette = theme::palette(ui.ctx());
        let marks = self.marks(&shown, [palette.target, palette.warning, palette.text]);
        let wanted_s = self.wanted_s;
        let drawn = plot.show(ui, |plot| {
            let [since_s, _] = shown.drawn_s;
            if !still {
                plot.set_plot_bounds_x(since_s..=(since_s + self.span_s));
                plot.set_auto_bounds(Vec2b::new(false, true));
            } else if let Some([since_s, until_s]) = wanted_s {
                plot.set_plot_bounds_x(since_s..=until_s);
                plot.set_auto_bounds(Vec2b::new(false, true));
            }
            draw(plot, thin, &colours);
            for (_, at_s, colour) in &marks {
                plot.vline(VLine::new("", *at_s).color(*colour).width(1.5));
            }
            plot.auto_bounds().x
        });
        if still {
            let bounds = drawn.transform.bounds();
            let seen_s = [bounds.min()[0], bounds.max()[0]];
            self.zoomed_s = (!drawn.inner || wanted_s.is_some()).then_some(seen_s);
        }
        for (name, at_s, colour) in marks {
            let at = drawn
                .transform
                .position_from_point(&PlotPoint::new(at_s, 0.0));
            let at = pos2(at.x + 3.0, drawn.response.rect.top() + 2.0);
            let painter = ui.painter_at(drawn.response.rect);
            painter.text(at, Align2::LEFT_TOP, name, FontId::monospace(12.0), colour);
        }
        place(&drawn.response, column.name());
        let at = pointer::place(&drawn.response);
        let at_s = at.map(|at| drawn.transform.value_from_position(at).x);
        self.touch(&drawn.response, at_s, shown.whole_s)
    }

    /// A press or a drag in a chart at a time, s. The time that a press asks for, s.
    fn touch(&mut self, response: &Response, at_s: Option<f64>, whole_s: [f64; 2]) -> Option<f64> {
        let [since_s, until_s] = whole_s;
        let at_s = at_s?.clamp(since_s, until_s.max(since_s));
        let Some(cursors) = &mut self.cursors else {
            return response.clicked().then_some(at_s);
        };
        if response.clicked() || response.dragged() {
            cursors.draw(at_s);
        }
        if response.clicked() || response.drag_stopped() {
            cursors.let_go();
        }
        None
    }

    /// The lines across a chart: the moment of a recording, what the trigger caught, the cursors.
    fn marks<T: Copy>(
        &self,
        shown: &ShownSignals<'_>,
        [moment, trigger, cursor]: [T; 3],
    ) -> Vec<(&'static str, f64, T)> {
        let mut marks = Vec::new();
        marks.extend(shown.moment_s.map(|at_s| ("", at_s, moment)));
        if shown.moment_s.is_none() {
            let caught_s = self.trigger.caught_s();
            marks.extend(caught_s.map(|at_s| ("T", at_s, trigger)));
        }
        if let Some(cursors) = &self.cursors {
            let named = NAMES.into_iter().zip(cursors.at_s);
            marks.extend(named.map(|(name, at_s)| (name, at_s, cursor)));
        }
        marks
    }

    /// The values at the cursors, if there are some. How high that is, points.
    fn values(&self, ui: &mut Ui, shown: &ShownSignals<'_>, column: Column) -> f32 {
        let Some(cursors) = &self.cursors else {
            return 0.0;
        };
        ui.scope(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for (number, colour) in colours(ui, column).into_iter().enumerate() {
                let words =
                    values_words(cursors.values(shown.history, column, number), column.unit());
                let text = RichText::new(words).monospace().size(11.0).color(colour);
                let label = ui.label(text);
                if number == 0 {
                    place(&label, format!("values_{}", column.name()));
                }
            }
        });
        VALUES_HEIGHT * column.width as f32 + ui.spacing().item_spacing.y
    }
}

/// The spectrum of each number of a signal.
fn spectrum(ui: &mut Ui, kept: &Kept, column: Column, height: f32) {
    let spectra = kept.spectra.as_deref().unwrap_or_default();
    let of = |number: usize| spectra.get(number).and_then(Option::as_ref);
    title(ui, &column);
    let unit = column.unit();
    let colours = colours(ui, column);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for (number, colour) in colours.iter().enumerate() {
            let words = of(number)
                .map_or_else(|| "too few samples".into(), |spectrum| spectrum.words(unit));
            let text = RichText::new(words).monospace().size(11.0).color(*colour);
            let label = ui.label(text);
            if number == 0 {
                place(&label, format!("peak_{}", column.name()));
            }
        }
    });
    let used = TITLE_HEIGHT + VALUES_HEIGHT * column.width as f32 + ui.spacing().item_spacing.y;
    let plot = Plot::new((column.name(), "spectrum"))
        .height((height - used).max(HEIGHT_MIN))
        .grid_color(theme::palette(ui.ctx()).line)
        .include_x(0.0)
        .include_y(0.0)
        .x_grid_spacer(|input| grid(&input, LABEL_PART))
        .y_grid_spacer(|input| grid(&input, 0.0))
        .x_axis_formatter(|mark, _| format!("{} Hz", short(mark.value)))
        .y_axis_formatter(|mark, _| labelled(mark.value, column.unit()))
        .y_axis_min_width(label_width(column.unit()));
    let lines = (0..column.width)
        .map(|number| of(number).map_or_else(Vec::new, |spectrum| thinned(&spectrum.lines)));
    let lines = lines.collect();
    let shown = plot.show(ui, |plot| draw(plot, lines, &colours));
    place(&shown.response, format!("spectrum_{}", column.name()));
}

fn colours(ui: &Ui, column: Column) -> Vec<egui::Color32> {
    (0..column.width)
        .map(|number| theme::series(ui.ctx(), number))
        .collect()
}

fn draw(plot: &mut PlotUi<'_>, lines: Vec<Vec<[f64; 2]>>, colours: &[egui::Color32]) {
    let several = lines.len() > 1;
    for (number, (points, colour)) in lines.into_iter().zip(colours).enumerate() {
        let label = if several {
            (number + 1).to_string()
        } else {
            String::new()
        };
        let line = Line::new(label, PlotPoints::from(points));
        plot.line(line.color(*colour).width(1.6));
    }
}

/// The name of a signal, and the colours of its numbers.
fn title(ui: &mut Ui, column: &Column) {
    ui.horizontal(|ui| {
        let name = RichText::new(column.name()).monospace().size(12.0);
        ui.label(name).on_hover_text(column.meaning());
        for number in 0..column.width {
            if column.width > 1 {
                let words = format!("● {}", column.part_name(number));
                let colour = theme::series(ui.ctx(), number);
                ui.label(RichText::new(words).size(12.0).color(colour));
            }
        }
    });
}
