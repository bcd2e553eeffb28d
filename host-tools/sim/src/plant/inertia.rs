//! The leg as a rigid body: how it responds to moments about the joint.

use leg_model::{Direction, FreePlane, Support, SupportKind, solve2};
use nalgebra::{Matrix3, Vector3};

/// Inertia of the leg and its payload about the joint: I = I_t(1 − ppᵀ) + I_a ppᵀ, p along the leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Inertia {
    /// Across the leg, kg·m².
    pub transverse_kg_m2: f64,
    /// About the leg's own axis, kg·m².
    pub axial_kg_m2: f64,
}

impl Inertia {
    /// With a payload as a point at the tip.
    pub fn loaded(&self, payload_kg: f64, tip_m: f64) -> Self {
        Self {
            transverse_kg_m2: self.transverse_kg_m2 + payload_kg * tip_m * tip_m,
            ..*self
        }
    }

    /// Angular momentum of a rotation of `rate` rad/s, N·m·s.
    fn momentum(&self, along: &Vector3<f64>, rate: &Vector3<f64>) -> Vector3<f64> {
        let spin = (self.axial_kg_m2 - self.transverse_kg_m2) * along.dot(rate);
        rate * self.transverse_kg_m2 + along * spin
    }

    /// Kinetic energy of a rotation of `rate` rad/s, J.
    pub fn kinetic_j(&self, direction: &Direction<f64>, rate: &Vector3<f64>) -> f64 {
        0.5 * rate.dot(&self.momentum(&direction.vector(), rate))
    }

    fn matrix(&self, along: &Vector3<f64>) -> Matrix3<f64> {
        let excess = self.axial_kg_m2 - self.transverse_kg_m2;
        Matrix3::from_diagonal_element(self.transverse_kg_m2) + along * along.transpose() * excess
    }
}

/// How a leg that its support guides changes its rotation at one direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guided {
    inertia: Inertia,
    along: Vector3<f64>,
    /// Two freedoms: the free rotations, and the inverse of the inertia along them.
    plane: Option<(FreePlane<f64>, SupportKind, [[f64; 2]; 2])>,
}

impl Guided {
    pub fn new(inertia: &Inertia, support: &Support<f64>, direction: &Direction<f64>) -> Self {
        let along = direction.vector();
        let plane = (!support.twists()).then(|| {
            let plane = support.plane(direction);
            (
                plane,
                support.kind(),
                inverse(&inertia.matrix(&along), &plane),
            )
        });
        Self {
            inertia: *inertia,
            along,
            plane,
        }
    }

    /// Change of the rotation by a moment (N·m) on a leg at rest, rad/s².
    pub fn response(&self, moment: &Vector3<f64>) -> Vector3<f64> {
        match &self.plane {
            Some((plane, _, [first, second])) => {
                let [x, y] = plane.project(moment);
                plane.rotation([first[0] * x + first[1] * y, second[0] * x + second[1] * y])
            }
            None => {
                let (along, spin) = (&self.along, self.along.dot(moment));
                (moment - along * spin) / self.inertia.transverse_kg_m2
                    + along * (spin / self.inertia.axial_kg_m2)
            }
        }
    }

    /// Change of a rotation of `rate` rad/s under a moment (N·m), rad/s², at a fixed direction.
    ///
    /// After d'Alembert: the support's own moments do no work along the free rotations, P, so that with ω = Pv
    /// PᵀIP v̇ = Pᵀ(M − ω × Iω − IṖv). The result is Pv̇.
    pub fn acceleration(&self, rate: &Vector3<f64>, moment: &Vector3<f64>) -> Vector3<f64> {
        let momentum = self.inertia.momentum(&self.along, rate);
        let turning = match &self.plane {
            Some((_, kind, _)) => {
                let tilting = Vector3::z() * self.plane_turning(*kind, rate);
                self.inertia.momentum(&self.along, &tilting)
            }
            None => Vector3::zeros(),
        };
        self.response(&(moment - rate.cross(&momentum) - turning))
    }

    /// Ṗv: how the free plane turns under the rotation, rad/s² about z.
    fn plane_turning(&self, kind: SupportKind, rate: &Vector3<f64>) -> f64 {
        let p = self.along;
        let moved = rate.cross(&p);
        if matches!(kind, SupportKind::Universal | SupportKind::ElasticUniversal) {
            return rate.y * (p.y * moved.z / p.z - moved.y) / p.z;
        }
        let gain = 1.0 - p.z;
        let along = rate.x * moved.x + rate.y * moved.y;
        (along + (rate.x * p.x + rate.y * p.y) * moved.z / gain) / gain
    }

    /// The rotation rate, rad/s, without its part that tilts the leg farther; `None` if it has none.
    pub fn stopped(&self, rate: &Vector3<f64>) -> Option<Vector3<f64>> {
        let outwards = Vector3::new(self.along.y, -self.along.x, 0.0);
        let tilting = outwards.dot(rate);
        let impact = self.response(&outwards);
        (tilting > 0.0).then(|| rate - impact * (tilting / outwards.dot(&impact)))
    }
}

/// (PᵀIP)⁻¹; zero for a body without inertia, which [`Plant::new`](super::Plant::new) refuses.
fn inverse(inertia: &Matrix3<f64>, plane: &FreePlane<f64>) -> [[f64; 2]; 2] {
    let column = |c: [f64; 2]| plane.project(&(inertia * plane.rotation(c)));
    let ([xx, yx], [xy, yy]) = (column([1.0, 0.0]), column([0.0, 1.0]));
    let along = |c| solve2([[xx, xy], [yx, yy]], c).unwrap_or_default();
    let ([a, b], [c, d]) = (along([1.0, 0.0]), along([0.0, 1.0]));
    [[a, c], [b, d]]
}
