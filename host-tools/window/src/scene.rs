//! The leg in 3D: as a whole, and its joint enlarged.

use crate::camera::Camera;
use crate::drawn_leg::Drawn;
use crate::map::Map;
use crate::places::place;
use crate::seen_leg::SeenLeg;
use crate::theme::palette;
use egui::{ComboBox, Rect, Response, Sense, Ui, Vec2, pos2, vec2};
use nalgebra::Vector3;

/// How much of the leg the detail shows, beside the size of what is in it.
const DETAIL_HEIGHT: f64 = 3.03;

/// From this width on the detail stands beside the whole, points.
const WIDE: f32 = 520.0;

/// How much the detail takes of a wide picture.
const DETAIL_PART: f32 = 0.38;

/// How high the detail is in a wide picture, as a part of that, how wide beside that, and how high at least, points.
const DETAIL_SIDE: f32 = 0.38;
const DETAIL_WIDTH: f32 = 1.25;
const DETAIL_MIN: f32 = 150.0;

/// Width of what stands below the detail, points, and how much of the picture that takes at most.
const ROOM_WIDTH: f32 = 278.0;
const ROOM_PART: f32 = 0.4;

/// The least height of that, points.
const ROOM_HEIGHT: f32 = 150.0;

/// Where the choice of the factor stands, below the readout, points.
pub const CHOICE_TOP: f32 = 72.0;

/// Heights of the readout's first lines and of the legend, points. The leg stands above the legend, and a narrow one below
/// the readout.
const READOUT_HEIGHT: f32 = 60.0;
const LEGEND_HEIGHT: f32 = 30.0;

/// By how much a deviation may be enlarged.
const FACTORS: [f64; 4] = [1.0, 3.0, 5.0, 10.0];

/// What the user chose to see.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    camera: Camera,
    /// How much the deviation is enlarged.
    factor: f64,
    /// Whether the stiffness of the tip is drawn.
    stiffness: bool,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            factor: FACTORS[1],
            stiffness: false,
        }
    }
}

impl Scene {
    /// Draws the leg, a map on its workspace if one is chosen, and lets a drag turn it.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        leg: &SeenLeg<'_>,
        map: Option<&Map>,
        size: Vec2,
    ) -> Response {
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        let drag = response.drag_delta();
        self.camera.turn(drag.x, drag.y);
        if response.hovered() {
            let scroll = ui.input(|input| input.smooth_scroll_delta().y);
            let zoom = self.camera.zoom * f64::from(scroll * 0.002).exp();
            self.camera.zoom = zoom.clamp(0.5, 4.0);
        }
        if response.double_clicked() {
            self.camera = Camera::default();
        }
        let drawn = Drawn::new(leg, self.factor, palette(ui.ctx()), map);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, drawn.palette.back);
        let (whole, detail) = parts(rect);
        let length_m = drawn.tip_length_m;
        let centre = Vector3::new(0.0, 0.0, -0.48 * length_m);
        let view = self.camera.view(whole, centre, 1.17 * length_m);
        drawn.whole(&painter, &view);
        let middle = Vector3::new(0.0, 0.0, -0.5 * drawn.rig.joint_length_m);
        let joint = Camera {
            zoom: 1.0,
            ..self.camera
        };
        drawn.detail(
            &painter,
            &joint.view(detail, middle, DETAIL_HEIGHT * drawn.joint_m()),
            detail,
        );
        if self.stiffness {
            drawn.stiffness(&painter, &view, rect);
        }
        drawn.readout(&painter, rect);
        drawn.legend(&painter, rect);
        response
    }

    /// Lets the user choose how much the deviation is enlarged, and whether the stiffness is drawn.
    pub fn choice(&mut self, ui: &mut Ui) {
        let text = format!("draw ×{:.0}", self.factor);
        let choice = ComboBox::from_id_salt("factor")
            .selected_text(text)
            .width(92.0);
        let choice = choice.show_ui(ui, |ui| {
            for factor in FACTORS {
                ui.selectable_value(&mut self.factor, factor, format!("draw ×{factor:.0}"));
            }
        });
        place(&choice.response, "factor");
        choice.response.on_hover_text(
            "The leg is drawn so many times as far from its reference as it is, up to 60 mm. The reference is where its \
             trajectory has it: the dashed line.",
        );
        let stiffness = ui.checkbox(&mut self.stiffness, "Stiffness");
        place(&stiffness, "stiffness_ellipse");
        stiffness.on_hover_text(
            "How stiff the tip is against pushes to each side, as an ellipse across the leg: what the model says of the \
             present pretension and payload.",
        );
    }
}

/// The part of the whole leg, and that of its joint.
fn parts(rect: Rect) -> (Rect, Rect) {
    let inner = rect.shrink(8.0);
    let above_legend = rect.with_max_y(rect.bottom() - LEGEND_HEIGHT);
    if wide(rect) {
        let at = rect.right() - DETAIL_PART * rect.width();
        let whole = above_legend
            .with_max_x(at)
            .translate(vec2(0.03 * rect.width(), 0.0));
        let high = (DETAIL_SIDE * inner.height()).max(DETAIL_MIN);
        let high = high.min(inner.height());
        let width = (DETAIL_WIDTH * high).min(inner.right() - at);
        let corner = pos2(inner.right() - width, inner.top());
        return (whole, Rect::from_min_size(corner, vec2(width, high)));
    }
    let side = 0.42 * rect.width();
    let corner = pos2(inner.right() - side, inner.top());
    let whole = above_legend.with_min_y(rect.top() + READOUT_HEIGHT);
    let whole = whole.translate(vec2(-0.08 * rect.width(), 0.0));
    (whole, Rect::from_min_size(corner, vec2(side, 0.95 * side)))
}

/// Whether the detail stands beside the whole.
fn wide(rect: Rect) -> bool {
    rect.width() > WIDE && rect.width() > 1.15 * rect.height()
}

/// Whether there is room for more beside the leg, so that it covers nothing.
#[must_use]
pub fn has_room(rect: Rect) -> bool {
    wide(rect) && room(rect).height() >= ROOM_HEIGHT
}

/// Where there is room for more beside the leg: below the detail.
#[must_use]
pub fn room(rect: Rect) -> Rect {
    let (_, detail) = parts(rect);
    let inner = rect.shrink(8.0);
    let width = ROOM_WIDTH.min(ROOM_PART * rect.width());
    let left = detail.left().min(inner.right() - width);
    Rect::from_min_max(pos2(left, detail.bottom() + 8.0), inner.max)
}
