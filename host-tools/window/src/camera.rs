//! From places of the leg in frame {A} to places on the screen.

use egui::{Pos2, Rect, pos2};
use nalgebra::Vector3;

/// How far one may look from above and from below, degrees.
const PITCH_DEG: [f64; 2] = [-80.0, 80.0];

/// Degrees for a point of dragging.
const DEG_PER_POINT: f64 = 0.4;

/// Where the leg is looked at from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The azimuth that points to the right, degrees.
    pub yaw_deg: f64,
    /// How far from above, degrees.
    pub pitch_deg: f64,
    /// How much larger than fitted.
    pub zoom: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            yaw_deg: 12.0,
            pitch_deg: 14.0,
            zoom: 1.0,
        }
    }
}

impl Camera {
    /// Turns with a drag of so many points.
    pub fn turn(&mut self, right: f32, down: f32) {
        self.yaw_deg = (self.yaw_deg - f64::from(right) * DEG_PER_POINT).rem_euclid(360.0);
        let pitch_deg = self.pitch_deg + f64::from(down) * DEG_PER_POINT;
        self.pitch_deg = pitch_deg.clamp(PITCH_DEG[0], PITCH_DEG[1]);
    }

    /// The view that has `centre` in the middle of a part of the screen, and shows `height_m` of the leg there.
    #[must_use]
    pub fn view(&self, rect: Rect, centre: Vector3<f64>, height_m: f64) -> View {
        let (yaw_sin, yaw_cos) = self.yaw_deg.to_radians().sin_cos();
        let (pitch_sin, pitch_cos) = self.pitch_deg.to_radians().sin_cos();
        let shown_m = height_m / self.zoom;
        View {
            right: Vector3::new(yaw_cos, yaw_sin, 0.0),
            forward: Vector3::new(-yaw_sin * pitch_cos, yaw_cos * pitch_cos, -pitch_sin),
            up: Vector3::new(-yaw_sin * pitch_sin, yaw_cos * pitch_sin, pitch_cos),
            centre,
            // Far enough that near parts do not look swollen.
            distance_m: 4.0 * shown_m,
            points_per_m: f64::from(rect.height()) / shown_m,
            middle: rect.center(),
        }
    }
}

/// A camera before a part of the screen.
#[derive(Clone, Copy, Debug)]
pub struct View {
    right: Vector3<f64>,
    forward: Vector3<f64>,
    up: Vector3<f64>,
    centre: Vector3<f64>,
    distance_m: f64,
    points_per_m: f64,
    middle: Pos2,
}

/// A place on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Projected {
    /// Where.
    pub at: Pos2,
    /// How far away, m; more is behind.
    pub depth_m: f64,
    /// Size of a metre there, points.
    pub points_per_m: f64,
}

impl View {
    /// Where a place is seen.
    #[must_use]
    pub fn project(&self, place: Vector3<f64>) -> Projected {
        let from_centre = place - self.centre;
        let depth_m = (self.distance_m + from_centre.dot(&self.forward)).max(0.1 * self.distance_m);
        let points_per_m = self.points_per_m * self.distance_m / depth_m;
        let (right, up) = (from_centre.dot(&self.right), from_centre.dot(&self.up));
        Projected {
            at: pos2(
                self.middle.x + (right * points_per_m) as f32,
                self.middle.y - (up * points_per_m) as f32,
            ),
            depth_m,
            points_per_m,
        }
    }

    /// Whether a surface with this normal is seen from its front.
    #[must_use]
    pub fn faces(&self, at: Vector3<f64>, normal: Vector3<f64>) -> bool {
        let eye = self.centre - self.forward * self.distance_m;
        (eye - at).dot(&normal) > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::Camera;
    use egui::{Rect, pos2};
    use nalgebra::Vector3;

    fn level() -> Camera {
        Camera {
            yaw_deg: 0.0,
            pitch_deg: 0.0,
            zoom: 1.0,
        }
    }

    fn screen() -> Rect {
        Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 200.0))
    }

    #[test]
    fn x_is_right_z_is_up_and_y_is_away() {
        let view = level().view(screen(), Vector3::zeros(), 0.2);
        let at = |x, y, z| view.project(Vector3::new(x, y, z));
        let middle = at(0.0, 0.0, 0.0);
        assert_eq!(middle.at, pos2(200.0, 100.0));
        assert!((middle.points_per_m - 1000.0).abs() < 1e-9);
        let right = at(0.05, 0.0, 0.0).at;
        assert!((right.x - 250.0).abs() < 1e-3 && (right.y - 100.0).abs() < 1e-3);
        let up = at(0.0, 0.0, 0.05).at;
        assert!((up.x - 200.0).abs() < 1e-3 && (up.y - 50.0).abs() < 1e-3);
        let away = at(0.05, 0.1, 0.0);
        assert!(away.depth_m > middle.depth_m && away.at.x < right.x);
    }

    #[test]
    fn from_above_what_is_away_is_higher() {
        let camera = Camera {
            pitch_deg: 30.0,
            ..level()
        };
        let view = camera.view(screen(), Vector3::zeros(), 0.2);
        assert!(view.project(Vector3::new(0.0, 0.05, 0.0)).at.y < 100.0);
        assert!(view.faces(Vector3::zeros(), Vector3::z()));
        assert!(!view.faces(Vector3::zeros(), -Vector3::z()));
    }

    #[test]
    fn it_turns_and_does_not_tip_over() {
        let mut camera = level();
        camera.turn(-100.0, 1e4);
        assert!((camera.yaw_deg - 40.0).abs() < 1e-9);
        assert!((camera.pitch_deg - 80.0).abs() < 1e-9);
    }
}
