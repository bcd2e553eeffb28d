//! The moments on the leg at one posture, and its change of rotation under them.

use super::dynamics::Dynamics;
use super::energy::Work;
use super::inertia::Guided;
use super::leg::LegState;
use nalgebra::{Matrix3, Vector3};

/// The mechanism at one posture and with one length of each tendon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Configuration {
    guided: Guided,
    /// Moment of a unit pull of each tendon, m.
    moment_map: Matrix3<f64>,
    /// Whether each tendon is stretched.
    taut: [bool; 3],
    /// Tension of each tendon without its damping, N.
    springs_n: [f64; 3],
    /// Moment of everything that does not depend on the rotation's rate, but the tendons, N·m.
    steady_nm: Vector3<f64>,
    tip_m: Vector3<f64>,
}

impl Dynamics {
    pub fn configuration(&self, leg: &LegState, unstretched_m: [f64; 3]) -> Configuration {
        let kinematics = self.kinematics(leg);
        let elongations = self.elongations_m(&kinematics, unstretched_m);
        let taut = elongations.map(|elongation| elongation > 0.0);
        let spring = |i: usize| {
            if taut[i] {
                self.tendons[i].tension_n(elongations[i])
            } else {
                0.0
            }
        };
        let tip_m = self.tip_m(leg);
        Configuration {
            guided: Guided::new(&self.inertia, &self.support, &leg.direction),
            moment_map: kinematics.moment_map,
            taut,
            springs_n: std::array::from_fn(spring),
            steady_nm: self.load.moment(&leg.direction)
                + tip_m.cross(&self.push_n)
                + self.support.joint_moment(&leg.direction, leg.torsion_rad),
            tip_m,
        }
    }

    /// Turns the leg faster or slower for `span_s` by the midpoint rule, with sliders that pull in at a speed (m/s).
    pub fn kick(
        &self,
        leg: &mut LegState,
        configuration: &Configuration,
        sliders_m_per_s: [f64; 3],
        span_s: f64,
        work: &mut Work,
    ) {
        let half = leg.rate
            + self.acceleration(configuration, &leg.rate, sliders_m_per_s) * (0.5 * span_s);
        leg.rate += self.acceleration(configuration, &half, sliders_m_per_s) * span_s;
        self.count_work(configuration, &half, sliders_m_per_s, span_s, work);
    }

    fn acceleration(
        &self,
        configuration: &Configuration,
        rate: &Vector3<f64>,
        sliders: [f64; 3],
    ) -> Vector3<f64> {
        let pulls = Vector3::from(self.pulls_n(configuration, rate, sliders));
        let damping = rate * self.joint_damping_nm_s_per_rad;
        let moment = configuration.steady_nm + configuration.moment_map * pulls - damping;
        configuration.guided.acceleration(rate, &moment)
    }

    /// Tension of each tendon with its damping, N, while the leg turns at `rate` rad/s.
    pub fn pulls_n(
        &self,
        configuration: &Configuration,
        rate: &Vector3<f64>,
        sliders_m_per_s: [f64; 3],
    ) -> [f64; 3] {
        std::array::from_fn(|i| {
            if !configuration.taut[i] {
                return 0.0;
            }
            let stretching = sliders_m_per_s[i] + configuration.lengthening_m_per_s(i, rate);
            (configuration.springs_n[i] + self.tendon_damping_n_s_per_m * stretching).max(0.0)
        })
    }

    fn count_work(
        &self,
        configuration: &Configuration,
        rate: &Vector3<f64>,
        sliders: [f64; 3],
        span_s: f64,
        work: &mut Work,
    ) {
        let pulls = self.pulls_n(configuration, rate, sliders);
        work.damping_j += self.joint_damping_nm_s_per_rad * rate.norm_squared() * span_s;
        work.push_j += rate.cross(&configuration.tip_m).dot(&self.push_n) * span_s;
        for i in 0..3 {
            let stretching = sliders[i] + configuration.lengthening_m_per_s(i, rate);
            work.damping_j += (pulls[i] - configuration.springs_n[i]) * stretching * span_s;
            work.sliders_j += pulls[i] * sliders[i] * span_s;
        }
    }
}

impl Configuration {
    /// How fast the leg lengthens the path of a tendon, m/s.
    fn lengthening_m_per_s(&self, tendon: usize, rate: &Vector3<f64>) -> f64 {
        -self.moment_map.column(tendon).dot(rate)
    }
}
