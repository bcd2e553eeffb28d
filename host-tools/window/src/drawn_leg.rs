//! A leg with its target, its tensions and what acts on it, before a camera.

use crate::camera::View;
use crate::figure::{Item, ball, circle, cord, disc, rod, sorted};
use crate::leg_pose::{LegPose, enlarged};
use crate::map::Map;
use crate::map_key;
use crate::map_mesh::{self, mesh};
use crate::places::place_rect;
use crate::seen_leg::{SeenLeg, leg_axis};
use crate::stiffness_ellipse::StiffnessEllipse;
use crate::theme::{self, Palette, mixed};
use egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2,
    pos2, vec2,
};
use leg_model::RigParameters;
use nalgebra::Vector3;

/// Sizes that the rig does not say, m.
const PLATE_M: f64 = 0.003;
const PLATE_RADIUS: f64 = 1.22;
const SHAFT_RADIUS_M: f64 = 0.0026;
const JOINT_RADIUS_M: f64 = 0.0036;
/// Radius of a ball of 1 kg.
const PAYLOAD_RADIUS_M: f64 = 0.0135;

/// Height of the labels below the detail, points.
const LABELS: f32 = 36.0;

/// From these widths of its cell on there is room for the number of a tendon, and for a decimal, points.
const CELL_NUMBERED: f32 = 58.0;
const CELL_ROOMY: f32 = 72.0;

/// A tip that is nearer than that is where it shall be, mm.
const NEAR_MM: f64 = 0.5;

/// A bar of colours below the leg, points, and where the next one stands: beside it, or above where there is no room.
const LEGEND: Vec2 = vec2(110.0, 7.0);
const LEGEND_BESIDE: Vec2 = vec2(178.0, 0.0);
const LEGEND_ABOVE: Vec2 = vec2(0.0, -32.0);
const LEGEND_ROOM: f32 = 420.0;

/// Below this width of the picture there is no room for some words beside the leg, points.
const NARROW: f32 = 640.0;

/// How far above the lower edge the words about the stiffness stand, points.
const WORDS_ABOVE: f32 = 72.0;

/// How opaque a map is: what is behind it is seen.
const MAP_OPACITY: f32 = 0.6;

/// From an arrow to its words, points.
const LABEL_GAP: f32 = 4.0;

/// What a force of 1 N is drawn as, m.
const ARROW_M_PER_N: f64 = 0.015;

/// What is drawn of the leg.
pub struct Drawn<'a> {
    leg: &'a SeenLeg<'a>,
    pub rig: &'a RigParameters<f64, 3>,
    pub palette: Palette,
    pose: LegPose,
    /// Where the trajectory has the leg.
    reference: Vector3<f64>,
    commanded_m: Vector3<f64>,
    pub tip_length_m: f64,
    factor: f64,
    /// What lies on the workspace.
    map: Option<&'a Map>,
}

impl<'a> Drawn<'a> {
    pub fn new(leg: &'a SeenLeg<'a>, factor: f64, palette: Palette, map: Option<&'a Map>) -> Self {
        let tip_length_m = leg.tip_length_m();
        let reference = leg.reference;
        let (enlarged_axis, factor) = enlarged(reference, leg.leg_axis, factor, tip_length_m);
        Self {
            leg,
            rig: &leg.rig.parameters,
            palette,
            pose: LegPose::new(enlarged_axis).twisted(leg.torsion_rad),
            reference,
            commanded_m: leg.commanded_m(),
            tip_length_m,
            factor,
            map,
        }
    }

    fn tip(&self) -> Vector3<f64> {
        self.pose.leg_axis * self.tip_length_m
    }

    /// The size of joint and plates, m.
    pub fn joint_m(&self) -> f64 {
        let rig = self.rig;
        let rings_m = [&rig.base_anchors_m, &rig.leg_anchors_m].map(ring_m);
        rings_m.into_iter().fold(rig.joint_length_m, f64::max)
    }

    pub fn whole(&self, painter: &Painter, view: &View) {
        self.workspace(painter, view);
        let mut items = self.mechanism(view, 2.6);
        let plate = self.pose.leg_axis * self.rig.joint_length_m;
        items.push(rod(
            view,
            [plate, self.tip()],
            SHAFT_RADIUS_M,
            self.palette.shaft,
        ));
        items.extend(self.payload(view));
        painter.extend(sorted(items));
        self.marks(painter, view);
        self.push(painter, view);
    }

    pub fn detail(&self, painter: &Painter, view: &View, rect: Rect) {
        let edge = Stroke::new(1.0, self.palette.line);
        painter.rect(
            rect,
            8.0,
            mixed(self.palette.back, self.palette.card, 0.6),
            edge,
            StrokeKind::Inside,
        );
        let inside = painter.with_clip_rect(rect.shrink(1.0));
        let mut items = self.mechanism(view, 4.5);
        let plate = self.pose.leg_axis * self.rig.joint_length_m;
        items.push(rod(
            view,
            [plate, 2.4 * plate],
            SHAFT_RADIUS_M,
            self.palette.shaft,
        ));
        inside.extend(sorted(items));
        let strip = rect.shrink(1.0).with_min_y(rect.bottom() - LABELS);
        let corners = CornerRadius {
            sw: 8,
            se: 8,
            ..CornerRadius::ZERO
        };
        inside.rect_filled(strip, corners, self.palette.card);
        self.tension_labels(&inside, view, rect);
        place_rect(painter.ctx(), strip, "tensions");
    }

    /// Plates, joint and tendons.
    fn mechanism(&self, view: &View, width: f32) -> Vec<Item> {
        let (rig, palette) = (self.rig, &self.palette);
        let ring_m = ring_m(&rig.base_anchors_m);
        let base = Vector3::new(0.0, 0.0, rig.upper_length_m);
        let plate = self.pose.leg_axis * rig.joint_length_m;
        let origin = Vector3::zeros();
        let mut items = vec![
            disc(
                view,
                base,
                Vector3::z(),
                [PLATE_RADIUS * ring_m, PLATE_M],
                palette.plate,
            ),
            disc(
                view,
                plate,
                self.pose.leg_axis,
                [PLATE_RADIUS * self::ring_m(&rig.leg_anchors_m), PLATE_M],
                palette.plate,
            ),
            rod(view, [base, origin], SHAFT_RADIUS_M, palette.plate),
            rod(view, [origin, plate], SHAFT_RADIUS_M, palette.shaft),
            ball(view, origin, JOINT_RADIUS_M, palette.brass),
        ];
        items.extend(self.tendons(view, width));
        items
    }

    fn tendons(&self, view: &View, width: f32) -> Vec<Item> {
        let anchors = self.pose.anchors(self.rig);
        let mut items = Vec::new();
        for (tendon, ends) in anchors.into_iter().enumerate() {
            let colour = self.tension_colour(tendon);
            if self.cut(tendon) {
                // What is left hangs from the base plate.
                let end = ends[0] + Vector3::new(0.0, 0.0, -0.35 * self.rig.joint_length_m);
                items.push(cord(view, [ends[0], end], 0.5 * width, colour));
            } else {
                items.push(cord(view, ends, width, colour));
            }
            for end in ends {
                items.push(ball(view, end, 0.0011, colour));
            }
        }
        items
    }

    fn cut(&self, tendon: usize) -> bool {
        self.leg.cut.get(tendon) == Some(&true)
    }

    fn tension_colour(&self, tendon: usize) -> Color32 {
        let rig = self.leg.rig;
        let tension_n = self.leg.tensions_n[tendon];
        theme::tension(tension_n, [rig.f_min_n, rig.f_max_n])
    }

    fn payload(&self, view: &View) -> Option<Item> {
        let payload_kg = self.leg.hung_kg?;
        let radius_m = PAYLOAD_RADIUS_M * payload_kg.cbrt();
        (payload_kg > 1e-3).then(|| ball(view, self.tip(), radius_m, self.palette.brass))
    }

    /// The vertical, and the circle that the tip can reach.
    fn workspace(&self, painter: &Painter, view: &View) {
        let faint = Stroke::new(1.0, mixed(self.palette.back, self.palette.faint, 0.55));
        let below = Vector3::new(0.0, 0.0, -self.tip_length_m);
        let vertical = [Vector3::zeros(), below].map(|place| view.project(place).at);
        painter.extend(Shape::dashed_line(&vertical, faint, 5.0, 5.0));
        if let Some(map) = self.map {
            let place = |at: [f64; 2]| view.project(self.tip_length_m * leg_axis(at)).at;
            painter.add(Shape::mesh(mesh(map, &self.palette, MAP_OPACITY, place)));
        }
        let (sin, cos) = self.leg.rig.tilt_deg.to_radians().sin_cos();
        let mut rim: Vec<Pos2> = circle(below * cos, Vector3::z(), self.tip_length_m * sin)
            .map(|place| view.project(place).at)
            .collect();
        rim.extend(rim.first().copied());
        place_rect(painter.ctx(), Rect::from_points(&rim), "rim");
        painter.add(Shape::line(rim, faint));
    }

    /// Where the leg was sent, and how far it is from there.
    fn marks(&self, painter: &Painter, view: &View) {
        let palette = &self.palette;
        let target = view.project(self.commanded_m).at;
        let ghost = [Vector3::zeros(), self.reference * self.tip_length_m]
            .map(|place| view.project(place).at);
        let line = Stroke::new(1.4, palette.target);
        painter.extend(Shape::dashed_line(&ghost, line, 6.0, 5.0));
        painter.circle_stroke(target, 8.0, Stroke::new(2.0, palette.target));
        for arm in [vec2(12.0, 0.0), vec2(0.0, 12.0)] {
            painter.line_segment([target - arm, target + arm], line);
        }
        let tip = view.project(self.tip()).at;
        if (tip - target).length() > 3.0 {
            painter.line_segment([target, tip], Stroke::new(2.5, palette.error));
            painter.circle_filled(tip, 3.5, palette.error);
        }
    }

    fn push(&self, painter: &Painter, view: &View) {
        let Some(push) = self.leg.push else {
            return;
        };
        let [x, y] = leg_base::angles::unit_vector(push.azimuth_deg);
        let force_m = Vector3::new(x, y, 0.0) * (push.force_n * ARROW_M_PER_N);
        let [from, to] = [self.tip() - force_m, self.tip()].map(|place| view.project(place).at);
        painter.arrow(from, to - from, Stroke::new(4.0, self.palette.warning));
        let words = format!("push {:.0} N", push.force_n);
        label(painter, from, from - to, &words, &self.palette);
    }

    fn tension_labels(&self, painter: &Painter, view: &View, rect: Rect) {
        let tensions_n = self.leg.tensions_n;
        let anchors = self.pose.anchors(self.rig);
        for (tendon, ends) in anchors.into_iter().enumerate() {
            let above = ends[0] + Vector3::new(0.0, 0.0, 0.008);
            let at = view.project(above).at;
            let number = (tendon + 1).to_string();
            painter.text(
                at,
                Align2::CENTER_CENTER,
                number,
                FontId::proportional(14.0),
                self.palette.text,
            );
            let width = rect.width() / 3.0;
            let cell = pos2(
                rect.left() + (tendon as f32 + 0.5) * width,
                rect.bottom() - 11.0,
            );
            let words = if self.cut(tendon) {
                format!("{} cut", tendon + 1)
            } else if width < CELL_NUMBERED {
                format!("{:3.0} N", tensions_n[tendon])
            } else if width < CELL_ROOMY {
                format!("{}:{:3.0} N", tendon + 1, tensions_n[tendon])
            } else {
                format!("{}: {:.1} N", tendon + 1, tensions_n[tendon])
            };
            painter.circle_filled(cell - vec2(0.0, 14.0), 4.0, self.tension_colour(tendon));
            painter.text(
                cell,
                Align2::CENTER_CENTER,
                words,
                FontId::monospace(11.5),
                self.palette.text,
            );
        }
    }

    /// How far the tip is from where it was sent, in a place of its own.
    pub fn readout(&self, painter: &Painter, rect: Rect) {
        let error_mm = self.leg.error_mm;
        let corner = rect.left_top() + vec2(14.0, 10.0);
        let big = FontId::monospace(24.0);
        let words = format!("{error_mm:.2} mm");
        let colour = if !self.leg.is_heard {
            self.palette.faint
        } else if error_mm < NEAR_MM {
            self.palette.good
        } else {
            self.palette.error
        };
        painter.text(corner, Align2::LEFT_TOP, words, big, colour);
        let from = if rect.width() < NARROW {
            ""
        } else {
            " from its reference"
        };
        let drawn = format!("drawn ×{:.1}{from}", self.factor);
        let off = match (self.leg.is_heard, self.leg.is_true) {
            (false, _) => "from the target, as last heard",
            (true, true) => "from the target",
            (true, false) if self.leg.doubt().is_some() => "by sensors that are in doubt",
            (true, false) => "from the target, by its sensors",
        };
        for (line, words) in [off, &drawn].into_iter().enumerate() {
            let below = corner + vec2(0.0, 28.0 + 16.0 * line as f32);
            let font = FontId::proportional(12.5);
            painter.text(below, Align2::LEFT_TOP, words, font, self.palette.faint);
        }
        let shown = Rect::from_min_size(corner, vec2(200.0, 60.0));
        place_rect(painter.ctx(), shown, "readout");
    }

    /// How stiff the tip is to each side, and the scale of that.
    pub fn stiffness(&self, painter: &Painter, view: &View, rect: Rect) {
        let colour = self.palette.good;
        let doubt = self.leg.doubt();
        let ellipse = StiffnessEllipse::new(self.leg).filter(|_| doubt.is_none());
        let words = match (&ellipse, doubt) {
            (Some(ellipse), _) => {
                self.ellipse(painter, view, ellipse, colour);
                ellipse.words()
            }
            (None, Some(_)) => {
                ["stiffness: not known, sensors or", "tendons are in doubt"].map(Into::into)
            }
            (None, None) => ["the model has no stiffness here", ""].map(Into::into),
        };
        let font = FontId::monospace(11.5);
        let mut corner = rect.left_bottom() + vec2(14.0, -WORDS_ABOVE);
        if self.map.is_some() && rect.width() <= LEGEND_ROOM {
            corner += LEGEND_ABOVE;
        }
        let shown = Rect::from_min_size(corner, vec2(230.0, 30.0));
        // What is drawn of the leg and its workspace does not cross the words.
        let patch = shown.expand2(vec2(4.0, 1.0));
        painter.rect_filled(patch, 4.0, self.palette.back.gamma_multiply(0.85));
        for (line, words) in words.into_iter().enumerate() {
            let at = corner + vec2(0.0, 15.0 * line as f32);
            painter.text(at, Align2::LEFT_TOP, words, font.clone(), colour);
        }
        place_rect(painter.ctx(), shown, "stiffness_words");
    }

    fn ellipse(&self, painter: &Painter, view: &View, ellipse: &StiffnessEllipse, colour: Color32) {
        let at = |place| view.project(place).at;
        let edge: Vec<Pos2> = ellipse.edge(self.tip()).map(at).collect();
        let line = Stroke::new(1.6, colour);
        place_rect(painter.ctx(), Rect::from_points(&edge), "ellipse");
        painter.add(Shape::convex_polygon(
            edge,
            colour.gamma_multiply(0.15),
            line,
        ));
        for axis in ellipse.half_axes_m() {
            let ends = [self.tip() - axis, self.tip() + axis].map(at);
            painter.line_segment(ends, Stroke::new(1.0, colour));
        }
    }

    /// What the colours of the tendons mean, and those of a map.
    pub fn legend(&self, painter: &Painter, rect: Rect) {
        let rig = self.leg.rig;
        let bounds_n = [rig.f_min_n, rig.f_max_n];
        let source = self.leg.tensions_source();
        let words = format!(
            "{source} tension, {:.0} to {:.0} N",
            bounds_n[0], bounds_n[1]
        );
        let at = rect.left_bottom() + vec2(14.0, -18.0);
        self.one_legend(painter, at, &words, |part| {
            let tension_n = bounds_n[0] + f64::from(part) * (bounds_n[1] - bounds_n[0]);
            theme::tension(tension_n, bounds_n)
        });
        let Some(words) = self.map.and_then(map_key::words) else {
            return;
        };
        let next = if rect.width() > LEGEND_ROOM {
            LEGEND_BESIDE
        } else {
            LEGEND_ABOVE
        };
        let legend = Rect::from_min_size(at + next - vec2(0.0, 18.0), LEGEND + vec2(60.0, 18.0));
        place_rect(painter.ctx(), legend, "map_legend");
        self.one_legend(painter, at + next, &words, |part| {
            map_mesh::colour(&self.palette, part.into())
        });
    }

    fn one_legend(
        &self,
        painter: &Painter,
        at: Pos2,
        words: &str,
        colour: impl Fn(f32) -> Color32,
    ) {
        let bar = Rect::from_min_size(at, LEGEND);
        map_key::bar(painter, bar, false, colour);
        let above = bar.left_top() + vec2(0.0, -3.0);
        let font = FontId::proportional(12.5);
        painter.text(above, Align2::LEFT_BOTTOM, words, font, self.palette.faint);
    }
}

fn ring_m(anchors_m: &[[f64; 2]; 3]) -> f64 {
    let radii = anchors_m.iter().map(|[x, y]| (x * x + y * y).sqrt());
    radii.fold(0.0, f64::max)
}

/// Text beside the beginning of an arrow, on the side that it does not go to.
fn label(painter: &Painter, from: Pos2, away: Vec2, words: &str, palette: &Palette) {
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::monospace(13.0), palette.warning);
    let half = 0.5 * galley.size() + vec2(5.0, 2.0);
    let patch = beside(from, away, half);
    painter.rect_filled(patch, 4.0, palette.card.gamma_multiply(0.85));
    let at = patch.center() - 0.5 * galley.size();
    painter.galley(at, galley, palette.warning);
}

/// A rectangle of this half size that a line ends before: the line comes from the other side than `away`.
fn beside(end: Pos2, away: Vec2, half: Vec2) -> Rect {
    // A line along the view is a point.
    let away = if away.length() < 1.0 {
        vec2(0.0, -1.0)
    } else {
        away.normalized()
    };
    let reach = half / away.abs().max(Vec2::splat(1e-6));
    let centre = end + away * (reach.min_elem() + LABEL_GAP);
    Rect::from_center_size(centre, 2.0 * half)
}

#[cfg(test)]
mod tests {
    use super::beside;
    use egui::{Vec2, pos2, vec2};

    #[test]
    fn words_beside_an_arrow_do_not_cover_it() {
        let (from, half) = (pos2(100.0, 50.0), vec2(40.0, 10.0));
        for degrees in 0..72 {
            let away = 30.0 * Vec2::angled((5.0 * degrees as f32).to_radians());
            let words = beside(from, away, half);
            for part in 0..=20 {
                let on_arrow = from - away * (part as f32 / 20.0);
                assert!(!words.contains(on_arrow), "{away:?} {words:?}");
            }
            assert!(words.distance_to_pos(from) < 12.0, "{away:?} {words:?}");
        }
        assert!(!beside(from, Vec2::ZERO, half).contains(from));
    }
}
