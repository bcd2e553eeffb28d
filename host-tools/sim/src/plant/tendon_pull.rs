//! How a real tendon pulls: by its curve, and beyond the curve's end in a straight line.

use leg_model::{Elasticity, Error, Quantity, Reason, Tendon};

/// Tension up to which a tendon of constant stiffness is evaluated, N.
const CONSTANT_END_N: f64 = 1e6;

/// A tendon with a tension for every elongation: a simulated one must not fail where its tensile test ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct RealTendon {
    tendon: Tendon<f64>,
    /// Real elongation in one of the curve's.
    scale: f64,
    /// Elongation at the curve's end by the curve, m.
    end_m: f64,
    /// Tension there, N.
    end_n: f64,
    /// Tangent stiffness there by the curve, N/m.
    end_n_per_m: f64,
    /// Energy there by the curve, J.
    end_j: f64,
}

impl RealTendon {
    /// # Errors
    /// A tendon that does not stretch, by an error of −1 or less; what the curve refuses at its own end.
    pub fn new(tendon: &Tendon<f64>, curve_error: f64) -> Result<Self, Error> {
        let scale = 1.0 + curve_error;
        if !(scale.is_finite() && scale > 0.0) {
            return Err(Error::Refused {
                quantity: Quantity::Elongation,
                reason: Reason::NotPositive,
            });
        }
        let end_n = match tendon {
            Tendon::Constant(_) => CONSTANT_END_N,
            Tendon::Curve(curve) => curve.tension_max_n(),
        };
        let end_m = tendon.elongation(end_n)?;
        Ok(Self {
            tendon: *tendon,
            scale,
            end_m,
            end_n,
            end_n_per_m: tendon.stiffness(end_n)?,
            end_j: tendon.energy(end_m)?,
        })
    }

    /// Tension at an elongation in m without its damping, N; none when slack.
    pub fn tension_n(&self, elongation_m: f64) -> f64 {
        let by_curve = elongation_m / self.scale;
        let farther = by_curve - self.end_m;
        let curve = self.tendon.tension(by_curve).ok().filter(|_| farther < 0.0);
        curve.unwrap_or(self.end_n + farther * self.end_n_per_m)
    }

    /// Elastic energy at an elongation in m, J.
    pub fn energy_j(&self, elongation_m: f64) -> f64 {
        let by_curve = elongation_m / self.scale;
        let farther = by_curve - self.end_m;
        let curve = self.tendon.energy(by_curve).ok().filter(|_| farther < 0.0);
        let beyond = self.end_j + farther * (self.end_n + 0.5 * farther * self.end_n_per_m);
        curve.unwrap_or(beyond) * self.scale
    }

    /// Elongation under a tension in N, m.
    ///
    /// # Errors
    /// A tension beyond the curve.
    pub fn elongation_m(&self, tension_n: f64) -> Result<f64, Error> {
        Ok(self.tendon.elongation(tension_n)? * self.scale)
    }
}
