//! Where the leg is and how it turns.

use super::inertia::{Guided, Inertia};
use leg_model::{Direction, Geometry, Support, Twist};
use nalgebra::Vector3;

/// Cosine and sine of the tilt at which the leg meets a stop, 75°: beyond what the model serves (60°), before the
/// horizon, where a universal joint would lock.
const STOP: [f64; 2] = [0.258_819_045_102_520_76, 0.965_925_826_289_068_3];

/// The leg's posture and rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LegState {
    pub direction: Direction<f64>,
    /// Torsion beyond that which the joint itself gives the leg, rad.
    pub torsion_rad: f64,
    /// Rotation in frame {A}, rad/s.
    pub rate: Vector3<f64>,
}

impl LegState {
    pub fn resting(direction: Direction<f64>, torsion_rad: f64) -> Self {
        Self {
            direction,
            torsion_rad,
            rate: Vector3::zeros(),
        }
    }

    /// The mechanism, twisted as the leg is.
    pub fn geometry(
        &self,
        straight: &Geometry<f64, 3>,
        support: &Support<f64>,
    ) -> Geometry<f64, 3> {
        let twist = support.twist(&self.direction);
        if !support.twists() {
            return straight.twisted(&twist);
        }
        straight.twisted(&twist.composed(&Twist::from_torsion(self.torsion_rad)))
    }

    /// Turns on for `span_s` by the midpoint rule. Returns the kinetic energy that an impact at the stop takes, J.
    pub fn drift(&mut self, support: &Support<f64>, inertia: &Inertia, span_s: f64) -> f64 {
        let start = self.direction.vector();
        let half =
            start + self.guided_rate(support, &self.direction).cross(&start) * (0.5 * span_s);
        let (halfway, _) = limited_by_stop(&half);
        let rate = self.guided_rate(support, &halfway);
        if support.twists() {
            self.torsion_rad += support.torsion_change(&halfway).dot(&rate) * span_s;
        }
        let (end, stopped) = limited_by_stop(&(start + rate.cross(&halfway.vector()) * span_s));
        self.direction = end;
        self.rate = self.guided_rate(support, &end);
        if !stopped {
            return 0.0;
        }
        let before_j = inertia.kinetic_j(&end, &self.rate);
        let guided = Guided::new(inertia, support, &end);
        self.rate = guided.stopped(&self.rate).unwrap_or(self.rate);
        before_j - inertia.kinetic_j(&end, &self.rate)
    }

    /// The rotation with the same components about x and y as the support allows it at a direction, rad/s.
    fn guided_rate(&self, support: &Support<f64>, direction: &Direction<f64>) -> Vector3<f64> {
        if support.twists() {
            return self.rate;
        }
        support
            .plane(direction)
            .rotation([self.rate.x, self.rate.y])
    }
}

/// The direction of a vector of about unit length, and whether the stop holds it there.
fn limited_by_stop(along: &Vector3<f64>) -> (Direction<f64>, bool) {
    let [cosine, sine] = STOP;
    match Direction::from_xy(along.x, along.y) {
        Ok(direction) if direction.vector().z <= -cosine => (direction, false),
        _ => {
            let scale = sine / libm::hypot(along.x, along.y);
            let held = Direction::from_xy(along.x * scale, along.y * scale);
            (held.unwrap_or(Direction::straight_down()), true)
        }
    }
}
