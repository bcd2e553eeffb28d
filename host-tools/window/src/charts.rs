//! Signals over time, chosen by name, and what they tell: values at cursors, the time of a trigger, a spectrum.

mod chart;
mod cursors;
mod lines;
mod panel_controls;
mod panel_trigger;
mod signal_source;
mod spectrum;
mod trigger;

use crate::history::{Column, History, KEPT_S};
use crate::places::{place, place_rect};
use chart::{Kept, VALUES_HEIGHT};
use cursors::Cursors;
use egui::{RichText, Ui};
use serde::Serialize;
use signal_source::ShownSignals;
pub use signal_source::SignalSource;
use std::collections::BTreeMap;
use trigger::Trigger;

/// Times that a chart may show, s.
const SPANS_S: [f64; 4] = [2.0, 5.0, 10.0, KEPT_S];

/// Height of a line of words above the charts, points.
const WORDS_HEIGHT: f32 = 26.0;

/// Height of a chart where there is no bound, and the least one, points.
const HEIGHT: f32 = 180.0;
const HEIGHT_MIN: f32 = 110.0;

/// What is charted, and how.
pub struct Charts {
    /// The names of the signals, one chart each.
    chosen: Vec<&'static str>,
    span_s: f64,
    /// What the charts show while they are paused.
    paused: Option<Paused>,
    /// A part of a name that is looked for.
    search: String,
    cursors: Option<Cursors>,
    trigger: Trigger,
    /// Whether spectra are shown in the place of signals over time.
    spectra: bool,
    /// What charts that stand still are zoomed to, s; none if they show everything.
    zoomed_s: Option<[f64; 2]>,
    /// What they are to be zoomed to in the next frame, s.
    wanted_s: Option<[f64; 2]>,
    /// What was drawn last, by the names of the signals.
    kept: BTreeMap<&'static str, Kept>,
}

/// The charts as data.
#[derive(Debug, Serialize)]
pub struct ChartsState {
    /// The names of the signals.
    pub chosen: Vec<&'static str>,
    /// Whether they stand still.
    pub paused: bool,
    /// Where the cursors are, s.
    pub cursors_s: Option<[f64; 2]>,
    /// What is shown of charts that stand still and are zoomed, s.
    pub zoomed_s: Option<[f64; 2]>,
    /// Whether the trigger waits, and what it caught last, s.
    pub armed: bool,
    /// s.
    pub caught_s: Option<f64>,
    /// The highest peak of the first number of each signal, Hz and in its unit, if spectra are shown.
    pub peaks: BTreeMap<&'static str, [f64; 2]>,
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
            cursors: None,
            trigger: Trigger::default(),
            spectra: false,
            zoomed_s: None,
            wanted_s: None,
            kept: BTreeMap::new(),
        }
    }
}

impl Charts {
    /// What is charted of a leg of which only its reports are known.
    #[must_use]
    pub fn live() -> Self {
        Self {
            chosen: vec!["tip_estimated_mm", "tensions_n"],
            ..Self::default()
        }
    }

    /// As data.
    #[must_use]
    pub fn state(&self) -> ChartsState {
        let peaks = self.kept.iter().filter(|_| self.spectra);
        let peaks = peaks.filter_map(|(name, kept)| Some((*name, kept.peak()?)));
        ChartsState {
            chosen: self.chosen.clone(),
            paused: self.paused(),
            cursors_s: self.cursors.as_ref().map(|cursors| cursors.at_s),
            zoomed_s: self.zoomed_s,
            armed: self.trigger.armed(),
            caught_s: self.trigger.caught_s(),
            peaks: peaks.collect(),
        }
    }

    /// Looks for what the trigger waits for.
    pub fn advance(&mut self, source: &SignalSource<'_>) {
        let after_s = 0.5 * self.span_s;
        let caught = self.trigger.advance(source.history, source.now_s, after_s);
        if let Some(at_s) = caught {
            self.pause(source.history, source.now_s);
            self.wanted_s = Some([at_s - after_s, at_s + after_s]);
        }
    }

    /// Shows the controls with what is `beside` them, and below them the charts of a leg, in a room of some height if that is
    /// bounded, points. The time at which a chart was pressed, s.
    pub fn show_panel<L>(
        &mut self,
        ui: &mut Ui,
        room: Option<f32>,
        leg: &mut L,
        source: impl for<'a> Fn(&'a L) -> SignalSource<'a>,
        beside: impl FnOnce(&mut Ui, &mut L),
    ) -> Option<f64> {
        let top = ui.cursor().top();
        ui.horizontal_wrapped(|ui| {
            self.controls(ui, &source(leg));
            beside(ui, leg);
        });
        let used = ui.cursor().top() - top;
        let height = room.map_or(HEIGHT, |room| (room - used).max(HEIGHT_MIN));
        self.show(ui, &source(leg), height)
    }

    /// Shows the charts beside each other, or below where there is no room for that. The time at which one was pressed, s.
    fn show(&mut self, ui: &mut Ui, source: &SignalSource<'_>, height: f32) -> Option<f64> {
        if self.chosen.is_empty() {
            ui.label("Choose a signal to see it over time.");
        }
        let paused = self.paused.take();
        let shown = self.shown(source, paused.as_ref());
        let named = self
            .chosen
            .iter()
            .filter_map(|name| source.history.named(name));
        let columns: Vec<Column> = named.collect();
        let top = ui.cursor().top();
        let height = height - self.cursor_words(ui);
        let mut pressed_s = None;
        if ui.available_width() > 560.0 && columns.len() > 1 {
            ui.columns(columns.len(), |parts| {
                for (part, column) in parts.iter_mut().zip(&columns) {
                    pressed_s = self.chart(part, shown, *column, height).or(pressed_s);
                }
            });
        } else {
            for column in columns {
                pressed_s = self.chart(ui, shown, column, height).or(pressed_s);
            }
        }
        self.wanted_s = None;
        self.paused = paused;
        place_rect(ui.ctx(), ui.min_rect().with_min_y(top), "charts");
        pressed_s
    }

    /// How much higher the charts are with what is said above them, points.
    #[must_use]
    pub const fn words_height(&self) -> f32 {
        match (self.spectra, &self.cursors) {
            (true, _) => 3.0 * VALUES_HEIGHT,
            (false, Some(_)) => 3.0 * VALUES_HEIGHT + WORDS_HEIGHT,
            (false, None) => 0.0,
        }
    }

    /// The times of the cursors, if there are some. How high that is, points.
    fn cursor_words(&self, ui: &mut Ui) -> f32 {
        let Some(cursors) = self.cursors.as_ref().filter(|_| !self.spectra) else {
            return 0.0;
        };
        let words = RichText::new(cursors.words()).monospace().size(12.0);
        place(&ui.label(words), "cursor_times");
        WORDS_HEIGHT
    }

    /// Stands still.
    fn pause(&mut self, history: &History, now_s: f64) {
        self.kept.clear();
        self.zoomed_s = Some([(now_s - self.span_s).max(0.0), now_s]);
        self.paused = Some(Paused {
            history: history.clone(),
            until_s: now_s,
        });
    }

    /// Whether they stand still.
    #[must_use]
    pub const fn paused(&self) -> bool {
        self.paused.is_some()
    }

    /// Goes on.
    pub fn go_on(&mut self) {
        self.paused = None;
        self.cursors = None;
        self.kept.clear();
    }

    /// Forgets a leg that is not there any more.
    pub fn forget_leg(&mut self) {
        self.go_on();
        self.trigger.disarm();
    }

    /// What is charted of a source.
    fn shown<'a>(&self, source: &SignalSource<'a>, paused: Option<&'a Paused>) -> ShownSignals<'a> {
        let recorded = source.moment_s.is_some();
        let (history, until_s) = match paused {
            Some(paused) => (&paused.history, paused.until_s),
            None => (source.history, source.now_s),
        };
        let since_s = if recorded {
            source.since_s
        } else {
            (until_s - KEPT_S).max(0.0)
        };
        let still = recorded || paused.is_some();
        let whole_s = [since_s, until_s];
        let drawn_s = match (still, self.zoomed_s) {
            (true, zoomed_s) => zoomed_s.unwrap_or(whole_s),
            (false, _) => [(until_s - self.span_s).max(0.0), until_s],
        };
        ShownSignals {
            history,
            whole_s,
            drawn_s,
            moment_s: source.moment_s,
            still,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Charts, SignalSource};
    use crate::history::{KEPT_S, SAMPLE_HZ};
    use crate::simulation::Simulation;

    fn source(simulation: &Simulation, now_s: f64) -> SignalSource<'_> {
        SignalSource {
            history: &simulation.history,
            since_s: 0.0,
            now_s,
            moment_s: None,
        }
    }

    #[test]
    fn a_paused_chart_keeps_what_it_shows() {
        let mut simulation = Simulation::new().unwrap();
        let snapshot = simulation.snapshot().unwrap();
        let now_s = simulation.leg().time_s();
        let mut charts = Charts::default();
        charts.pause(&simulation.history, now_s);
        let points = |charts: &Charts, simulation: &Simulation, now_s: f64| {
            let shown = charts.shown(&source(simulation, now_s), charts.paused.as_ref());
            let column = shown.history.named("tensions_n").unwrap();
            let points = shown.history.line(column, 0, 0.0).collect::<Vec<_>>();
            (points, shown.whole_s[1])
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
}
