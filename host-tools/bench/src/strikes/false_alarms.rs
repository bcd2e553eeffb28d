//! What a user does to a leg without any fault: no fault may come.

use super::OTHER_TICKS;
use super::case::TARED_N;
use super::push::strongest_n;
use crate::draw::{CELL_GAIN, feasible, mixed, plant};
use crate::stand::Stand;
use fastrand::Rng;
use leg_base::angles;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Fault, State};
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Start;
use serde::Serialize;
use std::fmt::Write;

/// Heaviest payload, kg, and strongest push, N.
const PAYLOAD_KG: f64 = 1.0;
const PUSH_N: f64 = 10.0;

/// Pretensions that are asked for at most, N, and demands for stiffness, N·m/rad.
const PRETENSION_N: [f64; 2] = [25.0, 110.0];
const STIFFNESS_NM_PER_RAD: [f64; 2] = [10.0, 120.0];

/// How far before an alarm the true tensions are looked at, s.
const BEFORE_S: f64 = 0.25;

/// How long after an arm lengths and tensions are not yet watched, s: until every tendon pulls, and 0.1 s more. Until then a tension that is too
/// much is a pose on which the sensors disagree.
const ARMED_S: f64 = 0.2;

/// How long a user waits after a push before he freezes the load, s.
const REST_S: f64 = 0.5;

/// How near to the maximum a tension is that is held at it, N: a leg that gives way does so by cells that are noisy.
const HELD_N: f64 = 0.5;

/// The uses that are remembered for a report.
const REMEMBERED: usize = 8;

/// A fault that came although nothing had failed.
#[derive(Clone, Debug, Serialize)]
pub struct Alarm {
    /// The fault.
    pub fault: &'static str,
    /// Time in the run, s.
    pub time_s: f64,
    /// Whether a true tension had left its bounds, or a load cell may have shown that by what its calibration leaves, and the fault is one
    /// that this may raise: the alarm then is true.
    pub beyond: bool,
    /// Lowest and highest true tension in the quarter of a second before, N.
    pub tensions_n: [f64; 2],
    /// What was done last.
    pub uses: String,
}

/// What came of a time of use.
#[derive(Clone, Debug, Serialize)]
pub struct UseResult {
    /// The rig's name.
    pub rig: String,
    /// The part of the campaign.
    pub part: u64,
    /// s.
    pub time_s: f64,
    /// Things done.
    pub uses: u64,
    /// Faults.
    pub alarms: Vec<Alarm>,
    /// Legs that left their shadow in f64.
    pub left_shadow: u64,
    /// Why it ended early, if it did.
    pub stopped: Option<String>,
}

impl UseResult {
    /// How many legs may leave their shadow in so many uses: two, and one in each twenty thousand. Two did in 80 000: a limit and a fault that
    /// hang on rounding.
    #[must_use]
    pub const fn left_shadow_at_most(uses: u64) -> u64 {
        2 + uses / 20_000
    }
}

/// Uses a leg for a time, in the way of a part of the campaign. After an alarm another leg goes on.
pub(super) fn use_leg(
    seed: u64,
    rig: &str,
    file: &RigFile,
    part: u64,
    time_s: f64,
    done: &(impl Fn(u64) + Sync),
) -> UseResult {
    let mut usage = UseResult {
        rig: rig.into(),
        part,
        time_s: 0.0,
        uses: 0,
        alarms: Vec::new(),
        left_shadow: 0,
        stopped: None,
    };
    let mut rng = Rng::with_seed(mixed(seed, part));
    while usage.time_s < time_s && usage.stopped.is_none() {
        let before_s = usage.time_s;
        let ended = User::new(file, &mut rng).and_then(|user| user.go_on(&mut usage, time_s));
        usage.stopped = ended.err();
        done((usage.time_s - before_s) as u64);
    }
    usage
}

/// Whether a fault is one of a leg whose true tensions, from the lowest to the highest, N, have left their bounds, or may have by what a load
/// cell shows; so long after an arm, s.
fn is_beyond(file: &RigFile, fault: Fault, [lowest_n, highest_n]: [f64; 2], armed_s: f64) -> bool {
    // A leg knows no more than its cells show.
    let shown_n = highest_n * (1.0 + CELL_GAIN) + TARED_N;
    let over_n = file.f_max_n * (1.0 + f64::from(file.gains.limits.over_tension_part));
    let slackens = lowest_n < 0.5 * file.f_min_n;
    match fault {
        Fault::Slack => slackens,
        Fault::OverTension => shown_n > file.f_max_n,
        // A leg at rest for whose load there is no target gives way to the maximum tension: then its motor stays behind.
        Fault::Following => shown_n > file.f_max_n - HELD_N,
        // Just after an arm it says by this name that a tension is too much.
        Fault::Residual if armed_s < ARMED_S => shown_n > over_n,
        // A tendon that slackens, or gives way and is reeled in again, is damped otherwise than its stiffness says.
        Fault::Residual => slackens || shown_n > file.f_max_n,
        _ => false,
    }
}

/// A user with a leg.
struct User<'a> {
    file: &'a RigFile,
    rng: &'a mut Rng,
    stand: Stand,
    pose_deg: [f64; 2],
    payload_kg: f64,
    /// The extreme true tensions of now, and of the time before.
    extremes_n: [[f64; 2]; 2],
    extremes_s: f64,
    /// When the leg was armed last, and when its last push ends, s.
    armed_s: f64,
    pushed_s: f64,
    uses: Vec<String>,
}

const NO_RANGE: [f64; 2] = [f64::INFINITY, 0.0];

impl<'a> User<'a> {
    /// With a leg that has been armed.
    fn new(file: &'a RigFile, rng: &'a mut Rng) -> Result<Self, String> {
        let plant = plant(file, TARED_N, rng);
        let start = Start::hanging(file.pretension_n);
        let mut stand = Stand::unjudged(file, &plant, start, rng.u64(..))?;
        stand.tick_until(1.0, "disarmed", |stand| stand.state() == State::Disarmed)?;
        stand.command(&Command::Arm)?;
        stand.tick_until(2.0, "active", |stand| stand.state() == State::Active)?;
        let armed_s = stand.time_s();
        Ok(Self {
            file,
            rng,
            stand,
            pose_deg: [0.0; 2],
            payload_kg: 0.0,
            extremes_n: [NO_RANGE; 2],
            extremes_s: 0.0,
            armed_s,
            pushed_s: 0.0,
            uses: Vec::new(),
        })
    }

    /// Does one thing after another until the time is over or a fault comes.
    fn go_on(mut self, usage: &mut UseResult, end_s: f64) -> Result<(), String> {
        let began_s = usage.time_s;
        while usage.time_s < end_s {
            let wait_s = self.do_something()?;
            usage.uses += 1;
            let waited = self.wait(wait_s)?;
            usage.time_s = began_s + self.stand.time_s();
            if let Some(fault) = waited {
                usage.alarms.push(self.alarm(fault, usage.time_s));
                break;
            }
        }
        let left = self.stand.require_shadow(OTHER_TICKS).is_err();
        usage.left_shadow += u64::from(left);
        Ok(())
    }

    fn alarm(&self, fault: Fault, time_s: f64) -> Alarm {
        let [now, before] = self.extremes_n;
        let tensions_n = [now[0].min(before[0]), now[1].max(before[1])];
        let armed_s = self.stand.time_s() - self.armed_s;
        Alarm {
            fault: fault.entry().name,
            time_s,
            beyond: is_beyond(self.file, fault, tensions_n, armed_s),
            tensions_n,
            uses: self.uses.join("; "),
        }
    }

    /// Waits, and gives the fault that comes.
    fn wait(&mut self, time_s: f64) -> Result<Option<Fault>, String> {
        let end_s = self.stand.time_s() + time_s;
        while self.stand.time_s() < end_s {
            self.stand.tick()?;
            let now_s = self.stand.time_s();
            if now_s - self.extremes_s > BEFORE_S {
                self.extremes_n = [NO_RANGE, self.extremes_n[0]];
                self.extremes_s = now_s;
            }
            let tensions = self.stand.truth.tensions_n;
            let [low, high] = self.extremes_n[0];
            self.extremes_n[0] = [
                tensions.iter().copied().fold(low, f64::min),
                tensions.iter().copied().fold(high, f64::max),
            ];
            if let Some(fault) = self.stand.faults().faults().next() {
                return Ok(Some(fault));
            }
        }
        Ok(None)
    }

    /// Does something, and says how long to wait after it, s.
    fn do_something(&mut self) -> Result<f64, String> {
        let wait_s = 0.1 + 1.5 * self.rng.f64().powi(2);
        match self.rng.u32(0..20) {
            0..=6 => self.go_elsewhere()?,
            7 => self.command(&Command::Hold, "hold")?,
            8..=11 => self.push(),
            12..=14 => self.load(),
            15 | 16 => {
                let n = self.uniform(PRETENSION_N);
                self.command(
                    &Command::Pretension(n as f32),
                    &format!("pretension {n:.1} N"),
                )?;
            }
            17 => {
                let demand = self.uniform(STIFFNESS_NM_PER_RAD);
                let towards_deg = self.rng.bool().then(|| 360.0 * self.rng.f64());
                let command = Command::Stiffness {
                    demand_nm_per_rad: demand as f32,
                    towards: towards_deg.map(|deg| angles::unit_vector(deg).map(|c| c as f32)),
                };
                self.command(&command, &format!("stiffness {demand:.1} N·m/rad"))?;
            }
            18 => {
                let all = [
                    Compensation::Off,
                    Compensation::Estimated,
                    Compensation::Frozen,
                ];
                let compensation = all[self.rng.usize(0..3)];
                // What pushes would be frozen as a payload.
                let rest_s = (self.pushed_s + REST_S - self.stand.time_s()).max(0.0);
                if compensation == Compensation::Frozen && self.wait(rest_s)?.is_some() {
                    return Ok(wait_s);
                }
                let words = format!("compensation {compensation:?}");
                self.command(&Command::Compensation(compensation), &words)?;
            }
            _ => self.stop_and_go()?,
        }
        Ok(wait_s)
    }

    fn uniform(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.rng.f64()
    }

    fn command(&mut self, command: &Command, words: &str) -> Result<(), String> {
        self.note(words.into());
        self.stand.command(command)
    }

    fn note(&mut self, words: String) {
        let mut timed = format!("{:.2} s: ", self.stand.time_s());
        // Writing to a string cannot fail.
        let _ = write!(timed, "{words}");
        self.uses.push(timed);
        if self.uses.len() > REMEMBERED {
            self.uses.remove(0);
        }
    }

    /// To a pose that holds the payload.
    fn go_elsewhere(&mut self) -> Result<(), String> {
        let highest = self.file.tilt_deg.min(30.0) - 1e-3;
        let pose_deg = [360.0 * self.rng.f64(), highest * self.rng.f64()];
        if !self.holds(pose_deg, self.payload_kg) {
            return Ok(());
        }
        self.pose_deg = pose_deg;
        let [x, y] = angles::direction(pose_deg[0], pose_deg[1]).map(|c| c as f32);
        let words = format!("move to {:.1}°, {:.1}°", pose_deg[0], pose_deg[1]);
        self.command(&Command::Move { x, y }, &words)
    }

    fn holds(&self, pose_deg: [f64; 2], payload_kg: f64) -> bool {
        let [low, high] = feasible(self.file, pose_deg, payload_kg);
        low < high
    }

    /// A push that leaves every tension in its bounds, also when it ends and the leg swings back.
    fn push(&mut self) {
        let (azimuth_deg, asked_n) = (360.0 * self.rng.f64(), PUSH_N * self.rng.f64());
        let (for_s, rise_s) = (self.uniform([0.05, 1.0]), self.uniform([0.02, 0.2]));
        self.pushed_s = self.stand.time_s() + for_s;
        let across = self.stand.plant().transverse(azimuth_deg);
        let force_n = asked_n.min(strongest_n(self.file, &self.stand.truth, &across));
        self.note(format!(
            "push {force_n:.1} N at {azimuth_deg:.0}° for {for_s:.2} s, rising in {rise_s:.2} s"
        ));
        self.stand.plant().push(across * force_n, for_s, rise_s);
    }

    fn load(&mut self) {
        let (kg, over_s) = (PAYLOAD_KG * self.rng.f64(), self.uniform([0.05, 0.5]));
        if self.holds(self.pose_deg, kg) {
            self.payload_kg = kg;
            self.note(format!("payload {kg:.2} kg in {over_s:.2} s"));
            self.stand.plant().set_payload(kg, over_s);
        }
    }

    /// Stops the leg, clears and arms it again.
    fn stop_and_go(&mut self) -> Result<(), String> {
        self.command(&Command::Stop, "stop, clear, arm")?;
        for command in [Command::Clear, Command::Arm] {
            let wait_s = self.uniform([0.05, 0.5]);
            if self.wait(wait_s)?.is_some() {
                return Ok(());
            }
            self.stand.command(&command)?;
            self.armed_s = self.stand.time_s();
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{ARMED_S, is_beyond};
    use leg_firmware::supervisor::Fault;
    use leg_rig::rig_file::RigFile;

    /// Bounds of 8 and 150 N, and 165 N from which on a tension is too much.
    #[test]
    fn an_alarm_is_right_where_a_tension_has_left_its_bounds() {
        let file = RigFile::load(None).unwrap();
        for (fault, tensions_n, armed_s, right) in [
            (Fault::Slack, [3.9, 100.0], 9.0, true),
            (Fault::Slack, [4.1, 170.0], 9.0, false),
            (Fault::OverTension, [8.0, 149.7], 9.0, true),
            (Fault::OverTension, [8.0, 149.5], 9.0, false),
            (Fault::Following, [8.0, 149.2], 9.0, true),
            (Fault::Following, [8.0, 149.0], 9.0, false),
            (Fault::Residual, [8.0, 164.7], 0.9 * ARMED_S, true),
            (Fault::Residual, [8.0, 164.5], 0.9 * ARMED_S, false),
            (Fault::Residual, [0.0, 164.5], 0.9 * ARMED_S, false),
            (Fault::Residual, [3.9, 100.0], 1.1 * ARMED_S, true),
            (Fault::Residual, [4.1, 149.7], 1.1 * ARMED_S, true),
            (Fault::Residual, [4.1, 149.5], 1.1 * ARMED_S, false),
            (Fault::TensionJump, [0.0, 180.0], 0.0, false),
        ] {
            let found = is_beyond(&file, fault, tensions_n, armed_s);
            assert_eq!(found, right, "{fault:?} {tensions_n:?} {armed_s}");
        }
    }
}
