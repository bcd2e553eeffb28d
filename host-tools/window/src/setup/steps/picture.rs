//! A picture of what is done by hand, or moves: the plates from the side, their tendons, motors and load cells.

use crate::theme::{Palette, palette, series};
use egui::{Align2, FontId, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

/// Its size, points.
const WIDTH: f32 = 330.0;
const HEIGHT: f32 = 170.0;

/// What is shown.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepPicture {
    /// The tendon that is meant, from 0.
    pub tendon: Option<usize>,
    /// What hangs on its cell in its place, kg.
    pub weight_kg: Option<f64>,
    /// How far its motor pulls it in, mm.
    pub pull_mm: Option<f32>,
    /// Its motor is turned by hand.
    pub turned: bool,
    /// Its motor pulls it in and pays it out.
    pub both_ways: bool,
    /// The leg swings.
    pub swings: bool,
    /// All tendons are slack.
    pub slack: bool,
    /// No payload may hang on the tip.
    pub no_payload: bool,
}

pub(super) fn show(ui: &mut Ui, shown: &StepPicture) {
    let size = vec2(WIDTH.min(ui.available_width()), HEIGHT);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let palette = palette(ui.ctx());
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 8.0, palette.card);
    let x = |part: f32| rect.left() + part * rect.width();
    let (top, plate) = (rect.top() + 44.0, rect.top() + 104.0);
    bar(&painter, [x(0.1), x(0.9)], top, &palette);
    bar(&painter, [x(0.22), x(0.78)], plate, &palette);
    let line = Stroke::new(4.0, palette.shaft);
    painter.line_segment([pos2(x(0.5), top), pos2(x(0.5), plate - 22.0)], line);
    painter.circle_filled(pos2(x(0.5), plate - 22.0), 5.0, palette.brass);
    let tip = pos2(x(0.5), rect.bottom() - 14.0);
    painter.line_segment([pos2(x(0.5), plate), tip], line);
    if shown.swings {
        swings(&painter, pos2(x(0.5), plate - 22.0), tip, &palette);
    }
    if shown.no_payload {
        let aside = if shown.swings { 60.0 } else { 26.0 };
        no_payload(&painter, tip + vec2(aside, -8.0), &palette);
    }
    for tendon in 0..3 {
        // Seen from the side, they stand beside each other; the middle one is behind the joint.
        let at = x([0.25, 0.37, 0.75][tendon]);
        one(&painter, rect, at, [top, plate], tendon, shown, &palette);
    }
}

fn bar(painter: &Painter, [left, right]: [f32; 2], y: f32, palette: &Palette) {
    let rect = Rect::from_min_max(pos2(left, y - 4.0), pos2(right, y + 4.0));
    painter.rect_filled(rect, 2.0, palette.plate);
}

fn one(
    painter: &Painter,
    rect: Rect,
    at: f32,
    [top, plate]: [f32; 2],
    tendon: usize,
    shown: &StepPicture,
    palette: &Palette,
) {
    let meant = shown.tendon.is_none_or(|meant| meant == tendon);
    let colour = if meant {
        series(painter.ctx(), tendon)
    } else {
        palette.faint
    };
    let motor = Rect::from_center_size(pos2(at, top - 18.0), vec2(26.0, 18.0));
    painter.rect_stroke(
        motor,
        3.0,
        Stroke::new(1.5, colour),
        egui::StrokeKind::Inside,
    );
    let font = FontId::proportional(12.0);
    let number = (tendon + 1).to_string();
    painter.text(
        motor.center(),
        Align2::CENTER_CENTER,
        number,
        font.clone(),
        palette.text,
    );
    // The load cell is where the tendon meets its motor.
    painter.circle_filled(pos2(at, top + 6.0), 4.0, colour);
    let ends = [pos2(at, top + 6.0), pos2(at, plate)];
    let hung = shown.weight_kg.filter(|_| meant);
    let stroke = Stroke::new(if meant { 2.5 } else { 1.2 }, colour);
    match hung {
        Some(kg) => weight(painter, ends, kg, stroke, palette),
        None if shown.slack => slack(painter, ends, stroke),
        None => {
            painter.line_segment(ends, stroke);
        }
    }
    if shown.turned && meant {
        turn(painter, motor.center(), palette);
    }
    if shown.both_ways && meant {
        both_ways(painter, pos2(at + 14.0, 0.5 * (top + plate)), palette);
    }
    if let Some(pull_mm) = shown.pull_mm.filter(|_| meant) {
        let way = vec2(0.0, if pull_mm < 0.0 { 26.0 } else { -26.0 });
        let from = pos2(at + 14.0, 0.5 * (top + plate)) - 0.5 * way;
        painter.arrow(from, way, Stroke::new(2.5, palette.warning));
        let side = if at < rect.center().x {
            Align2::RIGHT_CENTER
        } else {
            Align2::LEFT_CENTER
        };
        let beside = if at < rect.center().x { -8.0 } else { 26.0 };
        let words = format!("{:.1} mm", pull_mm.abs());
        painter.text(
            pos2(at + beside, 0.5 * (top + plate)),
            side,
            words,
            font,
            palette.text,
        );
    }
}

/// Arrows up and down beside a tendon.
fn both_ways(painter: &Painter, middle: Pos2, palette: &Palette) {
    let stroke = Stroke::new(2.5, palette.warning);
    for way in [vec2(0.0, 17.0), vec2(0.0, -17.0)] {
        painter.arrow(middle, way, stroke);
    }
}

/// The way of the tip to both sides.
fn swings(painter: &Painter, joint: Pos2, tip: Pos2, palette: &Palette) {
    let stroke = Stroke::new(2.5, palette.warning);
    let length = tip.y - joint.y;
    let point = |part: f32| {
        let angle = 0.35 * part;
        joint + length * vec2(angle.sin(), angle.cos())
    };
    for side in [1.0, -1.0] {
        let steps = 0..=8_u8;
        let arc = steps.map(|step| point(side * f32::from(step) / 8.0));
        painter.add(Shape::line(arc.collect(), stroke));
        painter.arrow(
            point(0.9 * side),
            2.5 * (point(side) - point(0.9 * side)),
            stroke,
        );
    }
}

/// The tendon is off its cell, and a weight hangs there.
fn weight(painter: &Painter, [from, to]: [Pos2; 2], kg: f64, stroke: Stroke, palette: &Palette) {
    let end = pos2(from.x, to.y - 32.0);
    painter.line_segment([from, end], stroke);
    let block = Rect::from_min_size(end - vec2(19.0, 0.0), vec2(38.0, 24.0));
    painter.rect_filled(block, 3.0, palette.brass);
    let words = format!("{kg} kg");
    painter.text(
        block.center(),
        Align2::CENTER_CENTER,
        words,
        FontId::proportional(11.5),
        palette.back,
    );
}

/// Three quarters of a circle with an arrow.
fn turn(painter: &Painter, centre: Pos2, palette: &Palette) {
    let stroke = Stroke::new(2.5, palette.warning);
    let point = |step: u8| {
        let angle = f32::from(step) / 12.0 * 0.75 * std::f32::consts::TAU;
        centre + 20.0 * vec2(-angle.cos(), -angle.sin())
    };
    painter.add(Shape::line((0..=12).map(point).collect(), stroke));
    painter.arrow(point(11), (point(12) - point(11)) * 1.6, stroke);
}

fn slack(painter: &Painter, [from, to]: [Pos2; 2], stroke: Stroke) {
    let point = |step: u8| {
        let part = f32::from(step) / 16.0;
        let bend = 7.0 * (part * std::f32::consts::TAU).sin();
        from + (to - from) * part + vec2(bend, 0.0)
    };
    painter.add(Shape::line((0..=16).map(point).collect(), stroke));
}

/// A weight that is crossed out.
fn no_payload(painter: &Painter, at: Pos2, palette: &Palette) {
    painter.circle_filled(at, 9.0, palette.brass);
    let cross = Stroke::new(3.0, palette.danger);
    for side in [1.0, -1.0] {
        let arm = vec2(12.0, 12.0 * side);
        painter.line_segment([at - arm, at + arm], cross);
    }
    let words = "no payload";
    painter.text(
        at + vec2(18.0, 0.0),
        Align2::LEFT_CENTER,
        words,
        FontId::proportional(12.0),
        palette.text,
    );
}
