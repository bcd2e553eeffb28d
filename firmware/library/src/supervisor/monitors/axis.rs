//! What raises the faults of one axis.

use super::{Timer, View};
use crate::control::{CYCLE_TICKS, ticks};
use crate::sensors::CODE_MAX;
use crate::settings::Settings;
use crate::supervisor::{Fault, FaultSet};
use leg_model::Scalar;

/// What an axis shows beside its sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisView<T> {
    /// How far the motor is from where it is led, m.
    pub following_m: T,
    /// The voltage at the motor beyond what its speed induces, V.
    pub driving_v: T,
    /// The voltage at the motor, V.
    pub voltage_v: T,
}

/// Looks over which a tension must not jump, a power of two: a millisecond.
const JUMP_LOOKS: usize = 2;

/// Looks after which a current is a fault: 2 ms.
const CURRENT_LOOKS: u32 = 4;

/// Codes this near to an end of the range are taken as saturated.
const SATURATED: u16 = 64;

/// Looks in a time in s, at least one: each axis has its turn once a cycle.
fn looks(time_s: f32) -> u32 {
    ticks(time_s).div_ceil(u32::from(CYCLE_TICKS))
}

/// Watches one axis.
#[derive(Clone, Copy, Debug)]
pub struct AxisMonitor<T> {
    slack: Timer,
    stale: Timer,
    stuck: Timer,
    still: Timer,
    reversed: Timer,
    over_current: Timer,
    disagrees: Timer,
    last_code: u16,
    last_count: u16,
    history: [T; JUMP_LOOKS],
    place: usize,
    filled: bool,
    bounds: Bounds<T>,
}

#[derive(Clone, Copy, Debug)]
struct Bounds<T> {
    slack_n: T,
    tension_n: T,
    jump_n: T,
    following_m: T,
    driven_v: T,
    current_a: T,
    excess_a: T,
    a_per_n: T,
    /// Whether the encoder counts up when the tendon is pulled in.
    forward: bool,
}

impl<T: Scalar> AxisMonitor<T> {
    pub fn new(settings: &Settings, m_per_count: f32) -> Self {
        let (limits, servo) = (&settings.limits, &settings.servo);
        let ceiling = settings.f_max_n;
        Self {
            slack: Timer::new(looks(limits.slack_time_s)),
            stale: Timer::new(looks(limits.stale_time_s)),
            stuck: Timer::new(looks(limits.stuck_time_s)),
            still: Timer::new(looks(limits.still_time_s)),
            reversed: Timer::new(looks(limits.reversed_time_s)),
            over_current: Timer::new(CURRENT_LOOKS),
            disagrees: Timer::new(looks(limits.disagreement_time_s)),
            last_code: 0,
            last_count: 0,
            history: [T::zero(); JUMP_LOOKS],
            place: 0,
            filled: false,
            bounds: Bounds {
                slack_n: limits.slack_n.into(),
                tension_n: T::from(ceiling + limits.over_tension_part * ceiling),
                jump_n: limits.jump_n.into(),
                following_m: limits.following_m.into(),
                driven_v: T::from(limits.driven_part * servo.current_a * servo.resistance_ohm),
                current_a: limits.current_a.into(),
                excess_a: T::from(limits.disagreement_a + servo.friction_a),
                a_per_n: servo.pull_a_per_n.into(),
                forward: m_per_count > 0.0,
            },
        }
    }

    #[inline(always)]
    pub fn watch(
        &mut self,
        i: usize,
        view: &View<'_, T>,
        shown: &AxisView<T>,
        faults: &mut FaultSet,
    ) {
        self.cell(i, view, faults);
        self.motor(i, view, shown, faults);
    }

    /// The load cell and the tension that it tells.
    #[inline(always)]
    fn cell(&mut self, i: usize, view: &View<'_, T>, faults: &mut FaultSet) {
        let (sensors, bounds) = (view.sensors, &self.bounds);
        let (Some(&code), Some(&fresh), Some(&tension)) = (
            sensors.cell_codes.get(i),
            sensors.cell_fresh.get(i),
            view.measured.tensions_n.get(i),
        ) else {
            return;
        };
        let saturated = !(SATURATED..=CODE_MAX - SATURATED).contains(&code);
        faults.add(Fault::CellSaturated, saturated);
        let stale = self.stale.over(!fresh);
        faults.add(Fault::CellStale, stale);
        // A code that is not fresh is the last one: that is stale, not stuck.
        let stuck = self.stuck.over(fresh && code == self.last_code);
        faults.add(Fault::CellStuck, stuck);
        // What a dead cell says is no tension.
        let alive = view.driven && !saturated && !stale && !stuck;
        self.last_code = code;
        let slack = view.tensioned && !(tension >= bounds.slack_n);
        faults.add(Fault::Slack, self.slack.over(slack));
        faults.add(Fault::OverTension, alive && !(tension <= bounds.tension_n));
        let place = self.place & (JUMP_LOOKS - 1);
        let before = core::mem::replace(&mut self.history[place], tension);
        self.place = place + 1;
        let jump = self.filled && alive && !((tension - before).abs() <= bounds.jump_n);
        self.filled |= self.place == JUMP_LOOKS;
        faults.add(Fault::TensionJump, jump);
    }

    /// The motor and its encoder.
    #[inline(always)]
    fn motor(&mut self, i: usize, view: &View<'_, T>, axis: &AxisView<T>, faults: &mut FaultSet) {
        let bounds = &self.bounds;
        let (Some(&count), Some(&current), Some(&tension)) = (
            view.sensors.encoder_counts.get(i),
            view.measured.currents_a.get(i),
            view.measured.tensions_n.get(i),
        ) else {
            return;
        };
        let step = count.wrapping_sub(self.last_count).cast_signed();
        self.last_count = count;
        let driven = view.driven && axis.driving_v.abs() > bounds.driven_v;
        faults.add(Fault::EncoderStill, self.still.over(driven && step == 0));
        let pulls = axis.voltage_v > T::zero();
        let against = step != 0 && (step > 0) != (pulls == bounds.forward);
        let hard = view.driven && axis.voltage_v.abs() > bounds.driven_v;
        faults.add(Fault::EncoderReversed, self.reversed.over(hard && against));
        let lags = view.led && !(axis.following_m.abs() <= bounds.following_m);
        faults.add(Fault::Following, lags);
        let current = current.abs();
        faults.add(
            Fault::OverCurrent,
            self.over_current.over(!(current <= bounds.current_a)),
        );
        let explained = bounds.excess_a + bounds.a_per_n * tension.abs();
        faults.add(
            Fault::CurrentDisagrees,
            self.disagrees.over(!(current <= explained)),
        );
    }
}
