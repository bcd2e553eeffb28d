//! A jog by the servo: how the motor answers a step of its reference, or a sine that is added to its voltage.

use crate::control::{Axis, AxisInput, TICK_S, bounds, ticks};
use crate::jog::{SINE_SETTLE_S, ServoResponse};
use leg_model::Scalar;

/// Time in which the answer to a step is watched, s: the servo of the paper's rig has settled after a sixth of it.
const STEP_S: f32 = 0.3;

/// A step is settled within this part of it.
const SETTLED_PART: f32 = 0.05;

/// Time in which a sine comes up, s.
const RISE_S: f32 = 0.1;

/// What leads the motor.
#[derive(Clone, Copy, Debug)]
enum Reference<T> {
    Step { overshoot_m: T, settled_ticks: u32 },
    Speed { step_m: T, sine: Sine<T> },
}

/// A motor that its servo leads.
#[derive(Clone, Copy, Debug)]
pub struct ServoRun<T> {
    reference: Reference<T>,
    /// Where the motor began, and how far it is led, m; below zero it pays out.
    start_m: T,
    travel_m: T,
    /// What it gets at the most beyond what its speed induces, V.
    driving_max_v: T,
    ticks: u32,
    /// Ticks in which it is led.
    ticks_max: u32,
}

impl<T: Scalar> ServoRun<T> {
    /// A step of the reference by a travel, from where the motor is, m.
    pub fn step_by(travel_m: f32, start_m: T, driving_max_v: f32) -> Self {
        Self {
            reference: Reference::Step {
                overshoot_m: T::zero(),
                settled_ticks: 0,
            },
            start_m,
            travel_m: travel_m.into(),
            driving_max_v: driving_max_v.into(),
            ticks: 0,
            ticks_max: ticks(STEP_S),
        }
    }

    /// A travel from there at a speed, m/s, with a sine of an amplitude, V, and a period.
    pub fn turn_by(
        travel_m: f32,
        speed_m_per_s: f32,
        amplitude_v: f32,
        period_ticks: u16,
        start_m: T,
        driving_max_v: f32,
    ) -> Self {
        let step_m = (speed_m_per_s * TICK_S).copysign(travel_m);
        Self {
            reference: Reference::Speed {
                step_m: step_m.into(),
                sine: Sine::new(amplitude_v, period_ticks),
            },
            start_m,
            travel_m: travel_m.into(),
            driving_max_v: driving_max_v.into(),
            ticks: 0,
            ticks_max: ticks(travel_m.abs() / speed_m_per_s),
        }
    }

    /// Whether a motor that obeys counts now: until a step has settled, and once a speed is reached.
    pub fn counts(&self) -> bool {
        match &self.reference {
            Reference::Step { settled_ticks, .. } => *settled_ticks == self.ticks,
            Reference::Speed { .. } => self.ticks >= ticks(RISE_S),
        }
    }

    /// Whether it was led to the end.
    pub const fn ended(&self) -> bool {
        self.ticks >= self.ticks_max
    }

    /// One tick: the voltage at the motor, V.
    pub fn step(&mut self, axis: &mut Axis<T>, pulled_m: T, supply_v: T) -> T {
        self.ticks += 1;
        let step_m = match &self.reference {
            Reference::Step { .. } if self.ticks == 1 => self.travel_m,
            Reference::Step { .. } => T::zero(),
            Reference::Speed { step_m, .. } => *step_m,
        };
        axis.lead_by(step_m);
        let applied = axis.applied();
        let induced_v = applied.voltage_v - applied.driving_v;
        let most_v = bounds::min(supply_v, induced_v.abs() + self.driving_max_v);
        axis.drive(&AxisInput {
            pulled_m,
            // The bounds of the jog end it, not those of the servo.
            tension_n: T::zero(),
            f_max_n: T::MAX,
            supply_v: most_v,
            duty_per_v: T::zero(),
            lowest_m: -T::MAX,
        });
        let asked_v = axis.applied().voltage_v;
        match &mut self.reference {
            Reference::Step {
                overshoot_m,
                settled_ticks,
            } => {
                let left_m = self.start_m + self.travel_m - pulled_m;
                if left_m.abs() > T::from(SETTLED_PART) * self.travel_m.abs() {
                    *settled_ticks = self.ticks;
                }
                let beyond_m = if self.travel_m < T::zero() {
                    left_m
                } else {
                    -left_m
                };
                *overshoot_m = bounds::max(*overshoot_m, beyond_m);
                asked_v
            }
            Reference::Speed { sine, .. } => {
                let injected_v = sine.step(self.ticks, asked_v, most_v);
                axis.add_voltage(injected_v - asked_v);
                injected_v
            }
        }
    }

    /// How the servo has answered until now.
    pub fn response(&self) -> ServoResponse<T> {
        match &self.reference {
            Reference::Step {
                overshoot_m,
                settled_ticks,
            } => ServoResponse::Step {
                overshoot_m: *overshoot_m,
                settled_s: T::from(*settled_ticks as f32 * TICK_S),
            },
            Reference::Speed { sine, .. } => sine.response(),
        }
    }
}

/// A sine, and what goes with it of the voltages on both sides of where it is added.
#[derive(Clone, Copy, Debug)]
struct Sine<T> {
    amplitude_v: T,
    period_ticks: u16,
    /// Cosine and sine of the angle of a tick.
    turn: [T; 2],
    /// Of the angle now, and ticks of the period that are over.
    now: [T; 2],
    at: u16,
    /// Whether this period is measured.
    measured: bool,
    /// Sums of the voltage that is asked for and of that at the motor, by cosine and sine: of this period, and of those before it, V.
    sums_v: [[T; 2]; 2],
    totals_v: [[T; 2]; 2],
    periods: u16,
}

impl<T: Scalar> Sine<T> {
    fn new(amplitude_v: f32, period_ticks: u16) -> Self {
        // The tangent of half of the angle of a tick by its series: at the shortest period it is off by 1e-8.
        let half = core::f32::consts::PI / f32::from(period_ticks);
        let square = half * half;
        let series = 1.0 + square * (1.0 / 3.0 + square * (2.0 / 15.0 + square * (17.0 / 315.0)));
        let tangent = T::from(half) * T::from(series);
        let scale = T::one() / (T::one() + tangent * tangent);
        Self {
            amplitude_v: amplitude_v.into(),
            period_ticks,
            turn: [
                (T::one() - tangent * tangent) * scale,
                T::TWO * tangent * scale,
            ],
            now: [T::one(), T::zero()],
            at: 0,
            measured: false,
            sums_v: [[T::zero(); 2]; 2],
            totals_v: [[T::zero(); 2]; 2],
            periods: 0,
        }
    }

    /// One tick, of so many: the voltage at the motor where one is asked for, no more than `most_v`, V.
    fn step(&mut self, ticks_run: u32, asked_v: T, most_v: T) -> T {
        if self.at == 0 {
            self.now = [T::one(), T::zero()];
            self.sums_v = [[T::zero(); 2]; 2];
            self.measured = ticks_run >= ticks(SINE_SETTLE_S);
        }
        let risen = bounds::min(T::from(ticks_run as f32 * (TICK_S / RISE_S)), T::one());
        let added_v = self.amplitude_v * risen * self.now[1];
        let injected_v = bounds::clamp_symmetric(asked_v + added_v, most_v);
        for (sums, voltage) in self.sums_v.iter_mut().zip([asked_v, injected_v]) {
            for (sum, part) in sums.iter_mut().zip(self.now) {
                *sum += part * voltage;
            }
        }
        let ([cosine, sine], [turn_cosine, turn_sine]) = (self.now, self.turn);
        self.now = [
            cosine * turn_cosine - sine * turn_sine,
            sine * turn_cosine + cosine * turn_sine,
        ];
        self.at += 1;
        if self.at >= self.period_ticks {
            self.at = 0;
            self.end_period();
        }
        injected_v
    }

    fn end_period(&mut self) {
        if !self.measured {
            return;
        }
        self.periods = self.periods.saturating_add(1);
        for (totals, sums) in self.totals_v.iter_mut().zip(self.sums_v) {
            for (total, sum) in totals.iter_mut().zip(sums) {
                *total += sum;
            }
        }
    }

    fn response(&self) -> ServoResponse<T> {
        let ticks = f32::from(self.period_ticks) * f32::from(self.periods.max(1));
        let [returned_v, injected_v] = self
            .totals_v
            .map(|totals| totals.map(|total| total * T::from(2.0 / ticks)));
        ServoResponse::Sine {
            periods: self.periods,
            returned_v,
            injected_v,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{SINE_SETTLE_S, ServoResponse, ServoRun, Sine};
    use crate::control::{JogBounds, ticks};
    use crate::leg::shared::{Checked, Shared};
    use crate::settings::Settings;

    /// What a motor that stands gets drives twice the highest current of homing at the most, whatever is asked of its servo.
    #[test]
    fn a_motor_that_stands_gets_no_more_than_twice_the_current_of_homing() {
        let settings = Settings::table_1().unwrap();
        let servo = &settings.servos[0];
        let friction_a = f64::from(servo.friction_a);
        let pull_a = f64::from(servo.pull_a_per_n) * f64::from(settings.homing.f_max_n);
        let bound_v = 2.0 * (1.5 * friction_a + pull_a) * f64::from(servo.resistance_ohm);
        let driving_max_v = JogBounds::<f64>::new(&settings, servo).driving_max_v();
        let start_m = 0.01;
        for run in [
            ServoRun::step_by(3e-4, start_m, driving_max_v),
            ServoRun::step_by(-3e-4, start_m, driving_max_v),
            ServoRun::turn_by(1e-2, 1e-3, 6.0, 20, start_m, driving_max_v),
        ] {
            let mut run = run;
            let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
            let axis = &mut shared.axes[0];
            axis.rest(start_m);
            for _ in 0..ticks(0.1) {
                axis.track(start_m);
            }
            let mut most_v = 0.0_f64;
            for _ in 0..ticks(0.3) {
                axis.track(start_m);
                most_v = most_v.max(run.step(axis, start_m, 24.0).abs());
            }
            // The bound is reached; the greatest duty takes a twentieth of it.
            let part = most_v / bound_v;
            assert!((0.9..1.0 + 1e-6).contains(&part), "{most_v} of {bound_v} V");
        }
    }

    /// Both ways: what a motor lacks of its travel is no overshoot.
    #[test]
    fn the_overshoot_of_a_step_is_what_goes_beyond_its_travel() {
        let settings = Settings::table_1().unwrap();
        let mut shared = Shared::<f64>::new(&settings, Checked::new(&settings).unwrap());
        let start_m = 0.01;
        for travel_m in [1e-4, -1e-4_f32] {
            let mut run = ServoRun::step_by(travel_m, start_m, 1.0);
            for (part, most) in [(0.0, 0.0), (0.5, 0.0), (1.25, 0.25), (0.9, 0.25)] {
                let pulled_m = start_m + part * f64::from(travel_m);
                run.step(&mut shared.axes[0], pulled_m, 24.0);
                let ServoResponse::Step { overshoot_m, .. } = run.response() else {
                    panic!("no step");
                };
                let expected_m = most * f64::from(travel_m.abs());
                assert!(
                    (overshoot_m - expected_m).abs() < 1e-12,
                    "{travel_m} {part}"
                );
            }
        }
    }

    /// A voltage that is known comes back by its parts, whatever constant and drift it has.
    #[test]
    fn the_parts_of_a_voltage_are_found_at_every_period() {
        for period_ticks in [16, 101, 8000] {
            let mut sine = Sine::<f32>::new(0.5, period_ticks);
            let from = ticks(SINE_SETTLE_S).next_multiple_of(period_ticks.into());
            for tick in 0..from + 4 * u32::from(period_ticks) {
                let turns = f64::from(tick % u32::from(period_ticks)) / f64::from(period_ticks);
                let angle = core::f64::consts::TAU * turns;
                let asked_v = 3.0 + 0.2 * angle.cos() - 0.3 * angle.sin();
                sine.step(tick, asked_v as f32, 24.0);
            }
            let ServoResponse::Sine {
                periods,
                returned_v,
                injected_v,
            } = sine.response()
            else {
                panic!("no sine");
            };
            assert_eq!(periods, 4);
            for (found, expected) in [(returned_v, [0.2, -0.3]), (injected_v, [0.2, 0.2])] {
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!((found - expected).abs() < 2e-4, "{period_ticks}: {found}");
                }
            }
        }
    }
}
