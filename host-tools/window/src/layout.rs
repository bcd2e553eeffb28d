//! What is where in the window, wide or narrow.

use crate::charts::{Charts, SignalSource};
use crate::fault_strip::FaultStrip;
use crate::faults::FaultList;
use crate::map::Map;
use crate::panel_guide::Wish;
use crate::places::{place, place_rect};
use crate::recordings::Recordings;
use crate::scene::{self, Scene};
use crate::seen_leg::SeenLeg;
use crate::setup::Setup;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use crate::workspace::Workspace;
use crate::{numbers, panel_break, panel_drive, panel_guide, panel_unlock, scrolled, top_bar};
use egui::{
    Align, Align2, CentralPanel, FontId, Frame, Layout, Panel, Rect, Ui, UiBuilder, Vec2, vec2,
};
use leg_rig::rig_file::RigText;

/// The room for the time beside the leg, points.
const TIME: Vec2 = vec2(150.0, 50.0);

/// The least and the widest disc, points.
const DISC: [f32; 2] = [180.0, 300.0];

/// A window that is lower than this, and wider than high, has the leg at its left: a phone held across, points.
const LOW: f32 = 500.0;

/// How much of such a window, and of one held upright, the leg takes.
const LEFT_PART: f32 = 0.46;
const TOP_PART: f32 = 0.44;

/// Below this width of a tab there is little room for its name, points.
const TAB_ROOMY: f32 = 66.0;

/// What a narrow window shows below the leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tab {
    Try,
    Drive,
    Break,
    Charts,
    Setup,
}

impl Tab {
    /// Whether it is of simulated legs alone.
    const fn simulated(self) -> bool {
        matches!(self, Self::Try | Self::Break)
    }
}

const TABS: [(Tab, &str, &str); 5] = [
    (Tab::Try, "Try", "tab_try"),
    (Tab::Drive, "Drive", "tab_drive"),
    (Tab::Break, "Break", "tab_break"),
    (Tab::Charts, "Charts", "tab_charts"),
    (Tab::Setup, "Set up", "tab_setup"),
];

/// What the user chose to see.
pub struct Views {
    scene: Scene,
    workspace: Workspace,
    /// The signals over time.
    pub charts: Charts,
    faults: FaultList,
    fault_strip: FaultStrip,
    /// What is recorded, and opened.
    pub recordings: Recordings,
    /// Rig files and settings.
    pub setup: Setup,
    tab: Tab,
}

impl Views {
    /// Those of a simulated leg, or of a live one.
    #[must_use]
    pub fn new(live: bool) -> Self {
        Self {
            scene: Scene::default(),
            workspace: Workspace::default(),
            charts: if live {
                Charts::live()
            } else {
                Charts::default()
            },
            faults: FaultList::default(),
            fault_strip: FaultStrip::default(),
            recordings: Recordings::default(),
            setup: Setup::default(),
            tab: if live { Tab::Drive } else { Tab::Try },
        }
    }

    /// Forgets what belongs to a leg that is not there any more.
    pub fn forget_leg(&mut self) {
        self.charts.forget_leg();
        self.workspace = Workspace::default();
        self.setup.forget_leg();
    }
}

/// Everything side by side.
pub fn wide(ui: &mut Ui, leg: &mut ShownLeg, views: &mut Views) -> Wish {
    views.workspace.refresh(leg);
    views.setup.open |= views.setup.take_wanted();
    if views.setup.open {
        return simulate(views.setup.show(ui, leg));
    }
    let tall = ui.available_height();
    let side = Frame::side_top_panel(ui.style()).inner_margin(12.0);
    let left = Panel::left("left")
        .frame(side)
        .resizable(false)
        .exact_size(282.0);
    let wish = left.show(ui, |ui| {
        scrolled::shrunk(ui, "left", |ui| {
            let wish = guide(ui, leg);
            unlock(ui, leg);
            panel_drive::show(ui, leg);
            wish
        })
    });
    let right = Panel::right("right")
        .frame(side)
        .resizable(false)
        .exact_size(300.0);
    right.show(ui, |ui| {
        scrolled::shrunk(ui, "right", |ui| {
            Workspace::heading(ui, leg);
            views.workspace.show(ui, leg, DISC[0]);
            numbers::show(ui, &leg.seen());
            if let Some(simulation) = leg.simulated_mut() {
                ui.separator();
                panel_break::show(ui, simulation);
            }
        });
    });
    let height = (0.36 * tall).clamp(240.0, 480.0) + views.charts.words_height();
    let bottom = Panel::bottom("charts")
        .frame(side)
        .resizable(false)
        .exact_size(height);
    bottom.show(ui, |ui| {
        let room = ui.available_height();
        scrolled::shrunk(ui, "charts", |ui| charts(ui, leg, views, Some(room)));
    });
    CentralPanel::no_frame().show(ui, |ui| {
        let rect = ui.available_rect_before_wrap();
        if scene::has_room(rect) {
            leg_stage(ui, leg, views);
            let over = UiBuilder::new().max_rect(scene::room(rect));
            ui.scope_builder(over, |ui| {
                scrolled::shrunk(ui, "faults", |ui| {
                    views.faults.show(ui, leg.known_faults(), leg.rig());
                });
            });
        } else {
            fault_strip_below(ui, leg, views);
            leg_stage(ui, leg, views);
        }
    });
    wish.inner
}

/// The faults below a leg that has no room beside it; their explanations cover the leg.
fn fault_strip_below(ui: &mut Ui, leg: &ShownLeg, views: &mut Views) {
    let leg_rect = ui.available_rect_before_wrap();
    let strip = Panel::bottom("fault_strip").resizable(false);
    let back = palette(ui.ctx()).back;
    let strip = strip.frame(Frame::NONE.fill(back).inner_margin(4.0));
    strip.show(ui, |ui| {
        let over = leg_rect.with_max_y(ui.max_rect().top());
        let strip = &mut views.fault_strip;
        strip.show(ui, leg.known_faults(), leg.rig(), over);
    });
}

/// Where the leg is in a window that is not wide: above the rest, or at its left where the window is low.
pub fn leg_panel(ui: &Ui, id: &'static str) -> Panel {
    let room = ui.available_size();
    let panel = if room.y < LOW && room.x > room.y {
        Panel::left(id).exact_size(LEFT_PART * room.x)
    } else {
        Panel::top(id).exact_size((TOP_PART * room.y).max(220.0))
    };
    panel.frame(Frame::NONE).resizable(false)
}

/// The leg above or at the left, and the rest behind tabs.
pub fn narrow(ui: &mut Ui, leg: &mut ShownLeg, views: &mut Views) -> Wish {
    views.workspace.refresh(leg);
    if views.setup.take_wanted() {
        views.tab = Tab::Setup;
    }
    let panel = leg_panel(ui, "leg").show(ui, |ui| {
        let rect = leg_stage(ui, leg, views);
        let corner = Rect::from_min_max(rect.max - TIME, rect.max - vec2(14.0, 6.0));
        let over = UiBuilder::new()
            .max_rect(corner)
            .layout(Layout::bottom_up(Align::Max));
        ui.scope_builder(over, |ui| top_bar::time(ui, leg));
        rect
    });
    CentralPanel::default()
        .show(ui, |ui| {
            let strip = &mut views.fault_strip;
            strip.show(ui, leg.known_faults(), leg.rig(), panel.inner);
            tabs(ui, leg, &mut views.tab);
            ui.separator();
            if views.tab == Tab::Setup {
                // It scrolls by itself.
                return page(ui, leg, views, 0.0);
            }
            let high = ui.available_height();
            scrolled::shrunk(ui, "tabs", |ui| page(ui, leg, views, high))
        })
        .inner
}

fn tabs(ui: &mut Ui, leg: &ShownLeg, tab: &mut Tab) {
    ui.horizontal(|ui| {
        let shown = |(tab, ..): &&(Tab, _, _)| leg.live().is_none() || !tab.simulated();
        let count = TABS.iter().filter(shown).count();
        let spacing = ui.spacing_mut();
        spacing.item_spacing.x = 4.0;
        let gaps = spacing.item_spacing.x * count.saturating_sub(1) as f32;
        let width = (ui.available_width() - gaps) / count as f32;
        if width < TAB_ROOMY {
            ui.spacing_mut().button_padding.x = 2.0;
        }
        for &(this, text, name) in TABS.iter().filter(shown) {
            let button = egui::Button::selectable(*tab == this, text);
            let response = ui.add(button.min_size(vec2(width, 36.0)));
            place(&response, name);
            if response.clicked() {
                *tab = this;
            }
        }
    });
}

/// What a tab has, in a room of some height, points.
fn page(ui: &mut Ui, leg: &mut ShownLeg, views: &mut Views, high: f32) -> Wish {
    match views.tab {
        Tab::Try => {
            let wish = guide(ui, leg);
            numbers::show(ui, &leg.seen());
            return wish;
        }
        Tab::Drive => {
            unlock(ui, leg);
            let [least, most] = DISC;
            let side = Workspace::side_max(ui).min(high.clamp(least, most));
            views.workspace.show(ui, leg, side);
            if leg.live().is_some() {
                numbers::show(ui, &leg.seen());
                ui.separator();
            }
            panel_drive::show(ui, leg);
        }
        Tab::Break => {
            if let Some(simulation) = leg.simulated_mut() {
                panel_break::show(ui, simulation);
            }
        }
        Tab::Charts => {
            charts(ui, leg, views, None);
        }
        Tab::Setup => return simulate(views.setup.show_inside(ui, leg)),
    }
    Wish::None
}

fn simulate(source: Option<RigText>) -> Wish {
    source.map_or(Wish::None, Wish::Simulate)
}

/// The leg that is there, with what was chosen to be seen of it. Gives where it is.
fn leg_stage(ui: &mut Ui, leg: &ShownLeg, views: &mut Views) -> Rect {
    let map = views.workspace.map();
    stage(ui, &leg.seen(), leg.failure(), &mut views.scene, map)
}

/// The leg, how much its sag is enlarged, and why it cannot go on. Gives where it is.
pub fn stage(
    ui: &mut Ui,
    leg: &SeenLeg<'_>,
    failure: Option<String>,
    scene: &mut Scene,
    map: Option<&Map>,
) -> Rect {
    let rect = ui.available_rect_before_wrap();
    let response = scene.show(ui, leg, map, rect.size());
    place(&response, "leg");
    let corner = rect.left_top() + vec2(14.0, scene::CHOICE_TOP);
    let over = UiBuilder::new().max_rect(Rect::from_min_size(corner, vec2(110.0, 60.0)));
    ui.scope_builder(over, |ui| scene.choice(ui));
    if let Some(words) = failure {
        show_failure(ui, rect, words);
    }
    rect
}

/// Why the leg cannot go on, across what was seen of it last.
fn show_failure(ui: &Ui, rect: Rect, words: String) {
    let palette = palette(ui.ctx());
    let font = FontId::proportional(15.0);
    let width = 0.8 * rect.width();
    let text = ui.painter().layout(words, font, palette.error, width);
    let shown = Align2::CENTER_CENTER.anchor_size(rect.center(), text.size());
    ui.painter()
        .rect_filled(shown.expand(10.0), 6.0, palette.card);
    ui.painter().galley(shown.min, text, palette.error);
    place_rect(ui.ctx(), shown, "failure");
}

/// The signals of the leg, and what is recorded of them; in a room of some height, if that is bounded.
fn charts(ui: &mut Ui, leg: &mut ShownLeg, views: &mut Views, room: Option<f32>) {
    let Views {
        charts, recordings, ..
    } = views;
    charts.show_panel(
        ui,
        room,
        leg,
        |leg| SignalSource::new(leg),
        |ui, leg| {
            recordings.show(ui, leg);
        },
    );
}

/// The switch without which a live leg takes no command: before everything that commands it.
fn unlock(ui: &mut Ui, leg: &mut ShownLeg) {
    if let Some(live) = leg.live_mut() {
        panel_unlock::show(ui, live);
    }
}

/// What to try first, with a line below; nothing for a live leg.
fn guide(ui: &mut Ui, leg: &mut ShownLeg) -> Wish {
    let Some(simulation) = leg.simulated_mut() else {
        return Wish::None;
    };
    let wish = panel_guide::show(ui, simulation);
    ui.separator();
    wish
}
