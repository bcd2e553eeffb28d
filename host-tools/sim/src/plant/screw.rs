//! Gear play and screw: how the rotor moves the slider, and what the tendon's pull asks of the rotor.

use leg_rig::actuator::Actuator;

/// Where the slider is, and how the gear touches its screw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Screw {
    /// How far the tendon is pulled in since the start, m.
    pub slider_m: f64,
    /// How far the rotor is behind the place where it pulls in, as travel of the slider, m: zero when it touches to
    /// reel in, minus the play when it touches to pay out.
    behind_m: f64,
    /// The play as travel of the slider, m.
    play_m: f64,
    /// Travel of the slider in one radian of the rotor, m.
    m_per_rad: f64,
    /// Torque at the rotor in one newton of pull, N·m/N: while it reels in, and while it pays out.
    torque_nm_per_n: [f64; 2],
}

impl Screw {
    /// At the start of its travel, touching as if it had reeled in last.
    pub fn new(actuator: &Actuator) -> Self {
        Self {
            slider_m: 0.0,
            behind_m: 0.0,
            play_m: play_m(actuator, actuator.backlash_rad),
            m_per_rad: actuator.m_per_rad(),
            torque_nm_per_n: torques_nm_per_n(actuator),
        }
    }

    /// Has another play from now on, as a rotation of the screw, rad.
    pub fn set_play(&mut self, actuator: &Actuator, play_rad: f64) {
        self.play_m = play_m(actuator, play_rad);
    }

    /// Follows the rotor, which turns by `turned_rad`. The pull never moves the screw: its friction is the greater.
    pub fn follow(&mut self, turned_rad: f64) {
        self.behind_m += turned_rad * self.m_per_rad;
        if self.behind_m > 0.0 {
            self.slider_m += self.behind_m;
            self.behind_m = 0.0;
        } else if self.behind_m < -self.play_m {
            self.slider_m += self.behind_m + self.play_m;
            self.behind_m = -self.play_m;
        }
    }

    /// Whether a rotor that turns at `speed` rad/s moves the screw.
    fn touches(&self, speed: f64) -> bool {
        (speed > 0.0 && self.behind_m >= 0.0) || (speed < 0.0 && self.behind_m <= -self.play_m)
    }

    /// Speed of the slider, m/s.
    pub fn slider_m_per_s(&self, speed: f64) -> f64 {
        if self.touches(speed) {
            speed * self.m_per_rad
        } else {
            0.0
        }
    }

    /// What a pull resists a rotor that turns at `speed` rad/s, or is about to, N·m.
    pub fn resistance_nm(&self, speed: f64, pull_n: f64) -> f64 {
        let [inwards, outwards] = self.torque_nm_per_n;
        match (self.touches(speed), speed > 0.0) {
            (false, _) => 0.0,
            (true, true) => inwards * pull_n,
            (true, false) => outwards * pull_n,
        }
    }
}

/// A play as travel of the slider, m.
fn play_m(actuator: &Actuator, play_rad: f64) -> f64 {
    play_rad * actuator.lead_m / std::f64::consts::TAU
}

/// Torque at the rotor in one newton of pull, N·m/N, reeling in and paying out.
///
/// A screw of lead angle λ and friction angle ρ is raised by the torque F r tan(λ + ρ) and lowered by F r tan(ρ − λ).
/// Without friction it would take F r tan λ, which is F times the travel in a radian, so its efficiency is η ≈ λ/(λ + ρ)
/// (both angles are small). Hence ρ ≈ λ(1/η − 1): raising takes 1/η of the frictionless torque, and lowering
/// 1/η − 2 of it, positive for η < ½. So a pull always resists, and never drives, a rotor that moves its screw. The gear
/// needs its own part on top both ways, because both ways it is the rotor that drives.
fn torques_nm_per_n(actuator: &Actuator) -> [f64; 2] {
    let frictionless = actuator.m_per_rad() / actuator.gear_efficiency;
    let inwards = 1.0 / actuator.screw_efficiency;
    [inwards, (inwards - 2.0).max(0.0)].map(|part| part * frictionless)
}
