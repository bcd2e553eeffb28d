//! What is written beside a drawn leg.

use super::Drawn;
use crate::camera::View;
use crate::map_key;
use crate::map_mesh;
use crate::places::place_rect;
use crate::stiffness_ellipse::StiffnessEllipse;
use crate::theme::{self, Palette};
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Vec2, pos2, vec2};
use nalgebra::Vector3;

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

/// From an arrow to its words, points.
const LABEL_GAP: f32 = 4.0;

impl Drawn<'_> {
    pub(super) fn tension_labels(&self, painter: &Painter, view: &View, rect: Rect) {
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

/// Text beside the beginning of an arrow, on the side that it does not go to.
pub(super) fn label_arrow(
    painter: &Painter,
    from: Pos2,
    away: Vec2,
    words: &str,
    palette: &Palette,
) {
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::monospace(13.0), palette.warning);
    let half = 0.5 * galley.size() + vec2(5.0, 2.0);
    let patch = label_patch(from, away, half);
    painter.rect_filled(patch, 4.0, palette.card.gamma_multiply(0.85));
    let at = patch.center() - 0.5 * galley.size();
    painter.galley(at, galley, palette.warning);
}

/// A rectangle of this half size that a line ends before: the line comes from the other side than `away`.
fn label_patch(end: Pos2, away: Vec2, half: Vec2) -> Rect {
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
    use super::label_patch;
    use egui::{Vec2, pos2, vec2};

    #[test]
    fn words_beside_an_arrow_do_not_cover_it() {
        let (from, half) = (pos2(100.0, 50.0), vec2(40.0, 10.0));
        for degrees in 0..72 {
            let away = 30.0 * Vec2::angled((5.0 * degrees as f32).to_radians());
            let words = label_patch(from, away, half);
            for part in 0..=20 {
                let on_arrow = from - away * (part as f32 / 20.0);
                assert!(!words.contains(on_arrow), "{away:?} {words:?}");
            }
            assert!(words.distance_to_pos(from) < 12.0, "{away:?} {words:?}");
        }
        assert!(!label_patch(from, Vec2::ZERO, half).contains(from));
    }
}
