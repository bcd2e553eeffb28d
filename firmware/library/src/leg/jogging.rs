//! Jogging: one motor turns at a voltage or by its servo, the others rest. Whatever ends it, the motor is braked and then switched off.

use super::servo_run::ServoRun;
use super::shared::Shared;
use crate::control::{Axis, Debounce, JOG_RISE_S, JogBounds, Measured, TICK_S, bounds, ticks};
use crate::jog::{JogDemand, JogDrive, JogEnd, JogReport};
use leg_model::Scalar;

/// Time after the rise of the voltage until the speed is steady, s: ten times what the default motor takes. Before it the current
/// also accelerates the rotor.
const SETTLE_S: f32 = 0.05;

/// Time without a count, from the full voltage on, after which an encoder counts nothing, s. At the slowest jog
/// that is waited for, the encoder of the paper's rig counts 180 times meanwhile.
const SILENT_S: f32 = 0.1;

/// Time for which a motor draws more than any tension of a jog asks for before it ends, s: as in homing.
const HAUL_S: f32 = 0.03;

/// The same in a step of the reference, s: a rotor of twice the inertia, with a resistance and a torque constant that are a fifth off, is
/// brought up to speed and braked meanwhile.
const STEP_HAUL_S: f32 = 0.1;

/// Time for which the motor is braked without a voltage, s: ten times what the default motor takes.
const BRAKE_S: f32 = 0.05;

/// Counts of another encoder, or of this one the wrong way, that end a jog, m of tendon: less than what a motor turns before the
/// monitors find that its current disagrees with a voltage that it does not count.
const STRAY_M: f32 = 3e-5;

/// A motor that turns on by this while it is braked does not obey, m: five times as far as the default motor does from its fastest jog,
/// 7 mm/s, with its time constant of 5 ms.
const DISOBEYED_M: f32 = 2e-4;

/// A motor that comes no further than this has not turned, m: twice the play of the paper's gear, within which the screw stands. At 1 mm
/// a motor that stops at a taut tendon is said not to turn: test `without_its_load_cell_the_current_ends_a_jog`.
const TURNED_M: f32 = 5e-6;

/// What turns the motor.
#[derive(Clone, Copy, Debug)]
enum Drive<T> {
    /// A voltage, without its sign, V.
    Voltage(T),
    Servo(ServoRun<T>),
}

/// One motor turns.
#[derive(Clone, Copy, Debug)]
pub struct Jogging<T> {
    /// The motor, from 0.
    motor: usize,
    /// 1 to pull in, −1 to pay out.
    sign: T,
    travel_m: T,
    drive: Drive<T>,
    applied_v: T,
    start_m: [T; 3],
    /// Tension above which it ends, N.
    tension_max_n: T,
    bounds: JogBounds<T>,
    last_m: T,
    silent: Debounce,
    hauling: Debounce,
    /// Ticks driven, and those at a steady speed.
    ticks: u32,
    steady_ticks: u32,
    /// Where the motor was when they began, m.
    steady_from_m: T,
    ticks_max: u32,
    /// Ticks for which the motor is still braked, once it has ended.
    brake_ticks: Option<u32>,
}

impl<T: Scalar> Jogging<T> {
    /// From where the motors are, within the bounds of the demand's motor. What it measures is kept in `shared`.
    pub fn begin(
        shared: &mut Shared<T>,
        demand: &JogDemand,
        jog_bounds: &JogBounds<T>,
        measured: &Measured<T>,
    ) -> Self {
        let pays_out = demand.travel_m < 0.0;
        // A tendon that pulls already may be paid out, but no cell may show more for it.
        let taut_n = measured
            .steady_tensions_n
            .iter()
            .fold(T::zero(), |a, &b| bounds::max(a, b));
        let eased_n = taut_n + T::from(shared.limits.homing.touch_n);
        let homing_n = T::from(shared.limits.homing.f_max_n);
        let tension_max_n = if pays_out {
            bounds::max(homing_n, eased_n)
        } else {
            homing_n
        };
        let motor = usize::from(demand.motor.saturating_sub(1));
        shared.jog_report = Some(JogReport {
            demand: *demand,
            end: JogEnd::Running,
            time_s: T::zero(),
            pulled_m: [T::zero(); 3],
            tensions_n: [measured.steady_tensions_n; 2],
            steady_s: T::zero(),
            current_a: T::zero(),
            speed_m_per_s: T::zero(),
            tension_n: T::zero(),
            servo: None,
        });
        let start_m = measured.pulled_m.get(motor).copied().unwrap_or(T::zero());
        let travel_m = demand.travel_m;
        let driving_max_v = jog_bounds.driving_max_v();
        let drive = match demand.drive {
            JogDrive::Voltage(voltage_v) => Drive::Voltage(voltage_v.into()),
            JogDrive::ServoStep => {
                Drive::Servo(ServoRun::step_by(travel_m, start_m, driving_max_v))
            }
            JogDrive::ServoSine {
                speed_m_per_s,
                amplitude_v,
                period_ticks,
            } => Drive::Servo(ServoRun::turn_by(
                travel_m,
                speed_m_per_s,
                amplitude_v,
                period_ticks,
                start_m,
                driving_max_v,
            )),
        };
        Self {
            motor,
            sign: T::from(if pays_out { -1.0 } else { 1.0 }),
            travel_m: T::from(travel_m.abs()),
            drive,
            applied_v: T::zero(),
            start_m: measured.pulled_m,
            tension_max_n,
            bounds: *jog_bounds,
            last_m: start_m,
            silent: Debounce::new(ticks(SILENT_S)),
            hauling: Debounce::new(ticks(match demand.drive {
                JogDrive::ServoStep => STEP_HAUL_S,
                _ => HAUL_S,
            })),
            ticks: 0,
            steady_ticks: 0,
            steady_from_m: T::zero(),
            ticks_max: ticks(jog_bounds.time_max_s(demand)),
            brake_ticks: None,
        }
    }

    /// The motor, from 0, and the voltage at it, V.
    #[inline(always)]
    pub fn voltage(&self) -> (usize, T) {
        (self.motor, self.applied_v)
    }

    /// One tick; true when the motor has been braked.
    #[inline(never)]
    pub fn step(&mut self, shared: &mut Shared<T>, measured: &Measured<T>) -> bool {
        let (Some(&pulled), Some(&current), Some(axis)) = (
            measured.pulled_m.get(self.motor),
            measured.currents_a.get(self.motor),
            shared.axes.get_mut(self.motor),
        ) else {
            return true;
        };
        let applied = axis.applied();
        if let Some(report) = &mut shared.jog_report {
            for ((moved, now), start) in report
                .pulled_m
                .iter_mut()
                .zip(measured.pulled_m)
                .zip(self.start_m)
            {
                *moved = now - start;
            }
            report.tensions_n[1] = measured.steady_tensions_n;
            if self.brake_ticks.is_none() {
                self.ticks += 1;
                report.time_s = T::from(self.ticks as f32 * TICK_S);
                self.turn(axis, pulled, measured.supply_v);
                let tension = measured.tensions_n.get(self.motor);
                self.average(report, pulled, current, tension.copied());
                let hauled_a = if shared.current_outputs.hides_short_pulses(self.motor) {
                    self.bounds.ceiling_a(current, &applied, measured.supply_v)
                } else {
                    current
                };
                report.end = self.end(report, pulled, hauled_a);
                if report.end != JogEnd::Running {
                    self.brake_ticks = Some(ticks(BRAKE_S));
                    if let Drive::Servo(run) = &self.drive {
                        report.servo = run.ended().then(|| run.response());
                    }
                }
            }
        }
        if let Some(left) = &mut self.brake_ticks {
            self.applied_v = T::zero();
            // One that turns on all the same does not obey its voltage: off with it.
            let obeys = (pulled - self.last_m).abs() <= T::from(DISOBEYED_M);
            *left = if obeys { left.saturating_sub(1) } else { 0 };
        }
        if self.brake_ticks.is_some() || matches!(self.drive, Drive::Voltage(_)) {
            axis.apply_voltage(self.applied_v, pulled);
        }
        self.brake_ticks == Some(0)
    }

    /// The next voltage.
    fn turn(&mut self, axis: &mut Axis<T>, pulled: T, supply_v: T) {
        match &mut self.drive {
            Drive::Voltage(voltage_v) => {
                let risen = *voltage_v * T::from(self.ticks as f32 * (TICK_S / JOG_RISE_S));
                self.applied_v = bounds::min(risen, *voltage_v) * self.sign;
            }
            Drive::Servo(run) => self.applied_v = run.step(axis, pulled, supply_v),
        }
    }

    /// Adds a tick to the means of the report.
    fn average(&mut self, report: &mut JogReport<T>, pulled: T, current: T, tension: Option<T>) {
        if self.ticks <= ticks(JOG_RISE_S + SETTLE_S) {
            self.steady_from_m = pulled;
            report.current_a = current;
            return;
        }
        self.steady_ticks += 1;
        report.steady_s = T::from(self.steady_ticks as f32 * TICK_S);
        report.speed_m_per_s = (pulled - self.steady_from_m) / report.steady_s;
        let share = T::one() / T::from(self.steady_ticks as f32);
        report.current_a += (current - report.current_a) * share;
        if let Some(tension) = tension {
            report.tension_n += (tension - report.tension_n) * share;
        }
    }

    /// Whether a motor that obeys counts now.
    fn counts(&self) -> bool {
        match &self.drive {
            Drive::Voltage(_) => self.ticks >= ticks(JOG_RISE_S),
            Drive::Servo(run) => run.counts(),
        }
    }

    /// Whether it has gone as far as it was asked, by `moved` of its own way, m.
    fn arrived(&self, moved: T) -> bool {
        match &self.drive {
            Drive::Voltage(_) => moved >= self.travel_m,
            Drive::Servo(run) => run.ended(),
        }
    }

    /// What ends it now, if anything does.
    fn end(&mut self, report: &JogReport<T>, pulled: T, current: T) -> JogEnd {
        let moved = report
            .pulled_m
            .get(self.motor)
            .map_or(T::zero(), |&moved| moved * self.sign);
        let silent = self.silent.update(self.counts() && pulled == self.last_m);
        self.last_m = pulled;
        let hauls = self
            .hauling
            .update(!(current.abs() <= self.bounds.current_max_a));
        let stray = T::from(STRAY_M);
        let mut others = (1..).zip(&report.pulled_m);
        let other = others
            .find(|&(number, by)| usize::from(number) != self.motor + 1 && !(by.abs() <= stray));
        let mut cells = (1..).zip(&report.tensions_n[1]);
        let taut = cells.find(|&(_, &tension)| !(tension <= self.tension_max_n));
        if let Some((number, _)) = other {
            JogEnd::OtherEncoder(number)
        } else if !(moved >= -stray) {
            JogEnd::WrongWay
        } else if let Some((number, _)) = taut {
            JogEnd::Tension(number)
        } else if self.arrived(moved) {
            JogEnd::Arrived
        } else if silent || (hauls && moved <= T::from(TURNED_M)) {
            JogEnd::NoCounts
        } else if hauls {
            JogEnd::Current
        } else if self.ticks >= self.ticks_max {
            JogEnd::Time
        } else {
            JogEnd::Running
        }
    }
}

#[cfg(test)]
mod tests;
