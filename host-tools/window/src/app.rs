//! The window: what is where, and what a key does.

#[cfg(test)]
mod tests;

use crate::charts::Charts;
use crate::faults::FaultList;
use crate::page_state::PageState;
use crate::panel_guide::Wish;
use crate::places::{self, Places, place};
use crate::scene::{self, Scene};
use crate::simulation::Simulation;
use crate::theme::{self, palette};
use crate::workspace::Workspace;
use crate::{keys, numbers, panel_break, panel_drive, panel_guide, top_bar};
use eframe::egui::{
    Align, CentralPanel, Context, Frame, Layout, Margin, Panel, RawInput, Rect, ScrollArea, Ui,
    UiBuilder, Vec2, vec2,
};
use leg_firmware::command::Command;

/// From this width on everything is side by side, points.
const WIDE: f32 = 960.0;

/// A screen of more points than this is shown larger, and how many points it then has at least.
const LARGE: f32 = 2200.0;
const LARGE_SHOWN: f32 = 1700.0;

/// The room for the time beside the leg, points.
const TIME: Vec2 = vec2(150.0, 50.0);

/// What a narrow window shows below the leg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Tab {
    #[default]
    Try,
    Drive,
    Break,
    Charts,
}

const TABS: [(Tab, &str, &str); 4] = [
    (Tab::Try, "Try", "tab_try"),
    (Tab::Drive, "Drive", "tab_drive"),
    (Tab::Break, "Break", "tab_break"),
    (Tab::Charts, "Charts", "tab_charts"),
];

/// What the user chose to see.
#[derive(Default)]
struct Views {
    scene: Scene,
    workspace: Workspace,
    charts: Charts,
    faults: FaultList,
    tab: Tab,
}

/// The window with its leg.
pub struct App {
    /// The leg, or why there is none.
    simulation: Result<Simulation, String>,
    views: Views,
    places: Places,
    /// Whether a key asks for a stop.
    stop: bool,
    /// When the last frame was, s.
    last_s: Option<f64>,
    frames: u64,
    /// Time that the processor took for the last frame, s.
    frame_s: Option<f32>,
    /// How much larger everything is shown.
    zoom: f32,
    /// Width of the screen that the size was chosen for, points of size 1.
    sized_for: f32,
}

impl App {
    /// A window with a new leg.
    #[must_use]
    pub fn new(ctx: &Context) -> Self {
        theme::install(ctx);
        Self {
            simulation: Simulation::new().map_err(|error| error.to_string()),
            views: Views::default(),
            places: Places::default(),
            stop: false,
            last_s: None,
            frames: 0,
            frame_s: None,
            zoom: 1.0,
            sized_for: 0.0,
        }
    }

    /// What it shows, for tests and readers of the screen.
    #[must_use]
    pub fn state(&self) -> PageState {
        let simulation = self.simulation.as_ref();
        PageState::new(
            simulation.ok(),
            &self.places,
            self.zoom,
            self.frames,
            self.frame_s,
        )
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
        if let Ok(simulation) = &mut self.simulation {
            if stop {
                simulation.command(Command::Stop, "stop");
            }
            simulation.advance(elapsed_s);
        }
        ctx.request_repaint();
    }

    fn show(&mut self, ui: &mut Ui) {
        let Self {
            simulation, views, ..
        } = self;
        let simulation = match simulation {
            Ok(simulation) => simulation,
            Err(error) => {
                CentralPanel::default().show(ui, |ui| {
                    ui.heading("There is no leg to show");
                    ui.label(error.as_str());
                });
                return;
            }
        };
        let bar = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(12, 8));
        Panel::top("bar")
            .frame(bar)
            .show(ui, |ui| top_bar::show(ui, simulation));
        let wish = if ui.available_width() >= WIDE {
            wide(ui, simulation, views)
        } else {
            narrow(ui, simulation, views)
        };
        if wish == Wish::StartAgain {
            self.views.charts.go_on();
            self.simulation = Simulation::new().map_err(|error| error.to_string());
        }
    }

    /// Takes the input before anything sees it.
    fn take(&mut self, input: &mut RawInput) {
        self.stop |= keys::take_stop(&mut input.events);
    }

    /// A frame.
    fn frame(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.fit(&ctx);
        self.step(&ctx);
        self.show(ui);
        self.places = places::take(&ctx);
        self.frames += 1;
    }
}

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

/// Everything side by side.
fn wide(ui: &mut Ui, simulation: &mut Simulation, views: &mut Views) -> Wish {
    let tall = ui.available_height();
    let side = Frame::side_top_panel(ui.style()).inner_margin(12.0);
    let left = Panel::left("left")
        .frame(side)
        .resizable(false)
        .exact_size(282.0);
    let wish = left.show(ui, |ui| {
        let scroll = ScrollArea::vertical().id_salt("left");
        scroll
            .show(ui, |ui| {
                let wish = panel_guide::show(ui, simulation);
                ui.separator();
                panel_drive::show(ui, simulation);
                wish
            })
            .inner
    });
    let right = Panel::right("right")
        .frame(side)
        .resizable(false)
        .exact_size(300.0);
    right.show(ui, |ui| {
        ScrollArea::vertical().id_salt("right").show(ui, |ui| {
            ui.heading("Drag the target");
            views.workspace.show(ui, simulation, 200.0);
            numbers::show(ui, simulation);
            ui.separator();
            panel_break::show(ui, simulation);
        });
    });
    let height = (0.32 * tall).clamp(200.0, 440.0);
    let bottom = Panel::bottom("charts")
        .frame(side)
        .resizable(false)
        .exact_size(height);
    bottom.show(ui, |ui| {
        let now_s = simulation.leg().time_s();
        views
            .charts
            .show(ui, &simulation.history, now_s, height - 62.0);
    });
    CentralPanel::no_frame().show(ui, |ui| {
        let rect = leg(ui, simulation, &mut views.scene);
        let over = UiBuilder::new().max_rect(scene::room(rect));
        ui.scope_builder(over, |ui| {
            let scroll = ScrollArea::vertical().id_salt("faults");
            scroll.show(ui, |ui| views.faults.show(ui, simulation.faults()));
        });
    });
    wish.inner
}

/// The leg above, and the rest behind tabs.
fn narrow(ui: &mut Ui, simulation: &mut Simulation, views: &mut Views) -> Wish {
    let height = (0.44 * ui.available_height()).max(220.0);
    let above = Panel::top("leg")
        .frame(Frame::NONE)
        .resizable(false)
        .exact_size(height);
    above.show(ui, |ui| {
        let rect = leg(ui, simulation, &mut views.scene);
        let corner = Rect::from_min_max(rect.max - TIME, rect.max - vec2(14.0, 6.0));
        let over = UiBuilder::new()
            .max_rect(corner)
            .layout(Layout::bottom_up(Align::Max));
        ui.scope_builder(over, |ui| top_bar::time(ui, simulation));
    });
    CentralPanel::default()
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                let width = (ui.available_width() - 24.0) / TABS.len() as f32;
                for (this, text, name) in TABS {
                    let button = eframe::egui::Button::selectable(views.tab == this, text);
                    let response = ui.add(button.min_size(vec2(width, 36.0)));
                    place(&response, name);
                    if response.clicked() {
                        views.tab = this;
                    }
                }
            });
            ui.separator();
            let scroll = ScrollArea::vertical().id_salt("tabs");
            scroll.show(ui, |ui| page(ui, simulation, views)).inner
        })
        .inner
}

fn page(ui: &mut Ui, simulation: &mut Simulation, views: &mut Views) -> Wish {
    views.faults.show_any(ui, simulation.faults());
    match views.tab {
        Tab::Try => {
            let wish = panel_guide::show(ui, simulation);
            numbers::show(ui, simulation);
            return wish;
        }
        Tab::Drive => {
            let side = ui.available_width().min(300.0);
            ui.vertical_centered(|ui| views.workspace.show(ui, simulation, side));
            panel_drive::show(ui, simulation);
        }
        Tab::Break => panel_break::show(ui, simulation),
        Tab::Charts => {
            let now_s = simulation.leg().time_s();
            views.charts.show(ui, &simulation.history, now_s, 180.0);
        }
    }
    Wish::None
}

/// The leg, how much its sag is enlarged, and why it cannot go on. Gives where it is.
fn leg(ui: &mut Ui, simulation: &Simulation, scene: &mut Scene) -> Rect {
    let rect = ui.available_rect_before_wrap();
    let response = scene.show(ui, simulation, rect.size());
    place(&response, "leg");
    let corner = rect.left_top() + vec2(14.0, scene::CHOICE_TOP);
    let over = UiBuilder::new().max_rect(Rect::from_min_size(corner, vec2(96.0, 28.0)));
    ui.scope_builder(over, |ui| scene.choice(ui));
    let failure = simulation.failure().map(ToString::to_string);
    if let Some(words) = failure {
        let palette = palette(ui.ctx());
        let at = rect.center();
        let font = eframe::egui::FontId::proportional(15.0);
        ui.painter().text(
            at,
            eframe::egui::Align2::CENTER_CENTER,
            words,
            font,
            palette.error,
        );
    }
    rect
}
