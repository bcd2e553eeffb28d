//! A force at the tip.

use super::Plant;
use leg_base::angles;
use nalgebra::Vector3;

/// A force at the tip for a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Push {
    force_n: Vector3<f64>,
    start_s: f64,
    end_s: f64,
    /// Time in which it rises, s.
    rise_s: f64,
}

impl Push {
    /// The force at a time, N.
    pub fn force_n(&self, now_s: f64) -> Vector3<f64> {
        if now_s >= self.end_s {
            return Vector3::zeros();
        }
        if self.rise_s == 0.0 {
            return self.force_n;
        }
        let part = ((now_s - self.start_s) / self.rise_s).min(1.0);
        // Without a step in its rate, which would let the leg swing.
        self.force_n * (part * part * (3.0 - 2.0 * part))
    }
}

impl Plant {
    /// Pushes at the tip for `for_s`, with a force in N in frame {A} that rises in `rise_s`. It ends an earlier push.
    pub fn push(&mut self, force_n: Vector3<f64>, for_s: f64, rise_s: f64) {
        let start_s = self.time_s();
        self.push = Push {
            force_n,
            start_s,
            end_s: start_s + for_s,
            rise_s,
        };
    }

    /// The unit vector across the leg that is nearest to the horizontal one at an azimuth.
    #[must_use]
    pub fn transverse(&self, azimuth_deg: f64) -> Vector3<f64> {
        let [x, y] = angles::unit_vector(azimuth_deg);
        let (horizontal, leg) = (Vector3::new(x, y, 0.0), self.tip_m().normalize());
        (horizontal - leg * leg.dot(&horizontal)).normalize()
    }
}
