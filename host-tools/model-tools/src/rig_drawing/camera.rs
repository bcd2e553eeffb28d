//! Parallel projection of the mechanism onto the paper.

use nalgebra::Vector3;

/// From where a view is seen. Parallel lines stay parallel, and lengths across the view are to scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    /// Turn of the mechanism about z before it is seen from −y.
    pub turn_deg: f64,
    /// How far above the horizon it is seen from.
    pub elevation_deg: f64,
    pub px_per_mm: f64,
    /// Where the joint centre is on the paper, px.
    pub joint_px: [f64; 2],
}

impl Camera {
    /// Where a point of frame {A}, m, is on the paper, px.
    pub fn project(&self, point: &Vector3<f64>) -> [f64; 2] {
        let (sin, cos) = self.turn_deg.to_radians().sin_cos();
        let right = cos * point.x - sin * point.y;
        let away = sin * point.x + cos * point.y;
        let (sin, cos) = self.elevation_deg.to_radians().sin_cos();
        let up = cos * point.z + sin * away;
        let scale = 1000.0 * self.px_per_mm;
        [
            self.joint_px[0] + scale * right,
            self.joint_px[1] - scale * up,
        ]
    }
}
