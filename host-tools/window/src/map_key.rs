//! What the colours of a map mean: a bar from its lowest value to its highest, with its name and unit.

use crate::map::Map;
use crate::map_mesh::colour;
use crate::places::place;
use crate::theme::{Palette, palette};
use egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, pos2, vec2,
};

/// Its width, points.
pub const WIDTH: f32 = 66.0;

/// Width of its bar, points, and of how many colours a bar is made.
const BAR: f32 = 12.0;
const STEPS: u8 = 32;

/// Heights of its lines of words, points.
const LINE: f32 = 15.0;

/// A bar of the colours of a range: its first one at the first end, its last one at the other.
pub fn bar(painter: &Painter, rect: Rect, upright: bool, colour: impl Fn(f32) -> Color32) {
    let cell = |step: u8| {
        let parts = [step, step + 1].map(|end| f32::from(end) / f32::from(STEPS));
        if upright {
            let [low, high] = parts.map(|part| rect.bottom() - part * rect.height());
            Rect::from_min_max(pos2(rect.left(), high - 0.5), pos2(rect.right(), low))
        } else {
            let [left, right] = parts.map(|part| rect.left() + part * rect.width());
            Rect::from_min_max(pos2(left, rect.top()), pos2(right + 0.5, rect.bottom()))
        }
    };
    for step in 0..STEPS {
        painter.rect_filled(
            cell(step),
            0.0,
            colour(f32::from(step) / f32::from(STEPS - 1)),
        );
    }
}

/// Shows it beside the disc. Its room is taken without a map, too: nothing moves.
pub fn show(ui: &mut Ui, map: Option<&Map>, height: f32) {
    let (rect, response) = ui.allocate_exact_size(vec2(WIDTH, height), Sense::hover());
    let Some((map, [low, high])) = map.and_then(|map| Some((map, map.range()?))) else {
        return;
    };
    let palette = palette(ui.ctx());
    let painter = ui.painter_at(rect);
    let [name, unit] = map.quantity().words();
    let text = |at: Pos2, align: Align2, words: &str, colour: Color32| {
        painter.text(at, align, words, FontId::proportional(12.0), colour);
    };
    text(rect.left_top(), Align2::LEFT_TOP, name, palette.text);
    let below = rect.left_top() + vec2(0.0, LINE);
    text(below, Align2::LEFT_TOP, unit, palette.faint);
    let bar_rect = Rect::from_min_max(
        rect.left_top() + vec2(0.0, 2.5 * LINE),
        pos2(rect.left() + BAR, rect.bottom() - 2.0 * LINE),
    );
    bar(&painter, bar_rect, true, |part| {
        colour(&palette, part.into())
    });
    edge(&painter, bar_rect, &palette);
    let font = FontId::monospace(11.5);
    for (value, at, align) in [
        (high, bar_rect.right_top(), Align2::LEFT_TOP),
        (low, bar_rect.right_bottom(), Align2::LEFT_BOTTOM),
    ] {
        let words = format!("{value:6.1}");
        painter.text(
            at + vec2(2.0, 0.0),
            align,
            words,
            font.clone(),
            palette.text,
        );
    }
    if map.has_gaps() {
        let square = Rect::from_min_size(pos2(rect.left(), rect.bottom() - BAR), vec2(BAR, BAR));
        painter.rect_filled(square, 0.0, colour(&palette, f64::NAN));
        edge(&painter, square, &palette);
        let beside = square.right_center() + vec2(4.0, 0.0);
        text(beside, Align2::LEFT_CENTER, "no pose", palette.faint);
    }
    place(&response, "map_key");
}

fn edge(painter: &Painter, rect: Rect, palette: &Palette) {
    let line = Stroke::new(1.0, palette.faint);
    painter.rect_stroke(rect, 0.0, line, StrokeKind::Outside);
}

/// The same in words.
#[must_use]
pub fn words(map: &Map) -> Option<String> {
    let [low, high] = map.range()?;
    let [name, unit] = map.quantity().words();
    Some(format!("{name}, {low:.1} to {high:.1} {unit}"))
}
