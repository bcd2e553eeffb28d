//! The window in a page.

use crate::app::App;
use crate::bits;
use crate::frame_cost;
use crate::live_leg::PageIdentity;
use crate::live_leg::browser_line::BrowserLine;
use crate::live_leg::messages;
use crate::live_leg::opening::Opening;
use eframe::{WebOptions, WebRunner};
use egui::Context;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::HtmlCanvasElement;

/// The window of a page, as its script holds it.
#[wasm_bindgen]
pub struct LegWindow {
    runner: WebRunner,
}

#[wasm_bindgen]
impl LegWindow {
    /// A window that shows nothing yet.
    #[wasm_bindgen(constructor)]
    #[allow(clippy::new_without_default, reason = "a script makes it")]
    pub fn new() -> Self {
        Self {
            runner: WebRunner::new(),
        }
    }

    /// Shows it on a canvas.
    ///
    /// # Errors
    /// A browser without WebGL.
    pub async fn start(&self, canvas: HtmlCanvasElement) -> Result<(), JsValue> {
        choose_painting(&canvas)?;
        let options = WebOptions::default();
        let app = Box::new(|creation: &eframe::CreationContext<'_>| {
            let app: Box<dyn eframe::App> = Box::new(app(&creation.egui_ctx));
            Ok(app)
        });
        self.runner.start(canvas, options, app).await
    }

    /// What it shows, as JSON.
    #[must_use]
    pub fn state(&self) -> String {
        let app = self.runner.app_mut::<App>();
        let state = app.map(|app| app.state());
        state
            .and_then(|state| serde_json::to_string(&state).ok())
            .unwrap_or_else(|| "null".into())
    }

    /// Tells a live leg that the page is there; at a time since the page was opened, s. The page's timer calls it, which a browser
    /// slows down as soon as the page is hidden.
    pub fn show_life(&self, now_s: f64) {
        if let Some(mut app) = self.runner.app_mut::<App>() {
            app.show_life(now_s);
        }
    }

    /// What the firmware decides in a ready scenario, as one number.
    ///
    /// # Errors
    /// A scenario that does not run.
    pub fn bits(&self, scenario: &str) -> Result<String, String> {
        bits::row(scenario)
    }

    /// What so many frames take without what draws them, as JSON.
    #[must_use]
    pub fn frame_cost(&self, frames: u32) -> String {
        let cost = frame_cost::measure(frames);
        serde_json::to_string(&cost).unwrap_or_else(|_| "null".into())
    }

    /// Why it shows nothing any more.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        self.runner.panic_summary().map(|summary| summary.message())
    }
}

/// Edges are drawn soft by the toolkit: what the browser would do for that as well costs a processor that paints most of its time. The
/// toolkit takes the painting that a canvas has got.
fn choose_painting(canvas: &HtmlCanvasElement) -> Result<(), JsValue> {
    let attributes = js_sys::Object::new();
    for unused in ["antialias", "depth", "stencil", "alpha"] {
        js_sys::Reflect::set(&attributes, &unused.into(), &false.into())?;
    }
    canvas.get_context_with_context_options("webgl2", &attributes)?;
    Ok(())
}

/// The window of the leg that the page's address names; that of a simulated one if it names none.
fn app(ctx: &Context) -> App {
    let location = web_sys::window().map(|window| window.location());
    let fragment = location.and_then(|location| location.hash().ok());
    match fragment.as_deref().and_then(messages::address) {
        None => App::new(ctx),
        Some(address) => App::live(ctx, opening(address)),
    }
}

fn opening(address: &str) -> Result<Opening, String> {
    let line = BrowserLine::open(address)?;
    let page = identity().ok_or("The browser has no random numbers.")?;
    Ok(Opening::new(Box::new(line), page, address))
}

fn identity() -> Option<PageIdentity> {
    let mut bytes = [0; 6];
    let crypto = web_sys::window()?.crypto().ok()?;
    crypto.get_random_values_with_u8_array(&mut bytes).ok()?;
    let [a, b, c, d, e, f] = bytes;
    Some(PageIdentity {
        host: u32::from_le_bytes([a, b, c, d]),
        first_number: u16::from_le_bytes([e, f]),
    })
}
