//! One strike, and the leg that was struck while it is watched.

use super::activity::Activity;
use super::bars::{StrikeBars, shown_as};
use super::case::Case;
use super::naming::WANDERS_BY_N;
use super::preparation::PreparedLeg;
use super::struck::{Strike, Struck};
use super::way::Way;
use crate::stand::Stand;
use leg_base::description;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_sim::plant::Defect;
use serde::Serialize;

/// How long a struck leg is watched, s: one whose fault comes slowly for longer, and one that homes to its end.
const WATCHED_S: f64 = 2.0;
const SLOW_S: f64 = 12.0;
const HOMING_S: f64 = 16.0;

/// How long a leg that has stopped is watched, s.
const STOPPED_S: f64 = 1.5;

/// When a motor may no longer be driven after the leg has stopped, s; and what counts as driven: speed, rad/s (0.04 mm/s
/// of the tendon), or current, A.
const RUN_OUT_S: f64 = 0.1;
const DRIVEN_RAD_PER_S: f64 = 1.0;
const DRIVEN_A: f64 = 0.3;

/// When the user clears the fault, and how long after that he arms, s after the strike.
const CLEARS_S: [f64; 2] = [0.6, 1.4];
const ARMS_AFTER_S: f64 = 0.1;

/// A tension by the maximum from which a leg has to ramp down.
const OVER_PART: f64 = 1.1;

/// Ticks between two measures of the distance from a way.
const WAY_TICKS: u64 = 8;

/// The leg at a time after a strike.
#[derive(Clone, Debug, Serialize)]
pub struct Moment {
    /// Time since the strike, s.
    pub time_s: f64,
    /// What the leg reports.
    pub state: &'static str,
    /// Faults that it reports.
    pub faults: String,
    /// True tensions, N.
    pub tensions_n: [f64; 3],
    /// What the cells show, N.
    pub measured_n: [f32; 3],
    /// Duties.
    pub duty: [f32; 3],
    /// How far the tip is from rest or off the way, mm.
    pub tip_mm: f64,
}

/// Strikes a clone of a leg. With a time between them, moments come, too.
pub(super) fn strike(
    case: &Case,
    prepared: &PreparedLeg,
    strike: &Strike,
    every_s: Option<f64>,
) -> (Struck, Vec<Moment>) {
    let mut stand = prepared.stand.clone();
    let shown = strike.defect.map(|defect| shown_as(defect, &case.file));
    let f_max_n = case.file.f_max_n;
    let mut bars = StrikeBars::new(shown, case.activity, f_max_n, &prepared.unstruck);
    if case.activity == Activity::Moving && case.compensation == Compensation::Off {
        bars = bars.leave_load_out(f_max_n);
    }
    if let Some(defect) = strike.defect {
        stand.plant().set_defect(defect, true);
    }
    let mut watch = Watch::new(case, &prepared.way, &stand, strike, bars.sags, every_s);
    let watched_s = watched_s(case, strike.defect);
    while !watch.ends(&stand, watched_s) {
        if let Err(error) = watch.advance(&mut stand) {
            watch.struck.failures.push(error);
            break;
        }
    }
    watch.struck.compare_shadow(&stand);
    let bars = watch.struck.bars_by_cut_off(prepared, shown, bars, f_max_n);
    watch.struck.judge(&bars, strike.defect.is_some());
    (watch.struck, watch.moments)
}

fn watched_s(case: &Case, defect: Option<Defect>) -> f64 {
    let usual_s = if case.activity == Activity::Homing {
        HOMING_S
    } else {
        WATCHED_S
    };
    match defect {
        Some(
            Defect::CellDrifting(_)
            | Defect::CellGainDrift(_)
            | Defect::CellGainDriftDown(_)
            | Defect::CellWanders(_)
            | Defect::EncoderJumps(_)
            | Defect::TendonCreeps(_)
            | Defect::Overheating,
        ) => usual_s.max(SLOW_S),
        _ => usual_s,
    }
}

/// A leg that was struck, while it is watched.
struct Watch<'a> {
    case: &'a Case,
    way: &'a Way,
    began_s: f64,
    /// The tendon whose cell wanders, and for how long that has been off so far that it has to be named, s.
    wanders: Option<usize>,
    off_s: f64,
    /// Faults that were there before.
    before: FaultSet,
    /// Since when the leg has stopped after a fault.
    stopped_s: Option<f64>,
    /// Commands that the user has given since.
    given: usize,
    /// Whether homing has come to its end: the tendons are tensioned then.
    homed: bool,
    /// Whether it may sag once a true tension has it ramp down, and whether it does.
    may_sag: bool,
    sags: bool,
    every_s: Option<f64>,
    moments: Vec<Moment>,
    struck: Struck,
}

impl<'a> Watch<'a> {
    /// From now on. A leg that may sag does so once a true tension has it ramp down; with a time between them, moments are recorded.
    fn new(
        case: &'a Case,
        way: &'a Way,
        stand: &Stand,
        strike: &Strike,
        may_sag: bool,
        every_s: Option<f64>,
    ) -> Self {
        Self {
            case,
            way,
            began_s: stand.time_s(),
            wanders: match strike.defect {
                Some(Defect::CellWanders(i)) => Some(i),
                _ => None,
            },
            off_s: 0.0,
            before: stand.faults(),
            stopped_s: None,
            given: 0,
            homed: stand.state() == State::Active,
            may_sag,
            sags: false,
            every_s,
            moments: Vec::new(),
            struck: Struck::new(case, strike),
        }
    }

    /// Whether nothing more is to come.
    fn ends(&self, stand: &Stand, watched_s: f64) -> bool {
        let now_s = stand.time_s() - self.began_s;
        let rearms = self.case.activity == Activity::Rearmed && self.given < 2 * CLEARS_S.len();
        let settled = self
            .stopped_s
            .is_some_and(|stopped_s| now_s - stopped_s > STOPPED_S);
        !rearms && (settled || now_s >= watched_s)
    }

    /// One tick.
    fn advance(&mut self, stand: &mut Stand) -> Result<(), String> {
        self.rearm(stand)?;
        stand.tick()?;
        let now_s = stand.time_s() - self.began_s;
        let highest = stand.truth.tensions_n.into_iter().fold(0.0, f64::max);
        self.struck.tension_n = self.struck.tension_n.max(highest);
        self.homed |= stand.state() == State::Active;
        if self.case.activity == Activity::Homing && !self.homed {
            self.struck.homing_n = self.struck.homing_n.max(highest);
        }
        let tick = (now_s * f64::from(TICK_HZ)).round() as u64;
        self.sags |= self.may_sag && stand.state() == State::RampingDown && self.exceeds_tension();
        if !self.sags && (!self.case.activity.is_on_the_way() || tick.is_multiple_of(WAY_TICKS)) {
            let tip_mm = self.way.distance_mm(&stand.truth.tip_m);
            self.struck.tip_mm = self.struck.tip_mm.max(tip_mm);
        }
        self.name_fault(stand, now_s);
        self.watch_motors(stand, now_s);
        self.record(stand, now_s);
        Ok(())
    }

    /// Whether a true tension has been beyond what **too much tension** asks for by itself.
    fn exceeds_tension(&self) -> bool {
        self.struck.tension_n > OVER_PART * self.case.file.f_max_n
    }

    /// Clears the fault and arms without a repair, as a user may.
    fn rearm(&mut self, stand: &mut Stand) -> Result<(), String> {
        let (round, clears) = (self.given / 2, self.given.is_multiple_of(2));
        if self.case.activity != Activity::Rearmed || round >= CLEARS_S.len() {
            return Ok(());
        }
        let due_s = CLEARS_S[round] + if clears { 0.0 } else { ARMS_AFTER_S };
        if stand.time_s() - self.began_s >= due_s {
            stand.command(if clears {
                &Command::Clear
            } else {
                &Command::Arm
            })?;
            self.given += 1;
        }
        Ok(())
    }

    fn name_fault(&mut self, stand: &Stand, now_s: f64) {
        if self.struck.named.is_some() {
            return;
        }
        if let (Some(i), Some(telemetry)) = (self.wanders, &stand.telemetry) {
            let off_n = f64::from(telemetry.tensions_n[i]) - stand.truth.tensions_n[i];
            if off_n.abs() >= WANDERS_BY_N {
                self.off_s += 1.0 / f64::from(TICK_HZ);
            }
        }
        let found: Option<Fault> = stand
            .faults()
            .faults()
            .find(|fault| !self.before.has(*fault));
        self.struck.named = found.map(|fault| fault.entry().name);
        let after_s = self.wanders.map_or(now_s, |_| self.off_s);
        self.struck.named_s = found.map(|_| after_s);
    }

    fn watch_motors(&mut self, stand: &Stand, now_s: f64) {
        let stops = matches!(stand.state(), State::Held | State::Off | State::Disarmed);
        if self.struck.named.is_none() || !stops || stand.moving() {
            self.stopped_s = None;
            return;
        }
        let stopped_s = *self.stopped_s.get_or_insert(now_s);
        let truth = &stand.truth;
        let turns = truth
            .speeds_rad_per_s
            .iter()
            .any(|speed| speed.abs() > DRIVEN_RAD_PER_S);
        let draws = truth
            .currents_a
            .iter()
            .any(|current| current.abs() > DRIVEN_A);
        let since_s = now_s - stopped_s;
        if since_s > RUN_OUT_S && stand.motors.enabled && (turns || draws) {
            self.struck.driven_s = self.struck.driven_s.max(since_s);
        }
    }

    fn record(&mut self, stand: &Stand, now_s: f64) {
        let Some(every_s) = self.every_s else { return };
        if now_s < self.moments.len() as f64 * every_s {
            return;
        }
        if let Some(telemetry) = &stand.telemetry {
            self.moments.push(Moment {
                time_s: now_s,
                state: description::state(telemetry.state),
                faults: description::faults(telemetry.faults),
                tensions_n: stand.truth.tensions_n,
                measured_n: telemetry.tensions_n,
                duty: stand.motors.duty,
                tip_mm: self.way.distance_mm(&stand.truth.tip_m),
            });
        }
    }
}
