//! Signals over time, chosen by name.

use crate::history::{Column, History, KEPT_S};
use crate::places::{place, place_rect};
use crate::shown_leg::ShownLeg;
use crate::theme;
use eframe::egui::{
    Button, ComboBox, Id, PopupCloseBehavior, RichText, ScrollArea, TextEdit, Ui, Vec2b, vec2,
};
use egui_plot::{GridInput, GridMark, Line, Plot, PlotPoints, VLine};

/// Points of a line: more than a screen has.
const POINTS_MAX: usize = 1200;

/// The least height of a chart, as a part of its largest value.
const RANGE_MIN: f64 = 0.01;

/// About as many lines a grid has.
const GRID_LINES: f64 = 4.0;

/// What half a label of the time takes of a chart's width.
const LABEL_PART: f64 = 0.06;

/// Times that a chart may show, s.
const SPANS_S: [f64; 4] = [2.0, 5.0, 10.0, KEPT_S];

/// What is charted, and how.
pub struct Charts {
    /// The names of the signals, one chart each.
    chosen: Vec<&'static str>,
    span_s: f64,
    /// What the charts show while they are paused.
    paused: Option<Paused>,
    /// A part of a name that is looked for.
    search: String,
}

/// Where the signals are from.
pub struct Source<'a> {
    /// They.
    pub history: &'a History,
    /// From when to when there are some, s.
    pub since_s: f64,
    /// s.
    pub now_s: f64,
    /// The time at which a recording is, s; none of a leg that goes on.
    pub moment_s: Option<f64>,
}

impl<'a> Source<'a> {
    /// Of a leg that goes on.
    #[must_use]
    pub fn of_leg(leg: &'a ShownLeg) -> Self {
        let now_s = leg.time_s();
        Self {
            history: leg.history(),
            since_s: (now_s - KEPT_S).max(0.0),
            now_s,
            moment_s: None,
        }
    }
}

/// What the charts show of it.
#[derive(Clone, Copy)]
struct Shown<'a> {
    history: &'a History,
    /// s.
    until_s: f64,
    since_s: f64,
    moment_s: Option<f64>,
    /// Whether it stands still, and may be dragged and zoomed.
    still: bool,
}

/// The signals up to a time at which the charts were paused: the leg's own history goes on.
struct Paused {
    history: History,
    /// s.
    until_s: f64,
}

impl Default for Charts {
    fn default() -> Self {
        Self {
            chosen: vec!["tip_error_mm", "tensions_n"],
            span_s: SPANS_S[2],
            paused: None,
            search: String::new(),
        }
    }
}

impl Charts {
    /// What is charted of a leg of which only its reports are known.
    #[must_use]
    pub fn of_live_leg() -> Self {
        Self {
            chosen: vec!["tip_estimated_mm", "tensions_n"],
            ..Self::default()
        }
    }

    /// Shows the charts beside each other, or below where there is no room for that. The time at which one was pressed, s.
    pub fn show(&mut self, ui: &mut Ui, source: &Source<'_>, height: f32) -> Option<f64> {
        if self.chosen.is_empty() {
            ui.label("Choose a signal to see it over time.");
        }
        let shown = self.shown(source);
        let names = self.chosen.iter();
        let named = names.filter_map(|name| source.history.named(name));
        let columns: Vec<Column> = named.collect();
        let top = ui.cursor().top();
        let mut pressed_s = None;
        if ui.available_width() > 560.0 && columns.len() > 1 {
            ui.columns(columns.len(), |parts| {
                for (part, column) in parts.iter_mut().zip(&columns) {
                    pressed_s = pressed_s.or(self.chart(part, shown, *column, height));
                }
            });
        } else {
            for column in columns {
                pressed_s = pressed_s.or(self.chart(ui, shown, column, height));
            }
        }
        place_rect(ui.ctx(), ui.min_rect().with_min_y(top), "charts");
        pressed_s
    }

    /// Pauses, or goes on.
    fn pause(&mut self, history: &History, now_s: f64) {
        self.paused = match self.paused {
            Some(_) => None,
            None => Some(Paused {
                history: history.clone(),
                until_s: now_s,
            }),
        };
    }

    /// Whether they stand still.
    #[must_use]
    pub const fn paused(&self) -> bool {
        self.paused.is_some()
    }

    /// Goes on: there is another leg.
    pub fn go_on(&mut self) {
        self.paused = None;
    }

    /// What is charted of a source.
    fn shown<'a>(&'a self, source: &Source<'a>) -> Shown<'a> {
        let (history, until_s) = match &self.paused {
            Some(paused) => (&paused.history, paused.until_s),
            None => (source.history, source.now_s),
        };
        Shown {
            history,
            until_s,
            since_s: if source.moment_s.is_some() {
                source.since_s
            } else {
                (until_s - KEPT_S).max(0.0)
            },
            moment_s: source.moment_s,
            still: source.moment_s.is_some() || self.paused(),
        }
    }

    /// What is charted, and how.
    pub fn controls(&mut self, ui: &mut Ui, source: &Source<'_>) {
        ui.heading("Charts");
        let menu = ComboBox::from_id_salt("signals")
            .selected_text("Signals")
            .width(110.0)
            // Several signals may be chosen, and a name is typed.
            .close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        let menu = menu.show_ui(ui, |ui| self.choice(ui, source.history));
        place(&menu.response, "signals");
        if source.moment_s.is_none() {
            self.follow(ui, source);
        }
    }

    /// How much of a leg is charted that goes on, and whether the charts stand still.
    fn follow(&mut self, ui: &mut Ui, source: &Source<'_>) {
        let span = ComboBox::from_id_salt("span").selected_text(format!("{:.0} s", self.span_s));
        span.width(64.0).show_ui(ui, |ui| {
            for span_s in SPANS_S {
                ui.selectable_value(&mut self.span_s, span_s, format!("{span_s:.0} s"));
            }
        });
        let text = if self.paused() { "Go on" } else { "Pause" };
        let pause = ui.add(Button::new(text).min_size(vec2(52.0, 0.0)));
        place(&pause, "pause");
        let hint = "A paused chart can be dragged and zoomed; a double click shows it whole.";
        if pause.on_hover_text(hint).clicked() {
            self.pause(source.history, source.now_s);
        }
    }

    fn choice(&mut self, ui: &mut Ui, history: &History) {
        ui.set_min_width(270.0);
        let search = TextEdit::singleline(&mut self.search).hint_text("part of a name");
        place(&ui.add(search), "search");
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

    /// A chart of a signal. The time at which it was pressed, s.
    fn chart(&self, ui: &mut Ui, shown: Shown<'_>, column: Column, height: f32) -> Option<f64> {
        let name = column.name();
        title(ui, &column);
        let still = shown.still;
        let recorded = shown.moment_s.is_some();
        let link = Id::unique(if recorded { "recorded" } else { "charts" });
        let since_s = (shown.until_s - self.span_s).max(0.0);
        let plot = Plot::new((name, recorded))
            .height((height - 24.0).max(60.0))
            .grid_color(theme::palette(ui.ctx()).line)
            .link_axis(link, Vec2b::new(true, false))
            .link_cursor(link, Vec2b::new(true, false))
            .allow_drag(still)
            .allow_zoom(still)
            .allow_scroll(still)
            .allow_boxed_zoom(still)
            .x_grid_spacer(|input| grid(&input, LABEL_PART))
            .y_grid_spacer(|input| grid(&input, 0.0))
            .x_axis_formatter(|mark, _| format!("{} s", short(mark.value)))
            .y_axis_formatter(|mark, _| short(mark.value))
            .y_axis_min_width(44.0);
        // A chart that stands still may be dragged to what was before.
        let from_s = if still { shown.since_s } else { since_s };
        let lines = lines(shown.history, column, [from_s, shown.until_s]);
        let plot = least_range(&lines)
            .into_iter()
            .flatten()
            .fold(plot, Plot::include_y);
        let colours: Vec<_> = (0..column.width)
            .map(|i| theme::series(ui.ctx(), i))
            .collect();
        let moment = theme::palette(ui.ctx()).target;
        let shown = plot.show(ui, |plot| {
            if !still {
                plot.set_plot_bounds_x(since_s..=(since_s + self.span_s));
                plot.set_auto_bounds(Vec2b::new(false, true));
            }
            for (number, (points, colour)) in lines.into_iter().zip(colours).enumerate() {
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
            if let Some(moment_s) = shown.moment_s {
                plot.vline(VLine::new("", moment_s).color(moment).width(1.5));
            }
        });
        let pressed = shown.response.clicked();
        let at = pressed.then(|| shown.response.interact_pointer_pos())?;
        at.map(|at| shown.transform.value_from_position(at).x)
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

/// Each number of a signal between two times, s.
fn lines(history: &History, column: Column, [from_s, until_s]: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let line = |number| {
        let points = history.line(column, number, from_s);
        thinned(
            points
                .take_while(|[time_s, _]| *time_s <= until_s)
                .collect(),
        )
    };
    (0..column.width).map(line).collect()
}

/// What a chart shows at least, so that it does not show rounding errors alone; none without points.
fn least_range(lines: &[Vec<[f64; 2]>]) -> Option<[f64; 2]> {
    let values = || lines.iter().flatten().map(|[_, value]| *value);
    let low = values().min_by(f64::total_cmp)?;
    let high = values().max_by(f64::total_cmp)?;
    let half = 0.5 * RANGE_MIN * low.abs().max(high.abs());
    let middle = 0.5 * (low + high);
    Some([middle - half, middle + half])
}

/// Some lines of a grid at round numbers; none in the last part, where a label would have no room.
fn grid(input: &GridInput, last_part: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let step_size = round_step((high - low) / GRID_LINES);
    let first = (low / step_size).ceil();
    // A plot of no height has no lines.
    let count = ((high - low) / step_size).min(100.0) as u32;
    let mark = |line: u32| GridMark {
        value: (first + f64::from(line)) * step_size,
        step_size,
    };
    let end = high - last_part * (high - low);
    (0..=count)
        .map(mark)
        .filter(|mark| mark.value <= end)
        .collect()
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
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Charts, POINTS_MAX, Source, grid, least_range, round_step, short, thinned};
    use crate::history::{KEPT_S, SAMPLE_HZ};
    use crate::simulation::Simulation;
    use egui_plot::GridInput;

    #[test]
    fn a_paused_chart_keeps_what_it_shows() {
        let mut simulation = Simulation::new().unwrap();
        let snapshot = simulation.snapshot().unwrap();
        let now_s = simulation.leg().time_s();
        let mut charts = Charts::default();
        charts.pause(&simulation.history, now_s);
        let points = |charts: &Charts, simulation: &Simulation, now_s: f64| {
            let source = Source {
                history: &simulation.history,
                since_s: 0.0,
                now_s,
                moment_s: None,
            };
            let shown = charts.shown(&source);
            let column = shown.history.named("tensions_n").unwrap();
            let points = shown.history.line(column, 0, 0.0).collect::<Vec<_>>();
            (points, shown.until_s)
        };
        let before = points(&charts, &simulation, now_s);
        assert!(before.0.len() > 100);
        let samples = (2.0 * KEPT_S) as u32 * SAMPLE_HZ;
        let time_s = |sample: u32| now_s + f64::from(sample) / f64::from(SAMPLE_HZ);
        for sample in 1..=samples {
            simulation.history.take(time_s(sample), &snapshot);
        }
        let later_s = time_s(samples);
        assert_eq!(points(&charts, &simulation, later_s), before);
        charts.go_on();
        let (after, until_s) = points(&charts, &simulation, later_s);
        assert_eq!(until_s, later_s);
        assert!(after[0][0] > now_s);
    }

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
    fn no_label_is_beyond_the_edge() {
        let values = |last_part| -> Vec<f64> {
            let input = GridInput {
                bounds: (0.0, 10.0),
                base_step_size: 1.0,
            };
            let marks = grid(&input, last_part).into_iter();
            marks.map(|mark| mark.value).collect()
        };
        assert_eq!(values(0.0), [0.0, 5.0, 10.0]);
        assert_eq!(values(0.06), [0.0, 5.0]);
    }

    #[test]
    fn rounding_errors_do_not_fill_a_chart() {
        let line = vec![[0.0, 2.0], [1.0, 2.000_001]];
        let [low, high] = least_range(&[line, Vec::new()]).unwrap();
        assert!((high - low - 0.02).abs() < 1e-6 && (low - 1.99).abs() < 1e-5);
        assert_eq!(least_range(&[vec![[0.0, 0.0]]]), Some([0.0, 0.0]));
        assert_eq!(least_range(&[]), None);
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
