//! What the window itself takes for its frames, without what draws them: the leg's ticks, layout, and the triangles that a graphics
//! card is given. A window without a screen is measured, so that neither a graphics card nor its lack is.

use crate::app::App;
use egui::{Context, Pos2, RawInput, Rect, vec2};
use serde::Serialize;
use web_time::Instant;

/// Frames of a second.
const FRAME_HZ: f64 = 60.0;

/// Frames until everything is there that is made once.
const FIRST_FRAMES: u32 = 30;

/// The size of the window, points.
const SIZE: [f32; 2] = [1280.0, 720.0];

/// Medians over some frames, 60 of which are a second of the leg.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameCost {
    /// Frames that were measured.
    pub frames: u32,
    /// Of the leg's ticks, ms.
    pub ticks_ms: f64,
    /// Of everything that is laid out, ms.
    pub layout_ms: f64,
    /// Of the triangles of that, ms.
    pub triangles_ms: f64,
    /// The three as a part of the time that a frame has: above 1 the leg falls behind the clock.
    pub part: f64,
}

/// Measures so many frames of a new window.
#[must_use]
pub fn measure(frames: u32) -> FrameCost {
    let ctx = Context::default();
    let mut app = App::new(&ctx);
    let [width, height] = SIZE;
    let mut times = Vec::new();
    for frame in 0..FIRST_FRAMES + frames {
        let input = RawInput {
            time: Some(f64::from(frame) / FRAME_HZ),
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(width, height))),
            ..RawInput::default()
        };
        let began = Instant::now();
        let mut output = ctx.run_ui(input, |ui| app.frame(ui));
        let laid_out = Instant::now();
        let triangles = ctx.tessellate(output.shapes, output.pixels_per_point);
        let ended = Instant::now();
        drop(triangles);
        output.textures_delta.clear();
        if frame >= FIRST_FRAMES {
            let ms = |since: Instant, until: Instant| 1000.0 * (until - since).as_secs_f64();
            let ticks_ms = app.ticks_ms();
            let layout_ms = ms(began, laid_out) - ticks_ms;
            times.push([ticks_ms, layout_ms, ms(laid_out, ended)]);
        }
    }
    let median = |part: usize| crate::work::median(times.iter().map(|times| times[part]));
    let [ticks_ms, layout_ms, triangles_ms] = [0, 1, 2].map(median);
    FrameCost {
        frames,
        ticks_ms,
        layout_ms,
        triangles_ms,
        part: (ticks_ms + layout_ms + triangles_ms) * FRAME_HZ / 1000.0,
    }
}

#[cfg(test)]
mod tests {
    use super::measure;

    #[test]
    fn the_parts_of_a_frame_are_measured() {
        let cost = measure(20);
        assert!(cost.ticks_ms > 0.0 && cost.layout_ms > 0.0 && cost.triangles_ms > 0.0);
    }
}
