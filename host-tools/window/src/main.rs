//! The window on a desktop. In a page it is started by a script: see `web.rs`.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> eframe::Result {
    use eframe::egui::{ViewportBuilder, vec2};
    let options = eframe::NativeOptions {
        viewport: ViewportBuilder::default().with_inner_size(vec2(1280.0, 720.0)),
        ..eframe::NativeOptions::default()
    };
    let app = Box::new(|creation: &eframe::CreationContext<'_>| {
        let app: Box<dyn eframe::App> = Box::new(leg_window::app::App::new(&creation.egui_ctx));
        Ok(app)
    });
    eframe::run_native("Tendon-driven leg", options, app)
}

#[cfg(target_arch = "wasm32")]
fn main() {}
