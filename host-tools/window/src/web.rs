//! The window in a page.

use crate::app::App;
use crate::bits;
use eframe::{WebOptions, WebRunner};
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
        let options = WebOptions::default();
        let app = Box::new(|creation: &eframe::CreationContext<'_>| {
            let app: Box<dyn eframe::App> = Box::new(App::new(&creation.egui_ctx));
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

    /// What the firmware decides in a ready scenario, as one number.
    ///
    /// # Errors
    /// A scenario that does not run.
    pub fn bits(&self, scenario: &str) -> Result<String, String> {
        bits::row(scenario)
    }

    /// Why it shows nothing any more.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        self.runner.panic_summary().map(|summary| summary.message())
    }
}
