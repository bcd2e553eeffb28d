//! What raises the faults of one axis.

use super::{Excess, MonitorInput};
use crate::control::{
    AxisView, CYCLE_S, CYCLE_TICKS, Debounce, LowPass, TICK_S, bounds::min, ticks,
};
use crate::sensors::{CODE_MAX, SATURATED_CODES};
use crate::settings::{Servo, Settings};
use crate::supervisor::{Fault, FaultSet};
use leg_model::Scalar;

/// Checks over which a tension must not jump: a millisecond, as an axis is checked once a cycle of 0.5 ms. A power of two,
/// for the index is masked.
const JUMP_CHECKS: usize = 2;

/// Checks after which a current or a tension is a fault: 2 ms, longer than the peak of a motor that reverses, and than a load
/// cell needs to jump. Scenario `fault_over_current` holds it.
const OVER_CHECKS: u32 = 4;

/// Part of `following_m` by which a motor that reels in may be away from where it is led while it goes farther.
pub const AWAY_PART: f32 = 0.75;

/// The same of one that pays out. One that has to stop or turn about from its highest speed brakes by all its current, and comes to three quarters of
/// `following_m` (`a_motor_that_brakes_as_it_pays_out_does_not_run_away`).
const PAYING_OUT_AWAY_PART: f32 = 0.9;

/// A counter that goes farther between two checks than at its speed has jumped, by this part of what the fastest motor goes in a
/// tick: on the paper's rig 3.4 µm.
const STEP_PART: f32 = 0.9;

/// The least of that, as a multiple of what the highest current gives the motor in a cycle: by half of it a motor goes farther that turns about, and its tracked
/// speed lags by more. Without it one that is set to be slow, or that has a light rotor behind a coarse screw, was taken for a counter that jumps
/// (`tests/suite/rig/other_motors.rs`).
const ACCELERATED_MULTIPLE: f32 = 2.5;

/// The most of that, as a part of `following_m`: the gains tell the acceleration of a servo that was made soft as much greater than it is.
const ACCELERATED_MAX: f32 = 0.1;

/// What is added to that in counts, where these are coarse: a motor that starts counts one at once, and one that goes by a part of a count counts a
/// whole one (`coarse_counts_of_a_light_rotor_do_not_jump`).
const STEP_COUNTS: f32 = 1.5;

/// What a voltage drives through a winding at the resistance of the settings, as a multiple of what it drives through a warm one:
/// copper has 1.3 times the resistance when it is 75 °C warmer. Without it a motor without a gear was held at 65 °C
/// (`tests/suite/rig/other_motors.rs`). So a current sensor that shows 23 % less than flows raises nothing either.
const WARM_RATIO: f32 = 1.3;

/// Part of the highest voltage that a motor can get which one that is jammed gets in any case. Less than one, or no voltage would show a
/// jam where the maximum tension takes nearly all of it. At a half, a motor without a gear whose windings are warm is taken for
/// jammed (`tests/suite/rig/other_motors.rs`).
pub const JAMMED_PART: f32 = 0.95;

/// A current that lacks this many times the current of friction of what the voltage drives is not measured: twice, as friction
/// is known no better.
const LACK_FRICTIONS: f32 = 2.0;

/// Part of the servo's highest current that, lacking besides, is more than a motor's speed or its friction explain.
const OPEN_PART: f32 = 0.25;

/// Time constant of the filters by which current and voltage are compared, s: at low tension the voltage changes its sign from tick
/// to tick, and the current follows later. A tenth of the time after which it is a fault.
const LACK_TIME_S: f32 = 0.005;

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
    over_tension: Debounce,
    over_current: Debounce,
    disagrees: Debounce,
    /// The current that the voltage drives and the measured one, filtered, A.
    driving_a: LowPass<T>,
    drawn_a: LowPass<T>,
    /// The voltage at the last check, V.
    last_voltage_v: T,
    last_code: u16,
    last_count: u16,
    history: [T; JUMP_CHECKS],
    place: usize,
    filled: bool,
    /// Whether the tension has jumped since faults were cleared last: the history then begins with what it was before, and stays so.
    jumped: bool,
    /// How near to that the tension has to come back, N: by half of its jump, or of the least one that counts in any case.
    near_n: T,
    bounds: AxisBounds<T>,
}

#[derive(Clone, Copy, Debug)]
struct AxisBounds<T> {
    slack_n: T,
    tension_n: T,
    jump_n: T,
    step_m: T,
    m_per_count: T,
    following_m: T,
    away_m: T,
    hard_v: T,
    driven_v: T,
    a_per_v: T,
    lack_a: T,
    lack_a_per_v: T,
    open_a: T,
    current_a: T,
    excess_a: T,
    a_per_n: T,
}

impl<T: Scalar> AxisMonitor<T> {
    pub fn new(settings: &Settings, servo: &Servo, m_per_count: f32) -> Self {
        let limits = &settings.limits;
        let f_max_n = settings.f_max_n;
        let hard_v = limits.driven_part * servo.current_a * servo.resistance_ohm;
        let accelerated_m =
            ACCELERATED_MULTIPLE * servo.acceleration_m_per_s2() * CYCLE_S * CYCLE_S;
        let accelerated_m = accelerated_m.min(ACCELERATED_MAX * limits.following_m);
        // What the maximum tension asks of a warm winding holds a motor, and need not turn it. One that is jammed gets nearly all that
        // the servo and the supply give.
        let holding_a = (servo.friction_a + servo.pull_a_per_n * f_max_n) * WARM_RATIO;
        let most_v = (servo.current_a * servo.resistance_ohm)
            .min(servo.duty_max * limits.supply_min_v)
            * JAMMED_PART;
        let driven_v = hard_v.max((holding_a * servo.resistance_ohm).min(most_v));
        Self {
            slack: Debounce::new(checks(limits.slack_time_s)),
            stale: Debounce::new(checks(limits.stale_time_s)),
            stuck: Debounce::new(checks(limits.stuck_time_s)),
            still: Debounce::new(checks(limits.still_time_s)),
            reversed: Debounce::new(checks(limits.reversed_time_s)),
            over_tension: Debounce::new(OVER_CHECKS),
            over_current: Debounce::new(OVER_CHECKS),
            disagrees: Debounce::new(checks(limits.disagreement_time_s)),
            driving_a: LowPass::new(LACK_TIME_S, CYCLE_S),
            drawn_a: LowPass::new(LACK_TIME_S, CYCLE_S),
            last_voltage_v: T::zero(),
            last_code: 0,
            last_count: 0,
            history: [T::zero(); JUMP_CHECKS],
            place: 0,
            filled: false,
            jumped: false,
            near_n: T::zero(),
            bounds: AxisBounds {
                m_per_count: m_per_count.into(),
                slack_n: limits.slack_n.into(),
                tension_n: T::from(f_max_n + limits.over_tension_part * f_max_n),
                jump_n: limits.jump_n.into(),
                step_m: T::from(
                    (STEP_PART * servo.speed_m_per_s * TICK_S)
                        .max(accelerated_m + STEP_COUNTS * m_per_count.abs()),
                ),
                following_m: limits.following_m.into(),
                away_m: T::from(AWAY_PART * limits.following_m),
                a_per_v: T::from(1.0 / servo.resistance_ohm),
                lack_a: T::from(LACK_FRICTIONS * servo.friction_a),
                // A tenth of what the speed induces is known no better.
                lack_a_per_v: T::from(0.1 / servo.resistance_ohm),
                open_a: T::from(OPEN_PART * servo.current_a),
                hard_v: T::from(hard_v),
                driven_v: T::from(driven_v),
                current_a: limits.current_a.into(),
                excess_a: T::from(limits.disagreement_a + servo.friction_a),
                a_per_n: servo.pull_a_per_n.into(),
            },
        }
    }

    /// The load cell and the tension that it reports; `jump_n` is the change of it within a millisecond that is a jump, N.
    #[inline(always)]
    pub fn watch_cell(
        &mut self,
        i: usize,
        view: &MonitorInput<'_, T>,
        jump_n: T,
        excess: Excess,
        faults: &mut FaultSet,
    ) {
        let (sensors, bounds) = (view.sensors, &self.bounds);
        let (Some(&code), Some(&fresh), Some(&tension)) = (
            sensors.cell_codes.get(i),
            sensors.cell_fresh.get(i),
            view.measured.tensions_n.get(i),
        ) else {
            return;
        };
        let saturated = !(SATURATED_CODES..=CODE_MAX - SATURATED_CODES).contains(&code);
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
        let over = alive && !(tension <= bounds.tension_n);
        let over = self.over_tension.update(over);
        // A cell that the others contradict pays out no tendon.
        // Rare, and so apart.
        if over {
            faults.add(Fault::OverTension, excess == Excess::Trusted);
            faults.add(Fault::Residual, excess == Excess::Doubted);
        }
        if self.jumped {
            return;
        }
        let place = self.place & (JUMP_CHECKS - 1);
        let before = core::mem::replace(&mut self.history[place], tension);
        self.place = place + 1;
        let change_n = (tension - before).abs();
        let jump = self.filled && alive && !(change_n <= jump_n);
        self.filled |= self.place == JUMP_CHECKS;
        faults.add(Fault::TensionJump, jump);
        // A cell that comes back from the dead while the leg is held does not jump away.
        if jump && (view.led || view.cells_trusted) {
            self.jumped = true;
            self.history[0] = before;
            self.near_n = min(change_n, bounds.jump_n) * T::HALF;
        }
    }

    /// Whether a tension, N, has jumped and not come back since: a cut or slipped tendon, or a load cell that reads wrong. After a knock it comes
    /// back.
    pub fn stays_jumped(&self, tension_n: T) -> bool {
        self.jumped && !((tension_n - self.history[0]).abs() <= self.near_n)
    }

    /// What has jumped before is no matter any more.
    pub fn forget_jump(&mut self) {
        if self.jumped {
            (self.jumped, self.filled, self.place) = (false, false, 0);
        }
    }

    /// The motor and its encoder. From a current output that is silent nothing is concluded but what it reads all the same.
    #[inline(always)]
    pub fn watch_motor<const SILENT: bool>(
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
        if !view.driven {
            // What a driver reports that is off means nothing.
            return self.rest();
        }
        let driven = axis.driving_v.abs() > bounds.driven_v;
        let hard = axis.voltage_v.abs() > bounds.hard_v;
        let step_m = T::from(f32::from(step)) * bounds.m_per_count;
        let against = step_m * axis.voltage_v < T::zero();
        let turned = axis.voltage_v * self.last_voltage_v < T::zero();
        self.last_voltage_v = axis.voltage_v;
        // A motor that the servo brakes counts against its voltage for less than reversed_time_s; its next brake is another one.
        faults.add(
            Fault::EncoderReversed,
            self.reversed.update(hard && against && !turned),
        );
        let beyond_m = step_m.abs() - axis.speed_m_per_s.abs() * T::from(CYCLE_S);
        faults.add(Fault::EncoderJump, !(beyond_m <= bounds.step_m));
        let off_m = axis.following_m.abs();
        // Farther from where it is led with every tick: it does not obey its voltage.
        let away = axis.following_m * axis.speed_m_per_s < T::zero();
        // Rare, and so apart.
        if away && !(off_m <= bounds.away_m) {
            let paid_out_m = bounds.away_m * T::from(PAYING_OUT_AWAY_PART / AWAY_PART);
            let reels_in = !(axis.speed_m_per_s < T::zero());
            faults.add(Fault::RunsAway, reels_in || !(off_m <= paid_out_m));
        }
        faults.add(Fault::Following, view.led && !(off_m <= bounds.following_m));
        let over_current = !(current.abs() <= bounds.current_a);
        faults.add(Fault::OverCurrent, self.over_current.update(over_current));
        let explained = bounds.excess_a + bounds.a_per_n * tension.abs();
        let induced_v = axis.voltage_v - axis.driving_v;
        // A driver gives no pulse in the tick in which it turns about.
        let missed_v = if turned { axis.voltage_v } else { T::zero() };
        let mean_v = axis.mean_voltage_v - missed_v * T::from(1.0 / CYCLE_TICKS as f32);
        let driving_v = mean_v - induced_v;
        let (lack, drawn) = if SILENT {
            (T::zero(), current.abs())
        } else {
            let driving = self.driving_a.step(driving_v * bounds.a_per_v).abs();
            let drawn = self.drawn_a.step(current).abs();
            let allowed = bounds.lack_a + induced_v.abs() * bounds.lack_a_per_v;
            (driving - (drawn * T::from(WARM_RATIO) + allowed), drawn)
        };
        // A motor that draws less than its voltage drives through one that stands is turning, or is not connected.
        let stands = step == 0;
        let least = if stands { T::zero() } else { bounds.open_a };
        let lost = view.led && !(lack <= least);
        let still = self.still.update(lost || stands && driven);
        faults.add(Fault::EncoderStill, still && !lost);
        let disagrees = !(lack <= T::zero() && drawn <= explained);
        let disagrees = self.disagrees.update(disagrees);
        faults.add(Fault::CurrentDisagrees, disagrees || still && lost);
    }

    /// The driver is off.
    fn rest(&mut self) {
        for debounce in [
            &mut self.still,
            &mut self.reversed,
            &mut self.over_current,
            &mut self.disagrees,
        ] {
            debounce.update(false);
        }
        self.driving_a.set(T::zero());
        self.drawn_a.set(T::zero());
        self.last_voltage_v = T::zero();
    }
}
