//! What raises the faults of one axis.

use super::{Debounce, MonitorInput};
use crate::control::{AxisView, CYCLE_TICKS, ticks};
use crate::sensors::CODE_MAX;
use crate::settings::Settings;
use crate::supervisor::{Fault, FaultSet};
use leg_model::Scalar;

/// Checks over which a tension must not jump: a millisecond, as an axis is checked once a cycle of 0.5 ms. A power of two,
/// for the index is masked.
const JUMP_CHECKS: usize = 2;

/// Checks after which a current is a fault: 2 ms, longer than the peak of a motor that reverses. Scenario `fault_over_current`
/// holds it.
const CURRENT_CHECKS: u32 = 4;

/// Codes this near to an end of the range are saturated: four steps of the 12-bit converter, whose sixteenfold sum a code is.
const SATURATED: u16 = 64;

/// Checks in a time in s, at least one: each axis has its turn once a cycle.
fn checks(time_s: f32) -> u32 {
    ticks(time_s).div_ceil(u32::from(CYCLE_TICKS))
}

/// Watches one axis.
#[derive(Clone, Copy, Debug)]
pub struct AxisMonitor<T> {
    slack: Debounce,
    stale: Debounce,
    stuck: Debounce,
    still: Debounce,
    reversed: Debounce,
    over_current: Debounce,
    disagrees: Debounce,
    last_code: u16,
    last_count: u16,
    history: [T; JUMP_CHECKS],
    place: usize,
    filled: bool,
    bounds: AxisBounds<T>,
}

#[derive(Clone, Copy, Debug)]
struct AxisBounds<T> {
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
        let f_max_n = settings.f_max_n;
        Self {
            slack: Debounce::new(checks(limits.slack_time_s)),
            stale: Debounce::new(checks(limits.stale_time_s)),
            stuck: Debounce::new(checks(limits.stuck_time_s)),
            still: Debounce::new(checks(limits.still_time_s)),
            reversed: Debounce::new(checks(limits.reversed_time_s)),
            over_current: Debounce::new(CURRENT_CHECKS),
            disagrees: Debounce::new(checks(limits.disagreement_time_s)),
            last_code: 0,
            last_count: 0,
            history: [T::zero(); JUMP_CHECKS],
            place: 0,
            filled: false,
            bounds: AxisBounds {
                slack_n: limits.slack_n.into(),
                tension_n: T::from(f_max_n + limits.over_tension_part * f_max_n),
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
        view: &MonitorInput<'_, T>,
        shown: &AxisView<T>,
        faults: &mut FaultSet,
    ) {
        self.cell(i, view, faults);
        self.motor(i, view, shown, faults);
    }

    /// The load cell and the tension that it reports.
    #[inline(always)]
    fn cell(&mut self, i: usize, view: &MonitorInput<'_, T>, faults: &mut FaultSet) {
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
        let stale = self.stale.update(!fresh);
        faults.add(Fault::CellStale, stale);
        // A code that is not fresh is the last one: that is stale, not stuck.
        let stuck = self.stuck.update(fresh && code == self.last_code);
        faults.add(Fault::CellStuck, stuck);
        // A dead cell reports no tension.
        let alive = view.driven && !saturated && !stale && !stuck;
        self.last_code = code;
        let slack = view.tensioned && !(tension >= bounds.slack_n);
        faults.add(Fault::Slack, self.slack.update(slack));
        faults.add(Fault::OverTension, alive && !(tension <= bounds.tension_n));
        let place = self.place & (JUMP_CHECKS - 1);
        let before = core::mem::replace(&mut self.history[place], tension);
        self.place = place + 1;
        let jump = self.filled && alive && !((tension - before).abs() <= bounds.jump_n);
        self.filled |= self.place == JUMP_CHECKS;
        faults.add(Fault::TensionJump, jump);
    }

    /// The motor and its encoder.
    #[inline(always)]
    fn motor(
        &mut self,
        i: usize,
        view: &MonitorInput<'_, T>,
        axis: &AxisView<T>,
        faults: &mut FaultSet,
    ) {
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
        faults.add(Fault::EncoderStill, self.still.update(driven && step == 0));
        let pulls = axis.voltage_v > T::zero();
        let against = step != 0 && (step > 0) != (pulls == bounds.forward);
        let hard = view.driven && axis.voltage_v.abs() > bounds.driven_v;
        faults.add(
            Fault::EncoderReversed,
            self.reversed.update(hard && against),
        );
        let lags = view.led && !(axis.following_m.abs() <= bounds.following_m);
        faults.add(Fault::Following, lags);
        let current = current.abs();
        faults.add(
            Fault::OverCurrent,
            self.over_current.update(!(current <= bounds.current_a)),
        );
        let explained = bounds.excess_a + bounds.a_per_n * tension.abs();
        faults.add(
            Fault::CurrentDisagrees,
            self.disagrees.update(!(current <= explained)),
        );
    }
}
