//! A recording that is played: the leg as it was at a time, which is chosen by a slider, and its signals around it.

use crate::charts::Charts;
use crate::faults::FaultList;
use crate::layout::{self, stage};
use crate::numbers;
use crate::places::{place, place_rect};
use crate::recorded_leg::RecordedLeg;
use crate::scene::Scene;
use crate::scrolled;
use crate::theme::{Palette, palette};
use crate::top_bar::chip;
use egui::{Button, CentralPanel, ComboBox, Frame, Label, Panel, RichText, Slider, Ui, vec2};
use leg_base::description;
use serde::Serialize;

/// From this width on everything is side by side, points.
const WIDE: f32 = 960.0;

/// The longest time that one frame makes up for, s.
const FRAME_MAX_S: f64 = 0.25;

/// How fast it is played beside the clock: the value, its text, its name for tests.
const RATES: [(f64, &str, &str); 5] = [
    (0.1, "1/10", "play_tenth"),
    (0.25, "1/4", "play_quarter"),
    (1.0, "×1", "play_1"),
    (4.0, "×4", "play_4"),
    (16.0, "×16", "play_16"),
];

/// A recording, and where in it one is.
pub struct Player {
    leg: RecordedLeg,
    at_s: f64,
    playing: bool,
    rate: f64,
    charts: Charts,
    scene: Scene,
    faults: FaultList,
}

/// The same as data.
#[derive(Debug, Serialize)]
pub struct PlayerState {
    /// The file.
    pub name: String,
    /// Where in it one is, s.
    pub at_s: f64,
    /// From when to when it goes, s.
    pub span_s: [f64; 2],
    /// Whether it is played.
    pub playing: bool,
    /// How fast, beside the clock.
    pub rate: f64,
    /// Whether it came to its end.
    pub finished: bool,
    /// What its leg might do then.
    pub state: &'static str,
    /// What was wrong with it.
    pub faults: Vec<&'static str>,
    /// Distance of its tip from where it was sent, mm.
    pub error_mm: f64,
    /// How far it leans, degrees.
    pub tilt_deg: f64,
    /// Its payload, kg: true or estimated.
    pub payload_kg: f64,
}

impl PlayerState {
    /// What a reader of the screen says: not the time, which changes all the while.
    #[must_use]
    pub fn spoken(&self) -> String {
        let faults = if self.faults.is_empty() {
            "none".into()
        } else {
            self.faults.join(", ")
        };
        format!(
            "The recording {} is shown: its leg is {}. Its faults: {faults}.",
            self.name, self.state
        )
    }
}

impl Player {
    /// At the beginning of a recording.
    #[must_use]
    pub fn new(leg: RecordedLeg) -> Self {
        let [at_s, _] = leg.span_s();
        Self {
            charts: if leg.seen(at_s).is_true {
                Charts::default()
            } else {
                Charts::live()
            },
            leg,
            at_s,
            playing: false,
            rate: 1.0,
            scene: Scene::default(),
            faults: FaultList::default(),
        }
    }

    /// Its signals over time.
    #[must_use]
    pub const fn charts(&self) -> &Charts {
        &self.charts
    }

    /// Plays on, if it is played.
    pub fn advance(&mut self, elapsed_s: f64) {
        if !self.playing {
            return;
        }
        let [_, end_s] = self.leg.span_s();
        let step_s = elapsed_s.clamp(0.0, FRAME_MAX_S) * self.rate;
        self.at_s = (self.at_s + step_s).min(end_s);
        self.playing = self.at_s < end_s;
    }

    /// As data.
    #[must_use]
    pub fn state(&self) -> PlayerState {
        let seen = self.leg.seen(self.at_s);
        let faults = self.leg.faults(self.at_s).faults();
        let [_, tilt_deg] = leg_base::angles::angles_deg([seen.leg_axis.x, seen.leg_axis.y]);
        let estimated_kg = seen
            .telemetry
            .map_or(0.0, |telemetry| telemetry.payload_kg.into());
        PlayerState {
            name: self.leg.name.clone(),
            at_s: self.at_s,
            span_s: self.leg.span_s(),
            playing: self.playing,
            rate: self.rate,
            finished: self.leg.finished,
            state: description::state(self.leg.state(self.at_s)),
            faults: faults.map(|fault| fault.entry().name).collect(),
            error_mm: seen.error_mm,
            tilt_deg,
            payload_kg: seen.hung_kg.unwrap_or(estimated_kg),
        }
    }

    /// Shows it in the place of the leg. Whether the user wants the leg back.
    pub fn show(&mut self, ui: &mut Ui) -> bool {
        let palette = palette(ui.ctx());
        let back = self.heading(ui, &palette);
        if ui.available_width() >= WIDE {
            self.wide(ui);
        } else {
            self.narrow(ui);
        }
        back
    }

    fn heading(&self, ui: &mut Ui, palette: &Palette) -> bool {
        let frame = Frame::side_top_panel(ui.style())
            .fill(palette.card)
            .inner_margin(8.0);
        let panel = Panel::top("recording").frame(frame).resizable(false);
        let shown = panel.show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                let text = RichText::new("Back to the leg").strong();
                let back = ui.add(Button::new(text).min_size(vec2(130.0, 30.0)));
                place(&back, "back");
                ui.label(
                    RichText::new("RECORDING")
                        .small()
                        .strong()
                        .color(palette.warning),
                );
                ui.label(RichText::new(&self.leg.name).monospace());
                ui.label(RichText::new(&self.leg.about.title).color(palette.faint));
                if !self.leg.finished {
                    let words = "It did not come to its end: it goes to its last whole message.";
                    place(
                        &ui.label(RichText::new(words).color(palette.warning)),
                        "cut_off",
                    );
                }
                back.clicked()
            })
            .inner
        });
        place_rect(ui.ctx(), shown.response.rect, "player");
        shown.inner
    }

    fn wide(&mut self, ui: &mut Ui) {
        let tall = ui.available_height();
        let side = Frame::side_top_panel(ui.style()).inner_margin(12.0);
        let right = Panel::right("recorded")
            .frame(side)
            .resizable(false)
            .exact_size(300.0);
        right.show(ui, |ui| {
            scrolled::shrunk(ui, "recorded", |ui| self.facts(ui));
        });
        let height = (0.38 * tall).clamp(220.0, 520.0) + self.charts.words_height();
        let bottom = Panel::bottom("recorded charts")
            .frame(side)
            .resizable(false)
            .exact_size(height);
        bottom.show(ui, |ui| {
            let room = ui.available_height();
            scrolled::shrunk(ui, "recorded charts", |ui| self.show_charts(ui, Some(room)));
        });
        let transport = Panel::bottom("transport").frame(side).resizable(false);
        transport.show(ui, |ui| self.transport(ui));
        CentralPanel::no_frame().show(ui, |ui| {
            stage(ui, &self.leg.seen(self.at_s), None, &mut self.scene, None);
        });
    }

    fn narrow(&mut self, ui: &mut Ui) {
        layout::leg_panel(ui, "recorded leg").show(ui, |ui| {
            stage(ui, &self.leg.seen(self.at_s), None, &mut self.scene, None);
        });
        CentralPanel::default().show(ui, |ui| {
            self.transport(ui);
            ui.separator();
            scrolled::shrunk(ui, "recorded", |ui| {
                self.show_charts(ui, None);
                ui.separator();
                self.facts(ui);
            });
        });
    }

    /// Play, how fast, and where.
    fn transport(&mut self, ui: &mut Ui) {
        let [begin_s, end_s] = self.leg.span_s();
        ui.horizontal(|ui| {
            let text = if self.playing { "Pause" } else { "Play" };
            let play = ui.add(Button::new(text).min_size(vec2(80.0, 30.0)));
            place(&play, "play");
            if play.clicked() {
                self.playing = !self.playing;
                if self.playing && self.at_s >= end_s {
                    self.at_s = begin_s;
                }
            }
            self.rates(ui);
            let words = format!("{:9.3} of {:.3} s", self.at_s, end_s);
            place(
                &ui.label(RichText::new(words).monospace()),
                "recording_time",
            );
        });
        ui.spacing_mut().slider_width = ui.available_width();
        // A round time near the pointer would put the handle beside it, by the length of the recording.
        let slider = Slider::new(&mut self.at_s, begin_s..=end_s)
            .show_value(false)
            .smart_aim(false);
        let slider = ui.add_enabled(end_s > begin_s, slider);
        place(&slider, "scrub");
        if slider.dragged() {
            self.playing = false;
        }
        slider.on_hover_text("Drag it through the recording; the arrow keys move it, too.");
    }

    fn rates(&mut self, ui: &mut Ui) {
        let shown = RATES.iter().find(|(value, ..)| *value == self.rate);
        let choice = ComboBox::from_id_salt("play rate")
            .selected_text(shown.map_or("", |(_, text, _)| text))
            .width(64.0);
        let choice = choice.show_ui(ui, |ui| {
            for (value, text, name) in RATES {
                place(&ui.selectable_value(&mut self.rate, value, text), name);
            }
        });
        place(&choice.response, "play_rate");
    }

    /// The signals; a press in a chart goes to that time.
    fn show_charts(&mut self, ui: &mut Ui, room: Option<f32>) {
        let Self {
            leg, charts, at_s, ..
        } = self;
        let moment_s = *at_s;
        let pressed_s = charts.show_panel(ui, room, leg, |leg| leg.signals(moment_s), |_, _| ());
        if let Some(pressed_s) = pressed_s {
            let [since_s, end_s] = leg.span_s();
            *at_s = pressed_s.clamp(since_s, end_s);
            self.playing = false;
        }
    }

    /// The leg at that time in numbers, its faults, and what the recording is of.
    fn facts(&mut self, ui: &mut Ui) {
        let palette = palette(ui.ctx());
        chip(ui, Some(self.leg.state(self.at_s)), None, &palette);
        numbers::show(ui, &self.leg.seen(self.at_s));
        ui.separator();
        let faults = self.leg.faults(self.at_s);
        self.faults.show(ui, Some(faults), self.leg.rig());
        ui.separator();
        let about = &self.leg.about;
        let seed = about.seed.map(|seed| seed.to_string());
        for (name, value) in [
            ("rig", about.rig.as_deref()),
            ("scenario", about.scenario.as_deref()),
            ("seed", seed.as_deref()),
            ("made by version", Some(about.version.as_str())),
        ] {
            if let Some(value) = value {
                let text = RichText::new(format!("{name}: {value}")).color(palette.faint);
                ui.add(Label::new(text).wrap());
            }
        }
    }
}
