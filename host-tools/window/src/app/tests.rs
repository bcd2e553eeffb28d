#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod charts;
mod live;
mod loaded;
mod looks;
mod recordings;
mod setup;
mod typed;

use super::App;
use crate::simulation::Simulation;
use egui::{
    Context, DroppedFileHandle, Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, Shape,
    Vec2, vec2,
};
use leg_firmware::supervisor::State;

/// A window without a screen.
struct Window {
    app: App,
    ctx: Context,
    time_s: f64,
    size: Vec2,
    /// Every text of the last frame, a line each.
    texts: Vec<String>,
    /// Its scroll bars.
    bars: Vec<Rect>,
}

/// The scroll bars in what is drawn: nothing else is as slim.
fn bars(shape: &Shape) -> Vec<Rect> {
    let width = crate::theme::BAR_WIDTH;
    match shape {
        Shape::Rect(bar) if (bar.rect.width() - width).abs() < 0.1 && bar.rect.height() > 20.0 => {
            vec![bar.rect]
        }
        Shape::Vec(shapes) => shapes.iter().flat_map(bars).collect(),
        _ => Vec::new(),
    }
}

fn texts(shape: &Shape) -> Vec<String> {
    match shape {
        Shape::Text(text) => vec![text.galley.text().to_owned()],
        Shape::Vec(shapes) => shapes.iter().flat_map(texts).collect(),
        _ => Vec::new(),
    }
}

impl Window {
    fn new() -> Self {
        Self::sized(1280.0, 720.0)
    }

    fn sized(width: f32, height: f32) -> Self {
        let ctx = Context::default();
        Self::with(App::new(&ctx), ctx, vec2(width, height))
    }

    fn with(app: App, ctx: Context, size: Vec2) -> Self {
        let mut window = Self {
            app,
            ctx,
            time_s: 0.0,
            size,
            texts: Vec::new(),
            bars: Vec::new(),
        };
        window.frames(3);
        window
    }

    fn frame(&mut self, events: Vec<Event>) {
        self.frame_with(events, Vec::new());
    }

    fn frame_with(&mut self, events: Vec<Event>, dropped_files: Vec<DroppedFileHandle>) {
        self.time_s += 0.02;
        let mut input = RawInput {
            events,
            dropped_files,
            time: Some(self.time_s),
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size)),
            ..RawInput::default()
        };
        self.app.take(&mut input);
        let ctx = self.ctx.clone();
        let mut output = ctx.run_ui(input, |ui| self.app.frame(ui));
        output.textures_delta.clear();
        let shapes = || output.shapes.iter().map(|clipped| &clipped.shape);
        self.texts = shapes().flat_map(texts).collect();
        self.bars = shapes().flat_map(bars).collect();
    }

    fn frames(&mut self, count: u32) {
        for _ in 0..count {
            self.frame(Vec::new());
        }
    }

    fn key(&mut self, key: Key) {
        for pressed in [true, false] {
            self.frame(vec![Event::Key {
                key,
                physical_key: None,
                pressed,
                repeat: false,
                modifiers: Modifiers::NONE,
            }]);
        }
    }

    fn press(&mut self, name: &str) {
        self.press_at(self.app.places.rects[name].center());
    }

    fn press_at(&mut self, at: Pos2) {
        self.press_long_at(at, 0);
    }

    /// So many frames lie between the press and its release.
    fn press_long_at(&mut self, at: Pos2, frames: u32) {
        let button = |pressed| Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        self.frame(vec![Event::PointerMoved(at)]);
        self.frame(vec![button(true)]);
        self.frames(frames);
        self.frame(vec![button(false)]);
        self.frame(vec![Event::PointerMoved(Pos2::ZERO)]);
        self.frames(5);
    }

    fn focus(&mut self, name: &str) {
        for _ in 0..100 {
            if self.app.places.focused.as_deref() == Some(name) {
                return;
            }
            self.key(Key::Tab);
        }
        panic!("{name} has not got the focus");
    }

    fn leg(&self) -> &Simulation {
        let leg = self.app.stage.leg().unwrap();
        leg.simulated().unwrap()
    }

    fn state(&self) -> State {
        self.leg().state()
    }

    fn says(&self, words: &str) -> bool {
        self.texts.iter().any(|text| text.contains(words))
    }

    fn rect(&self, name: &str) -> Rect {
        self.app.places.rects[name]
    }

    fn shows(&self, name: &str) -> bool {
        self.app.places.rects.contains_key(name)
    }
}

#[test]
fn a_key_stops_the_leg_and_does_not_press_the_control_in_focus() {
    for (control, key) in [
        ("guide_payload", Key::Space),
        ("theme", Key::Space),
        ("workspace", Key::Space),
        ("disarm", Key::Escape),
    ] {
        let mut window = Window::new();
        window.focus(control);
        let (theme, focused) = (window.ctx.theme(), window.app.places.focused.clone());
        window.key(key);
        window.frames(5);
        assert_eq!(window.state(), State::Held, "{control}");
        assert_eq!(window.app.places.focused, focused);
        assert_eq!(window.leg().payload_kg(), 0.0);
        assert_eq!(window.ctx.theme(), theme);
    }
}

#[test]
fn a_key_stops_the_leg_from_a_menu_and_a_text_field() {
    for key in [Key::Space, Key::Escape] {
        let mut window = Window::new();
        window.press("rate");
        assert!(window.shows("rate_tenth"));
        window.key(key);
        window.frames(5);
        assert_eq!(window.state(), State::Held);
        assert!(window.shows("rate_tenth"));

        let mut window = Window::new();
        window.press("signals");
        window.press("search");
        assert_eq!(window.app.places.focused.as_deref(), Some("search"));
        window.frame(vec![Event::Text("mm".into())]);
        window.key(key);
        window.frames(5);
        assert_eq!(window.state(), State::Held);
        assert!(window.shows("search"));
        assert_eq!(window.app.places.focused.as_deref(), Some("search"));
    }
}

#[test]
fn a_press_whose_release_is_seen_late_is_a_click() {
    let mut window = Window::new();
    let at = window.rect("stop").center();
    window.press_long_at(at, 100);
    assert_eq!(window.state(), State::Held);
    window.press("rate");
    let at = window.rect("rate_tenth").center();
    window.press_long_at(at, 100);
    assert!(!window.shows("rate_tenth"));
    assert_eq!(window.leg().pace.rate, 0.1);
}

#[test]
fn a_new_leg_ends_the_pause_of_the_charts() {
    let mut window = Window::new();
    window.press("pause");
    window.frames(50);
    let time_s = |window: &Window| window.leg().leg().time_s();
    let before_s = time_s(&window);
    window.press("start_again");
    assert!(time_s(&window) < before_s);
    assert!(!window.app.views.charts.paused());
}

#[test]
fn time_that_is_left_out_is_shown() {
    let mut window = Window::new();
    assert!(!window.shows("left_out"));
    window.time_s += 3.0;
    window.frames(2);
    assert!(window.shows("left_out"));
}
