//! What is charted, and how, as the user chooses it.

use super::cursors::Cursors;
use super::signal_source::SignalSource;
use super::{Charts, SPANS_S, panel_trigger};
use crate::history::History;
use crate::places::place;
use egui::{Button, ComboBox, PopupCloseBehavior, RichText, ScrollArea, TextEdit, Ui, vec2};

impl Charts {
    /// What is charted, and how.
    pub(super) fn controls(&mut self, ui: &mut Ui, source: &SignalSource<'_>) {
        ui.heading("Charts");
        let menu = ComboBox::from_id_salt("signals")
            .selected_text("Signals")
            .width(90.0)
            // Several signals may be chosen, and a name is typed.
            .close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        let menu = menu.show_ui(ui, |ui| self.choice(ui, source.history));
        place(&menu.response, "signals");
        if source.moment_s.is_none() {
            self.follow(ui, source);
        }
        self.tools(ui, source);
    }

    /// How much of a leg is charted that goes on, whether the charts stand still, and when they do by themselves.
    fn follow(&mut self, ui: &mut Ui, source: &SignalSource<'_>) {
        let span = ComboBox::from_id_salt("span").selected_text(format!("{:.0} s", self.span_s));
        span.width(56.0).show_ui(ui, |ui| {
            for span_s in SPANS_S {
                ui.selectable_value(&mut self.span_s, span_s, format!("{span_s:.0} s"));
            }
        });
        let text = if self.paused() { "Go on" } else { "Pause" };
        let pause = ui.add(Button::new(text).min_size(vec2(62.0, 0.0)));
        place(&pause, "pause");
        let hint = "A paused chart can be dragged and zoomed; a double click shows it whole.";
        if pause.on_hover_text(hint).clicked() {
            if self.paused() {
                self.go_on();
                self.trigger.disarm();
            } else {
                self.pause(source.history, source.now_s);
            }
        }
        if panel_trigger::show(ui, &mut self.trigger, &self.chosen, source) {
            self.go_on();
        }
    }

    /// Cursors and spectra.
    fn tools(&mut self, ui: &mut Ui, source: &SignalSource<'_>) {
        let cursors = Button::new("Cursors").selected(self.cursors.is_some());
        let cursors = ui.add_enabled(!self.spectra, cursors);
        place(&cursors, "cursors");
        let hint = "Two cursors: drag them in a chart to read times, values and their differences.";
        if cursors.on_hover_text(hint).clicked() {
            self.switch_cursors(source);
        }
        let spectra = ui.add(Button::new("Spectrum").selected(self.spectra));
        place(&spectra, "spectra");
        let hint = "Which sines the signals have in the time that is shown (Hann's window), and the highest of them.";
        if spectra.on_hover_text(hint).clicked() {
            self.spectra = !self.spectra;
        }
    }

    /// Cursors stand in charts that stand still.
    fn switch_cursors(&mut self, source: &SignalSource<'_>) {
        if self.cursors.take().is_some() {
            return;
        }
        if source.moment_s.is_none() && !self.paused() {
            self.pause(source.history, source.now_s);
        }
        let whole_s = [source.since_s, source.now_s];
        self.cursors = Some(Cursors::new(self.zoomed_s.unwrap_or(whole_s)));
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
                place(&response, name);
                if response.on_hover_text(column.meaning()).changed() {
                    self.chosen.retain(|other| *other != name);
                    if on {
                        self.chosen.push(name);
                    }
                }
            }
        });
    }
}
