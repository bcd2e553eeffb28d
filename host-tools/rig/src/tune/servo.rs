//! The servo of a motor, as it answers: a step of its reference, and the transfer of its loop at rising frequencies.
//!
//! The loop is broken at the voltage of the motor: a sine is added there while the servo turns the motor at a steady speed, so that
//! its friction stays the same. What comes back by what goes in is the transfer; the board correlates both with the sine.

use super::estimate::UncertainValue;
use crate::actuator::Actuator;
use crate::loop_response::{GAIN_DB, Margins, PHASE_DEG, ResponsePoint};
use crate::rig_file::RigFile;
use crate::rig_file::derived::ServoLoop;
use leg_base::jog_report::{Finding, SERVO_REMEDY};
use leg_firmware::jog::{JogDrive, SINE_SETTLE_S, ServoResponse};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::Servo;
use nalgebra::Complex;

/// Periods of the sine, ticks: from 8 to 500 Hz, two in an octave.
const PERIODS_TICKS: [u16; 13] = [1000, 707, 500, 354, 250, 177, 125, 88, 62, 44, 31, 22, 16];

/// Whole periods that are measured at the least, and the least time of them, s.
const PERIODS_MIN: u16 = 4;
const MEASURED_S: f32 = 0.25;

/// Speed of the tendon, m/s.
const SPEED_M_PER_S: f32 = 2.5e-3;

/// Amplitude of the sine, as a part of the voltage that the speed induces: the motor never turns back.
const SINE_PART: f32 = 0.3;

/// Step of the reference, m.
const STEP_M: f32 = 2e-4;

/// What a margin may be off beside, degrees and dB, and the crossover, as a part of it: what was left on simulated legs between sweeps and
/// the transfer of their motors (`the_loop_of_a_servo_is_found`).
const OFF_DEG: f64 = 1.0;
const OFF_DB: f64 = 0.5;
const OFF_PART: f64 = 0.015;

/// The jogs by the servo of a motor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ServoPlan {
    pub step_m: f32,
    pub speed_m_per_s: f32,
    pub sine_v: f32,
}

impl ServoPlan {
    /// For a motor whose jogs have no more than a voltage, V, and go no farther than a travel, m; its board takes steps from
    /// `shortest_m` to `farthest_m`.
    pub fn new(
        servo: &Servo,
        voltage_max_v: f32,
        travel_max_m: f32,
        [shortest_m, farthest_m]: [f32; 2],
    ) -> Self {
        let by_voltage = voltage_max_v / (servo.back_emf_v_s_per_m * (1.0 + SINE_PART));
        let [longest, ..] = PERIODS_TICKS;
        let speed_m_per_s = SPEED_M_PER_S
            .min(by_voltage)
            .min(travel_max_m / time_s(longest));
        Self {
            step_m: STEP_M.max(shortest_m).min(farthest_m),
            speed_m_per_s,
            sine_v: SINE_PART * servo.back_emf_v_s_per_m * speed_m_per_s,
        }
    }

    /// How far the longest jog of a sweep goes, m.
    pub fn travel_m(self) -> f32 {
        let [longest, ..] = PERIODS_TICKS;
        self.speed_m_per_s * time_s(longest)
    }

    /// The lowest and the highest frequency of a sweep, Hz.
    pub fn range_hz(self) -> [u16; 2] {
        let [longest, .., shortest] = PERIODS_TICKS;
        [longest, shortest].map(|period_ticks| TICK_HZ / period_ticks)
    }

    /// The travel, without its sign, and the drive of each jog of a sweep.
    pub fn sweep(self) -> impl Iterator<Item = (f32, JogDrive)> {
        PERIODS_TICKS.into_iter().map(move |period_ticks| {
            let drive = JogDrive::ServoSine {
                speed_m_per_s: self.speed_m_per_s,
                amplitude_v: self.sine_v,
                period_ticks,
            };
            (self.speed_m_per_s * time_s(period_ticks), drive)
        })
    }
}

/// How long a sine takes, s.
fn time_s(period_ticks: u16) -> f32 {
    let period_s = f32::from(period_ticks) / f32::from(TICK_HZ);
    // A measured period begins with a whole one.
    SINE_SETTLE_S + MEASURED_S.max(f32::from(PERIODS_MIN) * period_s) + period_s
}

/// What the jogs of the servo have shown until now.
#[derive(Clone, Debug, Default)]
pub(super) struct ServoJogs {
    /// Overshoot by the step, and time until it settled, s, of each step.
    pub steps: Vec<[f64; 2]>,
    /// The points of each sweep.
    pub sweeps: Vec<Vec<ResponsePoint>>,
}

/// The point of a sweep that an answer is; none of an answer without a measured period.
pub(super) fn point(
    drive: JogDrive,
    response: Option<ServoResponse<f32>>,
) -> Option<ResponsePoint> {
    let (
        JogDrive::ServoSine { period_ticks, .. },
        Some(ServoResponse::Sine {
            periods: 1..,
            returned_v,
            injected_v,
        }),
    ) = (drive, response)
    else {
        return None;
    };
    let phasor = |[cosine, sine]: [f32; 2]| Complex::new(f64::from(cosine), -f64::from(sine));
    let hz = f64::from(TICK_HZ) / f64::from(period_ticks);
    let transfer = -phasor(returned_v) / phasor(injected_v);
    transfer
        .norm_sqr()
        .is_finite()
        .then(|| ResponsePoint::new(hz, transfer, 1.0))
}

/// A servo, as it was measured.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct MeasuredServo {
    /// The step, m.
    pub step_m: f64,
    /// How far the motor went beyond a step, as a part of it.
    pub overshoot: UncertainValue,
    /// Time from which it stayed within 5 % of the step, s.
    pub settled_s: UncertainValue,
    /// The transfer of the loop: the first sweep.
    pub points: Vec<ResponsePoint>,
    /// Where its gain is 1, Hz; none within the frequencies of the sweep.
    pub crossover_hz: Option<UncertainValue>,
    /// Its phase margin, degrees.
    pub phase_margin_deg: Option<UncertainValue>,
    /// Its gain margin, dB.
    pub gain_margin_db: Option<UncertainValue>,
}

impl MeasuredServo {
    pub(super) fn new(jogs: ServoJogs, step_m: f32) -> Self {
        let margins: Vec<_> = jogs
            .sweeps
            .iter()
            .map(|sweep| Margins::new(sweep))
            .collect();
        let settled_s = mean_of(jogs.steps.iter().map(|step| step[1]));
        let mean = |of: fn(&Margins) -> Option<f64>, off: f64| {
            let each: Vec<_> = margins.iter().filter_map(of).collect();
            let mean = (!each.is_empty()).then(|| mean_of(each.into_iter()))?;
            let uncertainty = mean.uncertainty.hypot(off);
            Some(UncertainValue {
                uncertainty,
                ..mean
            })
        };
        Self {
            step_m: step_m.into(),
            overshoot: mean_of(jogs.steps.iter().map(|step| step[0])),
            // The board looks once in a tick.
            settled_s: UncertainValue {
                uncertainty: settled_s.uncertainty.hypot(1.0 / f64::from(TICK_HZ)),
                ..settled_s
            },
            crossover_hz: mean(|margins| margins.phase_hz, 0.0).map(|hz| hz.widened(OFF_PART)),
            phase_margin_deg: mean(|margins| margins.phase_deg, OFF_DEG),
            gain_margin_db: mean(|margins| margins.gain_db, OFF_DB),
            points: jogs.sweeps.into_iter().next().unwrap_or_default(),
        }
    }

    /// What to do about a servo that is near to ringing; its motor counts from 1.
    pub(super) fn finding(&self, motor: u8) -> Option<Finding> {
        let less = |margin: Option<UncertainValue>, bar: f64| {
            margin.is_some_and(|margin| margin.value + margin.uncertainty < bar)
        };
        (less(self.phase_margin_deg, PHASE_DEG) || less(self.gain_margin_db, GAIN_DB)).then(|| Finding {
            what: format!("the servo of motor {motor} is near to ringing: less than {PHASE_DEG}° or {GAIN_DB} dB are left"),
            remedy: SERVO_REMEDY.into(),
        })
    }
}

fn mean_of(each: impl Iterator<Item = f64>) -> UncertainValue {
    let each: Vec<_> = each.map(|value| UncertainValue::new(value, 0.0)).collect();
    UncertainValue::mean_of_repeated(&each)
}

/// The transfer of the loop of a motor's servo by a rig file, at the frequencies of a sweep; the motor counts from 1.
#[must_use]
pub fn configured_servo(motor: u8, rig: &RigFile) -> Vec<ResponsePoint> {
    let own = usize::from(motor).saturating_sub(1);
    let actuator = rig.actuators.get(own).unwrap_or(&Actuator::DEFAULT);
    let servo = rig.gains.servos.get(own).unwrap_or(&Servo::DEFAULT);
    let servo_loop = ServoLoop::new(actuator, servo);
    let point = |period_ticks: u16| {
        let hz = f64::from(TICK_HZ) / f64::from(period_ticks);
        ResponsePoint::new(hz, servo_loop.voltage_transfer(servo, hz), 1.0)
    };
    PERIODS_TICKS.into_iter().map(point).collect()
}
