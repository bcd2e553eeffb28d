//! A leg with its target, its tensions and what acts on it, before a camera.

mod words;

use crate::camera::View;
use crate::figure::{Item, ball, circle, cord, disc, rod, sorted};
use crate::leg_pose::{LegPose, enlarged};
use crate::map::Map;
use crate::map_mesh::mesh;
use crate::places::place_rect;
use crate::seen_leg::{SeenLeg, leg_axis};
use crate::stiffness_ellipse::StiffnessEllipse;
use crate::theme::{self, Palette, mixed};
use egui::{Color32, CornerRadius, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, vec2};
use leg_model::RigParameters;
use nalgebra::Vector3;
use words::label_arrow;

/// Sizes that the rig does not say, m.
const PLATE_M: f64 = 0.003;
const PLATE_RADIUS: f64 = 1.22;
const SHAFT_RADIUS_M: f64 = 0.0026;
const JOINT_RADIUS_M: f64 = 0.0036;
/// Radius of a ball of 1 kg.
const PAYLOAD_RADIUS_M: f64 = 0.0135;

/// Height of the labels below the detail, points.
const LABELS: f32 = 36.0;

/// How opaque a map is: what is behind it is seen.
const MAP_OPACITY: f32 = 0.6;

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
        // The edge sets it off from the payload, which has nearly its colour.
        for (width, colour) in [(8.0, self.palette.back), (4.0, self.palette.warning)] {
            painter.arrow(from, to - from, Stroke::new(width, colour));
        }
        let words = format!("push {:.0} N", push.force_n);
        label_arrow(painter, from, from - to, &words, &self.palette);
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
}

fn ring_m(anchors_m: &[[f64; 2]; 3]) -> f64 {
    let radii = anchors_m.iter().map(|[x, y]| (x * x + y * y).sqrt());
    radii.fold(0.0, f64::max)
}
