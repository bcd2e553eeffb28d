//! The window: what is where, and what a key does.

#[cfg(test)]
mod tests;

use crate::charts::SignalSource;
use crate::files::GivenFile;
use crate::layout::{Views, narrow, wide};
use crate::live_leg::opening::{Opened, Opening};
use crate::notice::Notice;
use crate::page_state::{Drawing, PageState};
use crate::panel_guide::Wish;
use crate::places::{self, Places, place_rect};
use crate::player::Player;
use crate::recording_reader::RecordingReader;
use crate::shown_leg::ShownLeg;
use crate::simulation::{Simulation, StartError};
use crate::work::Work;
use crate::{keys, theme, top_bar};
use egui::{CentralPanel, Context, Frame, Margin, Panel, RawInput, Ui};
use leg_base::failure::Failure;
use leg_firmware::command::Command;
use leg_rig::rig_file::RigText;
use web_time::Instant;

/// From this width on everything is side by side, points.
const WIDE: f32 = 960.0;

/// A screen of more points than this is shown larger, and how many points it then has at least.
const LARGE: f32 = 2200.0;
const LARGE_SHOWN: f32 = 1700.0;

/// What there is to show.
enum Stage {
    /// A leg.
    Leg(ShownLeg),
    /// The way to a live one.
    Opening(Box<Opening>),
    /// Nothing, and why.
    Empty(String),
}

impl Stage {
    /// A new simulated leg.
    fn simulated(leg: Result<Simulation, StartError>) -> Self {
        match leg {
            Ok(simulation) => Self::Leg(ShownLeg::Simulated(Box::new(simulation))),
            Err(error) => Self::Empty(error.to_string()),
        }
    }

    fn leg(&self) -> Result<&ShownLeg, String> {
        match self {
            Self::Leg(leg) => Ok(leg),
            Self::Opening(opening) => Err(opening.words()),
            Self::Empty(words) => Err(words.clone()),
        }
    }

    #[cfg(test)]
    fn leg_mut(&mut self) -> &mut Simulation {
        let Self::Leg(leg) = self else {
            panic!("there is no leg");
        };
        let leg = leg.simulated_mut();
        leg.unwrap_or_else(|| panic!("it is not simulated"))
    }

    /// Lets time pass; `watch` sees the leg whenever it has gone on.
    fn advance(&mut self, elapsed_s: f64, now_s: f64, watch: &mut dyn FnMut(&mut ShownLeg)) {
        match self {
            Self::Leg(leg) => leg.advance_watched(elapsed_s, now_s, watch),
            Self::Opening(opening) => match opening.advance() {
                Opened::Waiting => {}
                Opened::Leg(leg) => *self = Self::Leg(ShownLeg::Live(leg)),
                Opened::Failed(words) => *self = Self::Empty(words),
            },
            Self::Empty(_) => {}
        }
    }
}

/// The window with its leg.
pub struct App {
    stage: Stage,
    views: Views,
    /// A recording in the place of the leg, which goes on meanwhile.
    player: Option<Box<Player>>,
    /// A recording that is read.
    reader: Option<Box<RecordingReader>>,
    places: Places,
    /// Whether a key asks for a stop.
    stop: bool,
    /// When the last frame was, s.
    last_s: Option<f64>,
    frames: u64,
    /// Time that the processor took for the last frame, s.
    frame_s: Option<f32>,
    /// What of it the window itself took.
    work: Work,
    /// How much larger everything is shown.
    zoom: f32,
    /// Width of the screen that the size was chosen for, points of size 1.
    sized_for: f32,
}

impl App {
    /// A window with a new simulated leg.
    #[must_use]
    pub fn new(ctx: &Context) -> Self {
        Self::show_stage(ctx, Stage::simulated(Simulation::new()), Views::new(false))
    }

    /// A window that shows a live leg as soon as there is one.
    #[must_use]
    pub fn live(ctx: &Context, opening: Result<Opening, String>) -> Self {
        let stage = match opening {
            Ok(opening) => Stage::Opening(Box::new(opening)),
            Err(words) => Stage::Empty(words),
        };
        Self::show_stage(ctx, stage, Views::new(true))
    }

    fn show_stage(ctx: &Context, stage: Stage, views: Views) -> Self {
        theme::install(ctx);
        Self {
            stage,
            views,
            player: None,
            reader: None,
            places: Places::default(),
            stop: false,
            last_s: None,
            frames: 0,
            frame_s: None,
            work: Work::default(),
            zoom: 1.0,
            sized_for: 0.0,
        }
    }

    /// What it shows, for tests and readers of the screen.
    #[must_use]
    pub fn state(&self) -> PageState {
        let player = self.player.as_ref();
        let charts = player.map_or(&self.views.charts, |player| player.charts());
        PageState::new(
            self.stage.leg(),
            &self.places,
            Drawing {
                zoom: self.zoom,
                frames: self.frames,
                frame_s: self.frame_s,
                work: self.work.summary(),
            },
            self.views.setup.state(self.stage.leg().ok()),
            charts.state(),
            player.map(|player| player.state()),
        )
    }

    /// Tells a live leg that the window is there; at a time of the window, s.
    pub fn show_life(&mut self, now_s: f64) {
        if let Stage::Leg(ShownLeg::Live(leg)) = &mut self.stage {
            leg.show_life(now_s);
        }
    }

    /// Large screens show everything larger.
    fn fit(&mut self, ctx: &Context) {
        let width = ctx.viewport_rect().width() * ctx.zoom_factor();
        if (width - self.sized_for).abs() < 1.0 {
            return;
        }
        self.sized_for = width;
        let zoom = if width > LARGE {
            width / LARGE_SHOWN
        } else {
            1.0
        };
        self.zoom = zoom;
        ctx.set_zoom_factor(zoom);
    }

    fn step(&mut self, ctx: &Context) {
        let now_s = ctx.input(|input| input.time);
        let elapsed_s = self.last_s.map_or(0.0, |last_s| now_s - last_s);
        self.last_s = Some(now_s);
        let stop = std::mem::take(&mut self.stop);
        if let (Stage::Leg(leg), true) = (&mut self.stage, stop) {
            leg.command(Command::Stop, "stop");
        }
        let began = Instant::now();
        let setup = &mut self.views.setup;
        let watch = &mut |leg: &mut ShownLeg| setup.look(leg);
        self.stage.advance(elapsed_s, now_s, watch);
        self.work.note_leg(began.elapsed());
        if let Stage::Leg(leg) = &mut self.stage {
            self.views.setup.advance(leg);
            self.views.charts.advance(&SignalSource::new(leg));
            self.views.recordings.advance(leg);
        }
        if let Some(player) = &mut self.player {
            player.advance(elapsed_s);
        }
        ctx.request_repaint();
    }

    fn show(&mut self, ui: &mut Ui) {
        let Self {
            stage,
            views,
            player,
            ..
        } = self;
        let leg = match stage {
            Stage::Leg(leg) => leg,
            // A recording needs no leg.
            _ if player.is_some() => {
                views.setup.show_notice(ui);
                return self.play(ui);
            }
            Stage::Opening(opening) => return empty(ui, "A live leg", &opening.words()),
            Stage::Empty(words) => return empty(ui, "There is no leg to show", words),
        };
        let bar = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(12, 8));
        let is_wide = ui.available_width() >= WIDE;
        let setup = (is_wide && player.is_none()).then_some(&mut views.setup.open);
        Panel::top("bar")
            .frame(bar)
            .show(ui, |ui| top_bar::show(ui, leg, is_wide, setup));
        views.setup.show_notice(ui);
        if player.is_some() {
            return self.play(ui);
        }
        let wish = if is_wide {
            wide(ui, leg, views)
        } else {
            narrow(ui, leg, views)
        };
        match wish {
            Wish::None => {}
            Wish::StartAgain => {
                let same = Simulation::with_rig_file(leg.source().clone());
                self.forget_leg();
                self.stage = Stage::simulated(same);
            }
            Wish::Simulate(source) => self.simulate(&source),
        }
    }

    /// Forgets what belongs to a leg that is not there any more; what was recorded of it is saved.
    fn forget_leg(&mut self) {
        self.views.forget_leg();
        if let Stage::Leg(leg) = &mut self.stage {
            let why = "Another leg has taken the place of the one that was recorded.";
            self.views.recordings.end(leg, why);
        }
    }

    /// Shows a recording, until the user wants the leg back.
    fn play(&mut self, ui: &mut Ui) {
        if self.player.as_mut().is_some_and(|player| player.show(ui)) {
            self.player = None;
        }
    }

    /// Makes a simulated leg of a rig file; one that is refused leaves the present one as it is.
    fn simulate(&mut self, source: &RigText) {
        match Simulation::with_rig_file(source.clone()) {
            Ok(simulation) => {
                let notes = source
                    .read()
                    .map_or_else(|_| Vec::new(), |(_, notes)| notes);
                self.forget_leg();
                self.views.setup.note_simulated(source, &notes);
                self.stage = Stage::simulated(Ok(simulation));
            }
            Err(error) => self.views.setup.note_refused(source, error.to_string()),
        }
    }

    /// Looks at the files that were given to the window.
    fn take_files(&mut self, ctx: &Context) {
        let leg = self.stage.leg().ok();
        if let Some(source) = self.views.setup.take_files(ctx, leg) {
            self.simulate(&source);
        }
        while let Some(given) = self.views.recordings.next(ctx) {
            self.open(given);
        }
        if let Some(notice) = self.views.recordings.take_notice() {
            self.views.setup.note(notice);
        }
    }

    /// Begins to read a recording.
    fn open(&mut self, GivenFile { name, bytes }: GivenFile) {
        match bytes.and_then(|bytes| RecordingReader::new(name.clone(), bytes)) {
            Ok(reader) => self.reader = Some(Box::new(reader)),
            Err(failure) => self.note_refused(&name, &failure),
        }
    }

    /// One that is refused leaves what is shown as it is.
    fn note_refused(&mut self, name: &str, failure: &Failure) {
        self.views.setup.note(Notice {
            good: false,
            title: format!("{name} is refused. What is shown stays as it was."),
            text: failure.render(false),
        });
    }

    /// Reads a part of a recording, and shows it once everything is read.
    fn read_on(&mut self) {
        let Some(mut reader) = self.reader.take() else {
            return;
        };
        let told = reader.words().is_some();
        match reader.read_on() {
            None => {
                if let Some(title) = reader.words() {
                    let (good, text) = (true, String::new());
                    self.views.setup.note(Notice { good, title, text });
                }
                self.reader = Some(reader);
            }
            Some(Err(failure)) => self.note_refused(reader.name(), &failure),
            Some(Ok(leg)) => {
                if told {
                    self.views.setup.close_notice();
                }
                self.player = Some(Box::new(Player::new(leg)));
            }
        }
    }

    /// Takes the input before anything sees it.
    fn take(&mut self, input: &mut RawInput) {
        self.stop |= keys::take_stop(&mut input.events);
    }

    /// What the leg's ticks took in the last frame, ms.
    pub(crate) const fn ticks_ms(&self) -> f64 {
        self.work.leg_ms()
    }

    /// A frame.
    pub(crate) fn frame(&mut self, ui: &mut Ui) {
        let began = Instant::now();
        let ctx = ui.ctx().clone();
        self.fit(&ctx);
        self.step(&ctx);
        self.take_files(&ctx);
        self.read_on();
        self.show(ui);
        self.places = places::take(&ctx);
        self.frames += 1;
        self.work.note_frame(began.elapsed());
    }
}

#[cfg(any(feature = "desktop", target_arch = "wasm32"))]
impl eframe::App for App {
    fn raw_input_hook(&mut self, _: &Context, input: &mut RawInput) {
        self.take(input);
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        self.frame(ui);
        self.frame_s = frame.info().cpu_usage;
    }

    #[cfg(target_arch = "wasm32")]
    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }
}

/// A window without a leg, and why it has none.
fn empty(ui: &mut Ui, heading: &str, words: &str) {
    let shown = CentralPanel::default().show(ui, |ui| {
        ui.heading(heading);
        ui.label(words);
    });
    place_rect(ui.ctx(), shown.response.rect, "empty");
}
