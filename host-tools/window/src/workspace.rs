//! The workspace from above, on which the target is dragged.

use crate::map::{Map, Quantity};
use crate::map_key;
use crate::map_mesh::mesh;
use crate::places::place;
use crate::pointer;
use crate::shown_leg::ShownLeg;
use crate::theme::{Palette, mixed, palette};
use egui::{
    Align, Align2, ComboBox, FontId, Key, Painter, Pos2, Response, RichText, Sense, Shape, Stroke,
    Ui, Vec2, vec2,
};
use leg_base::angles;
use leg_firmware::command::Command;

/// Space around the disc for its labels, points.
const MARGIN: f32 = 28.0;

/// Rings of the disc, degrees apart.
const RING_DEG: f64 = 10.0;

/// A press of an arrow key, degrees.
const KEY_DEG: f64 = 1.0;

/// The largest tilt that is commanded, as a part of the rig's: a move to its very edge may round to beyond it.
const EDGE: f64 = 0.9999;

/// A disc whose radius is the sine of the tilt.
struct Disc {
    centre: Pos2,
    radius: f32,
    sine_max: f64,
}

impl Disc {
    fn place(&self, [x, y]: [f64; 2]) -> Pos2 {
        let scale = f64::from(self.radius) / self.sine_max;
        self.centre + vec2((x * scale) as f32, (-y * scale) as f32)
    }

    /// The direction of a point, inside the workspace.
    fn direction(&self, at: Pos2) -> [f64; 2] {
        let offset = (at - self.centre) / self.radius;
        let scale = self.sine_max;
        self.limit([f64::from(offset.x) * scale, f64::from(-offset.y) * scale])
    }

    fn limit(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let sine = (x * x + y * y).sqrt();
        let shrink = (EDGE * self.sine_max / sine.max(1e-12)).min(1.0);
        [x * shrink, y * shrink]
    }
}

/// What the disc shows besides the leg.
#[derive(Default)]
pub struct Workspace {
    /// Of what there is a map under it.
    quantity: Option<Quantity>,
    map: Option<Map>,
}

impl Workspace {
    /// What the disc is for, above it: words that come with the pointer would cover what is beside it.
    pub fn heading(ui: &mut Ui, leg: &ShownLeg) {
        ui.horizontal(|ui| {
            ui.heading("Drag the target");
            let words = if leg.locked().is_some() {
                "locked"
            } else {
                "arrow keys: 1° each"
            };
            let words = RichText::new(words).small();
            ui.label(words.color(palette(ui.ctx()).faint));
        });
    }

    /// The widest disc that leaves room for what its colours mean, points.
    #[must_use]
    pub fn side_max(ui: &Ui) -> f32 {
        ui.available_width() - map_key::WIDTH - ui.spacing().item_spacing.x
    }

    /// Draws the workspace, and moves the leg to where the target is dragged.
    pub fn show(&mut self, ui: &mut Ui, leg: &mut ShownLeg, side: f32) {
        ui.horizontal(|ui| {
            disc(ui, leg, side, self.map.as_ref());
            map_key::show(ui, self.map.as_ref(), side);
        });
        self.choice(ui);
    }

    /// The map that is chosen.
    #[must_use]
    pub const fn map(&self) -> Option<&Map> {
        self.map.as_ref()
    }

    /// Makes the map that is wanted, unless it is there.
    pub fn refresh(&mut self, leg: &ShownLeg) {
        let (Some(quantity), Some(telemetry)) = (self.quantity, leg.telemetry()) else {
            self.map = None;
            return;
        };
        let payload_kg = leg.payload_kg();
        let pretension_n = f64::from(telemetry.pretension_n);
        let holds = |map: &Map| map.holds(quantity, payload_kg, pretension_n);
        if !self.map.as_ref().is_some_and(holds) {
            self.map = Some(Map::new(quantity, leg.rig(), payload_kg, pretension_n));
        }
    }

    fn choice(&mut self, ui: &mut Ui) {
        let name = self.quantity.map_or("none", |quantity| quantity.words()[0]);
        let choice = ComboBox::from_id_salt("map").selected_text(format!("Map: {name}"));
        let choice = choice.width(140.0).show_ui(ui, |ui| {
            let none = ui.selectable_value(&mut self.quantity, None, "none");
            place(&none, "map_none");
            for (quantity, name, unit) in Quantity::ALL {
                let text = format!("{name}, {unit}");
                let item = ui.selectable_value(&mut self.quantity, Some(quantity), text);
                place(&item, format!("map_{name}"));
            }
        });
        place(&choice.response, "map");
    }
}

fn disc(ui: &mut Ui, leg: &mut ShownLeg, side: f32, map: Option<&Map>) {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(side), Sense::click_and_drag());
    let disc = Disc {
        centre: rect.center(),
        radius: 0.5 * side - MARGIN,
        sine_max: leg.rig().tilt_deg.to_radians().sin(),
    };
    place(&response, "workspace");
    drag(ui, &response, &disc, leg);
    paint(
        &ui.painter_at(rect),
        &disc,
        leg,
        &palette(ui.ctx()),
        map,
        response.has_focus(),
    );
}

fn drag(ui: &Ui, response: &Response, disc: &Disc, leg: &mut ShownLeg) {
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    let pressed = response.clicked() || response.dragged() || response.drag_stopped();
    let pointed = pointer::place(response).filter(|_| pressed);
    let wanted = pointed
        .map(|at| disc.direction(at))
        .or_else(|| stepped(ui, response, disc, leg));
    let Some(wanted) = wanted else { return };
    let [x, y] = wanted.map(|part| part as f32);
    if leg.locked().is_none() && leg.target().map(|part| part as f32) != [x, y] {
        leg.command(Command::Move { x, y }, "move");
    }
}

/// Where the arrow keys lead from where the leg was sent.
fn stepped(ui: &Ui, response: &Response, disc: &Disc, leg: &ShownLeg) -> Option<[f64; 2]> {
    if !response.has_focus() {
        return None;
    }
    let filter = egui::EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..Default::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let pressed = |key| f64::from(u8::from(ui.input(|input| input.key_pressed(key))));
    let right = pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
    let up = pressed(Key::ArrowUp) - pressed(Key::ArrowDown);
    let step = KEY_DEG.to_radians();
    let [x, y] = leg.target();
    (right != 0.0 || up != 0.0).then(|| disc.limit([x + step * right, y + step * up]))
}

fn paint(
    painter: &Painter,
    disc: &Disc,
    leg: &ShownLeg,
    palette: &Palette,
    map: Option<&Map>,
    focus: bool,
) {
    let line = Stroke::new(1.0, mixed(palette.line, palette.faint, 0.3));
    let rim = if focus { palette.target } else { palette.faint };
    painter.circle_filled(
        disc.centre,
        disc.radius,
        mixed(palette.back, palette.card, 0.8),
    );
    if let Some(map) = map {
        painter.add(Shape::mesh(mesh(map, palette, 1.0, |at| disc.place(at))));
    }
    painter.circle_stroke(disc.centre, disc.radius, Stroke::new(1.5, rim));
    let tilt_deg = leg.rig().tilt_deg;
    let rings = (tilt_deg / RING_DEG).ceil() as u32;
    for ring in 1..rings {
        let tilt = f64::from(ring) * RING_DEG;
        let radius = disc.radius * (tilt.to_radians().sin() / disc.sine_max) as f32;
        painter.circle_stroke(disc.centre, radius, line);
        tilt_label(painter, disc, tilt, radius, palette);
    }
    tilt_label(painter, disc, tilt_deg, disc.radius, palette);
    for azimuth_deg in [0.0, 90.0, 180.0, 270.0] {
        let [x, y] = angles::unit_vector(azimuth_deg);
        let out = vec2(x as f32, -y as f32);
        painter.line_segment([disc.centre, disc.centre + out * disc.radius], line);
        // Beside the disc, whatever its width.
        let align = Align2([align(-out.x), align(-out.y)]);
        painter.text(
            disc.centre + out * (disc.radius + 4.0),
            align,
            format!("{azimuth_deg:.0}°"),
            FontId::proportional(11.0),
            palette.faint,
        );
    }
    marks(painter, disc, leg, palette);
}

/// Text that is aligned so is on that side of its place.
fn align(side: f32) -> Align {
    if side > 0.5 {
        Align::Max
    } else if side < -0.5 {
        Align::Min
    } else {
        Align::Center
    }
}

/// The tilt of a ring, in a gap of it.
fn tilt_label(painter: &Painter, disc: &Disc, tilt_deg: f64, radius: f32, palette: &Palette) {
    let at = disc.centre + vec2(-0.707, 0.707) * radius;
    let font = FontId::proportional(10.5);
    let galley = painter.layout_no_wrap(format!("{tilt_deg:.0}°"), font, palette.faint);
    let rect = Align2::CENTER_CENTER.anchor_size(at, galley.size());
    painter.rect_filled(rect.expand2(vec2(2.0, -1.0)), 3.0, palette.back);
    painter.galley(rect.min, galley, palette.faint);
}

/// Where the tip is, and where it was sent.
fn marks(painter: &Painter, disc: &Disc, leg: &ShownLeg, palette: &Palette) {
    let leg_axis = leg.leg_axis();
    let [x, y] = disc.limit([leg_axis.x, leg_axis.y]);
    let is = disc.place([x, y]);
    let target = disc.place(leg.target());
    painter.line_segment([target, is], Stroke::new(2.0, palette.error));
    painter.circle_filled(is, 5.0, palette.error);
    painter.circle_stroke(target, 9.0, Stroke::new(2.5, palette.target));
    for arm in [vec2(13.0, 0.0), vec2(0.0, 13.0)] {
        painter.line_segment(
            [target - arm, target + arm],
            Stroke::new(1.2, palette.target),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::{Disc, EDGE};
    use egui::pos2;

    #[test]
    fn a_point_and_its_direction_belong_together() {
        let disc = Disc {
            centre: pos2(100.0, 100.0),
            radius: 80.0,
            sine_max: 0.5,
        };
        assert_eq!(disc.place([0.5, 0.0]), pos2(180.0, 100.0));
        assert_eq!(disc.place([0.0, 0.25]), pos2(100.0, 60.0));
        let [x, y] = disc.direction(pos2(120.0, 140.0));
        assert!((x - 0.125).abs() < 1e-6 && (y + 0.25).abs() < 1e-6);
    }

    #[test]
    fn what_is_beyond_the_edge_is_led_back_to_it() {
        let disc = Disc {
            centre: pos2(0.0, 0.0),
            radius: 10.0,
            sine_max: 0.5,
        };
        let [x, y] = disc.direction(pos2(30.0, -40.0));
        assert!(((x * x + y * y).sqrt() - EDGE * 0.5).abs() < 1e-9);
        assert!((y / x - 4.0 / 3.0).abs() < 1e-6);
        assert_eq!(disc.limit([0.0, 0.0]), [0.0, 0.0]);
    }
}
