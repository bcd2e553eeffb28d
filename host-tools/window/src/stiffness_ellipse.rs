//! How stiff the tip is against pushes to each side: an ellipse across the leg, from the model at the present pretension.

use crate::seen_leg::SeenLeg;
use leg_base::angles;
use leg_model::evaluate;
use nalgebra::{Matrix2, Matrix3, SymmetricEigen, Vector3};
use std::f64::consts::TAU;

/// How large the ellipse is drawn at most, m: scales are round.
const DRAWN_MAX_M: f64 = 0.05;

/// Lengths that stand for 1 N/mm, mm.
const SCALES_MM: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];

/// N/m in 1 N/mm.
const N_PER_M: f64 = 1000.0;

/// Points of its edge.
const CORNERS: u32 = 48;

/// It.
#[derive(Clone, Copy, Debug)]
pub struct StiffnessEllipse {
    /// The directions in which the tip is least and most stiff: unit vectors across the leg.
    pub axes: [Vector3<f64>; 2],
    /// How stiff it is there, N/m.
    pub n_per_m: [f64; 2],
}

impl StiffnessEllipse {
    /// Of a leg; none where the model has no answer, or the leg would buckle.
    #[must_use]
    pub fn new(leg: &SeenLeg<'_>) -> Option<Self> {
        let telemetry = leg.telemetry.as_ref()?;
        let [azimuth_deg, tilt_deg] = angles::angles_deg([leg.leg_axis.x, leg.leg_axis.y]);
        let estimated_kg = f64::from(telemetry.payload_kg).max(0.0);
        let payload_kg = leg.hung_kg.unwrap_or(estimated_kg);
        let mut query = leg.rig.query(azimuth_deg, tilt_deg, payload_kg);
        query.pretension_n = telemetry.pretension_n.into();
        let pose = evaluate(&leg.rig.parameters, &query).ok()?;
        let bending = pose.bending_stiffness_nm_per_rad;
        if bending.iter().any(|part| *part <= 0.0) {
            return None;
        }
        let length_m = leg.tip_length_m();
        Some(Self {
            axes: axes(
                leg.leg_axis,
                Matrix3::from_fn(|i, j| pose.stiffness_nm_per_rad[i][j]),
            ),
            n_per_m: bending.map(|part| part / (length_m * length_m)),
        })
    }

    /// The length that stands for 1 N/mm, mm: the largest round one at which it stays small enough.
    #[must_use]
    pub fn scale_mm(&self) -> f64 {
        let fits = |mm: &&f64| self.n_per_m[1] / N_PER_M * **mm / 1000.0 <= DRAWN_MAX_M;
        let fitting = SCALES_MM.iter().rev().find(fits);
        fitting.copied().unwrap_or(SCALES_MM[0])
    }

    /// Its half axes, m.
    #[must_use]
    pub fn half_axes_m(&self) -> [Vector3<f64>; 2] {
        let scale = self.scale_mm() / 1000.0 / N_PER_M;
        let [a, b] = self.axes;
        [a * (scale * self.n_per_m[0]), b * (scale * self.n_per_m[1])]
    }

    /// Its edge around a place, m.
    pub fn edge(&self, centre: Vector3<f64>) -> impl Iterator<Item = Vector3<f64>> {
        let [a, b] = self.half_axes_m();
        (0..CORNERS).map(move |corner| {
            let (sin, cos) = (TAU * f64::from(corner) / f64::from(CORNERS)).sin_cos();
            centre + a * cos + b * sin
        })
    }

    /// What it says, and its scale, each in words of one length.
    #[must_use]
    pub fn words(&self) -> [String; 2] {
        let [least, most] = self.n_per_m.map(|part| part / N_PER_M);
        [
            format!("tip stiffness {least:5.2} to {most:5.2} N/mm"),
            format!("ellipse: {:4.0} mm for 1 N/mm", self.scale_mm()),
        ]
    }
}

/// Where the tip goes that is tilted about the axes of the least and of the most stiffness.
fn axes(leg_axis: Vector3<f64>, stiffness: Matrix3<f64>) -> [Vector3<f64>; 2] {
    let away = if leg_axis.x.abs() < 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let u = leg_axis.cross(&away).normalize();
    let v = leg_axis.cross(&u);
    let part = |a: Vector3<f64>, b: Vector3<f64>| a.dot(&(stiffness * b));
    let across = 0.5 * (part(u, v) + part(v, u));
    let plane = Matrix2::new(part(u, u), across, across, part(v, v));
    let eigen = SymmetricEigen::new(plane);
    let least = usize::from(eigen.eigenvalues[1] < eigen.eigenvalues[0]);
    [least, 1 - least].map(|i| {
        let axis = u * eigen.eigenvectors[(0, i)] + v * eigen.eigenvectors[(1, i)];
        axis.cross(&leg_axis)
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{StiffnessEllipse, axes};
    use crate::shown_leg::ShownLeg;
    use crate::simulation::Simulation;
    use leg_base::angles;
    use nalgebra::{Matrix3, Vector3};

    fn ellipse(leg: &ShownLeg) -> StiffnessEllipse {
        StiffnessEllipse::new(&leg.seen()).unwrap()
    }

    #[test]
    fn its_axes_lie_across_the_leg() {
        let leg = ShownLeg::Simulated(Box::new(Simulation::new().unwrap()));
        let ellipse = ellipse(&leg);
        let leg_axis = leg.leg_axis();
        let [a, b] = ellipse.axes;
        for (one, other) in [(a, leg_axis), (b, leg_axis), (a, b)] {
            assert!(one.dot(&other).abs() < 1e-9);
        }
        assert!(ellipse.n_per_m[0] > 100.0 && ellipse.n_per_m[0] <= ellipse.n_per_m[1]);
        let largest_m = ellipse.half_axes_m()[1].norm();
        assert!(largest_m <= 0.05 && largest_m > 0.015, "{largest_m}");
        assert_eq!(ellipse.edge(Vector3::zeros()).count(), 48);
    }

    #[test]
    fn a_tip_is_stiff_where_a_tilt_is() {
        // Stiff against a tilt about x: a hanging tip is stiff along y.
        let stiffness = Matrix3::from_diagonal(&Vector3::new(9.0, 4.0, 1.0));
        let [least, most] = axes(-Vector3::z(), stiffness);
        assert!(
            least.x.abs() > 0.999 && most.y.abs() > 0.999,
            "{least} {most}"
        );
    }

    /// The simulated leg, which knows nothing of the ellipse, yields to a push as the ellipse says.
    #[test]
    fn a_push_moves_the_tip_as_the_ellipse_says() {
        let yields = |azimuth_deg: f64| {
            let mut simulation = Simulation::new().unwrap();
            let before = simulation.leg().truth().direction.vector();
            simulation.push(azimuth_deg, 1.0, 10.0);
            simulation.advance(0.2);
            simulation.advance(0.2);
            let after = simulation.leg().truth().direction.vector();
            let leg = ShownLeg::Simulated(Box::new(simulation));
            let moved = Vector3::new(after.x - before.x, after.y - before.y, after.z - before.z);
            (leg.tip_length_m() * moved, ellipse(&leg), leg.leg_axis())
        };
        for azimuth_deg in [30.0, 120.0] {
            let (moved_m, ellipse, leg_axis) = yields(azimuth_deg);
            let [x, y] = angles::unit_vector(azimuth_deg);
            let push = Vector3::new(x, y, 0.0);
            let across = push - leg_axis * leg_axis.dot(&push);
            let expected_m: Vector3<f64> = ellipse
                .axes
                .iter()
                .zip(ellipse.n_per_m)
                .map(|(axis, n_per_m)| axis * (axis.dot(&across) / n_per_m))
                .sum();
            let turned = moved_m.angle(&expected_m).to_degrees();
            let softer = moved_m.norm() / expected_m.norm();
            println!("{azimuth_deg}°: {turned:.2}° beside it, {softer:.3} as far");
            assert!(turned < 3.0, "{moved_m} {expected_m}");
            // The ellipse is that of the smallest pushes, of a leg whose motors do not yield.
            assert!((0.85..1.15).contains(&softer), "{softer}");
        }
    }
}
