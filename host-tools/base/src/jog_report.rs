//! What a jog will do and what it measured, in a user's words.

use crate::json_object;
use crate::rounding::rounded;
use leg_firmware::control::JOG_RISE_S;
use leg_firmware::jog::{JogDemand, JogDrive, JogEnd, JogReport};
use leg_firmware::settings::{Servo, Settings};
use serde::Serialize;
use std::fmt::Write as _;

/// Speed of the tendon that the voltage is chosen for, m/s.
const SPEED_M_PER_S: f32 = 2e-3;

/// What to do about a servo that rings or is near to it.
pub const SERVO_REMEDY: &str = "lower position_gain_per_s and speed_gain_v_s_per_m in `[control.servo]`, or write the measured constants \
     into the rig file and let the gains follow from them";

/// Least change of a tension that says something of a load cell, N: tendons that just pull change by 2 N where the leg swings.
const CHANGE_MIN_N: f32 = 3.0;

/// Part of another tendon's change below which a load cell shows nothing of its own tendon. Where a tendon pulls against another one, it changes by
/// about half as much, the weight of the leg left out: their directions differ by 120°.
const OWN_PART: f32 = 0.2;

/// The voltage at which a motor, from 1, turns slowly: twice its friction, and what a slow turn induces; below what counts as driven.
#[must_use]
pub fn slow_voltage_v(motor: u8, settings: &Settings) -> f32 {
    let servo = servo_of(motor, settings);
    let friction_v = 2.0 * servo.resistance_ohm * servo.friction_a;
    let highest_v = settings.limits.driven_part * servo.current_a * servo.resistance_ohm;
    let voltage_v = friction_v + servo.back_emf_v_s_per_m * SPEED_M_PER_S;
    // A tenth of a volt is as fine as anybody would give it.
    ((voltage_v * 10.0).round() / 10.0).min(0.9 * highest_v)
}

/// The servo of a motor, from 1: a jog of another one is refused.
fn servo_of(motor: u8, settings: &Settings) -> &Servo {
    let own = usize::from(motor).saturating_sub(1);
    settings.servos.get(own).unwrap_or(&Servo::DEFAULT)
}

/// What will happen, before it does.
#[must_use]
pub fn plan(demand: &JogDemand, settings: &Settings) -> String {
    let JogDemand {
        motor,
        travel_m,
        drive,
    } = *demand;
    let servo = servo_of(motor, settings);
    let driven = match drive {
        JogDrive::Voltage(voltage_v) => {
            let left_v = voltage_v - servo.resistance_ohm * servo.friction_a;
            let speed_mm_per_s = (1000.0 * left_v / servo.back_emf_v_s_per_m).max(0.0);
            format!("at {voltage_v:.2} V, at about {speed_mm_per_s:.1} mm/s")
        }
        JogDrive::ServoStep => "by a step of its servo".into(),
        JogDrive::ServoSine { speed_m_per_s, .. } => {
            format!("by its servo, at {:.1} mm/s", 1000.0 * speed_m_per_s)
        }
    };
    let current_a = 1.5 * servo.friction_a + servo.pull_a_per_n * settings.homing.f_max_n;
    format!(
        "motor {motor} {} its tendon by {} mm {driven}\n\
         it ends earlier at {} N in a load cell, at {current_a:.2} A for 30 ms, without counts for 0.1 s, at counts the wrong way\n\
         or of another encoder, and when it takes too long; then the motor is off\n",
        way(travel_m),
        1000.0 * travel_m.abs(),
        settings.homing.f_max_n,
    )
}

const fn way(travel_m: f32) -> &'static str {
    if travel_m < 0.0 {
        "pays out"
    } else {
        "pulls in"
    }
}

/// What it measured, and what does not fit.
#[must_use]
pub fn text(report: &JogReport<f32>, findings: &[Finding]) -> String {
    let row = |numbers: &[f32; 3], decimals: u8| {
        let digits = usize::from(decimals);
        let written = |number: f32| format!("{:.digits$}", rounded(number.into(), decimals.into()));
        numbers.map(written).join("  ")
    };
    let [before, after] = &report.tensions_n;
    let mut text = format!(
        "counts     {} mm pulled in\n\
         tensions   {} N, before {} N\n\
         current    {:.2} A\n\
         speed      {:.2} mm/s\n\
         time       {:.2} s\n\
         end        {}\n",
        row(&report.pulled_m.map(|m| 1000.0 * m), 3),
        row(after, 1),
        row(before, 1),
        report.current_a,
        1000.0 * report.speed_m_per_s,
        report.time_s,
        end(report.end),
    );
    for finding in findings {
        let _ = writeln!(text, "finding    {}: {}", finding.what, finding.remedy);
    }
    text
}

/// The same for machines.
pub fn json(report: &JogReport<f32>, findings: &[Finding]) -> impl Serialize + use<> {
    json_object! {
        motor: report.demand.motor,
        travel_m: report.demand.travel_m,
        // None where its servo drove it.
        voltage_v: voltage_v(report),
        // How it ended, in words.
        end: end(report.end),
        pulled_m: report.pulled_m,
        tensions_before_n: report.tensions_n[0],
        tensions_n: report.tensions_n[1],
        steady_s: report.steady_s,
        current_a: report.current_a,
        speed_m_per_s: report.speed_m_per_s,
        tension_n: report.tension_n,
        time_s: report.time_s,
        findings: findings.to_vec(),
    }
}

const fn voltage_v(report: &JogReport<f32>) -> Option<f32> {
    match report.demand.drive {
        JogDrive::Voltage(voltage_v) => Some(voltage_v),
        JogDrive::ServoStep | JogDrive::ServoSine { .. } => None,
    }
}

fn end(end: JogEnd) -> String {
    match end {
        JogEnd::Running => "it goes on".into(),
        JogEnd::Arrived => "travel reached".into(),
        JogEnd::NoCounts => "no counts".into(),
        JogEnd::WrongWay => "counts the wrong way".into(),
        JogEnd::OtherEncoder(number) => format!("encoder {number} counted"),
        JogEnd::Tension(number) => format!("tension in load cell {number}"),
        JogEnd::Current => "too much current".into(),
        JogEnd::Time => "too slow".into(),
        JogEnd::CutOff => "cut off by a fault, a stop or the silence of the host".into(),
    }
}

/// Something that does not fit, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// What does not fit.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

impl Finding {
    fn new(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            remedy: remedy.into(),
        }
    }
}

/// What does not fit in a report: none where the motor did what it should.
#[must_use]
pub fn findings(report: &JogReport<f32>, settings: &Settings) -> Vec<Finding> {
    let found = end_finding(report, settings);
    found.into_iter().chain(tension_finding(report)).collect()
}

/// What does not fit in how it ended.
#[must_use]
pub fn end_finding(report: &JogReport<f32>, settings: &Settings) -> Option<Finding> {
    let motor = report.demand.motor;
    let stands = matches!(report.end, JogEnd::NoCounts | JogEnd::Time);
    if stands && let Some(finding) = too_low(report, settings) {
        return Some(finding);
    }
    Some(match report.end {
        // What a monitor ended before the jog itself did.
        JogEnd::CutOff if report.time_s > JOG_RISE_S / 2.0 && counted_m(report) == 0.0 => {
            no_counts(report, settings)
        }
        JogEnd::Running | JogEnd::Arrived | JogEnd::CutOff => return None,
        JogEnd::NoCounts => no_counts(report, settings),
        JogEnd::WrongWay => Finding::new(
            format!("motor {motor} counts the wrong way"),
            format!(
                "if its tendon did the other thing than was asked, swap the wires of the motor; if it did the right thing, \
                 let entry {motor} of `counts_sign` in `[calibration]` be the other sign"
            ),
        ),
        JogEnd::OtherEncoder(other) => Finding::new(
            format!("encoder {other} counted when motor {motor} was driven"),
            format!("interchange motors {motor} and {other}, or their encoders"),
        ),
        JogEnd::Tension(cell) => Finding::new(
            format!("load cell {cell} shows more than a jog may pull"),
            "pay the tendon out first: a negative travel; see that nothing pulls at the leg",
        ),
        JogEnd::Current if voltage_v(report).is_none() => Finding::new(
            format!(
                "the servo of motor {motor} draws more than friction and the tension of homing ask for: it rings, or its screw is stiff"
            ),
            SERVO_REMEDY,
        ),
        JogEnd::Current => Finding::new(
            format!("motor {motor} draws more than friction and the tension of homing ask for"),
            "look for a stiff screw or a taut tendon whose load cell shows nothing; see friction_nm in `[actuator]`",
        ),
        JogEnd::Time => Finding::new(
            format!("motor {motor} turns more slowly than it should"),
            "give a higher voltage; look for a stiff screw",
        ),
    })
}

/// A voltage that friction takes: nothing is wrong with the motor.
fn too_low(report: &JogReport<f32>, settings: &Settings) -> Option<Finding> {
    let motor = report.demand.motor;
    let servo = servo_of(motor, settings);
    let friction_v = servo.resistance_ohm * servo.friction_a;
    let low_v = voltage_v(report).filter(|&voltage_v| voltage_v < friction_v)?;
    Some(Finding::new(
        format!("{low_v:.2} V do not turn motor {motor}: less than its friction takes"),
        format!("give {:.1} V", slow_voltage_v(motor, settings)),
    ))
}

/// How far the motor's own encoder counted, m.
fn counted_m(report: &JogReport<f32>) -> f32 {
    let own = usize::from(report.demand.motor).checked_sub(1);
    let counted = own.and_then(|own| report.pulled_m.get(own));
    counted.copied().unwrap_or_default()
}

/// Three causes, by the current.
fn no_counts(report: &JogReport<f32>, settings: &Settings) -> Finding {
    let motor = report.demand.motor;
    let servo = servo_of(motor, settings);
    // A servo gives a motor that stands all that it may.
    let stalled_a = voltage_v(report).map_or(servo.current_a, |voltage_v| {
        let risen = (report.time_s / JOG_RISE_S).min(1.0);
        risen * voltage_v / servo.resistance_ohm
    });
    let drawn_a = report.current_a.abs();
    if drawn_a < 0.1 * stalled_a.min(servo.friction_a) {
        Finding::new(
            format!("motor {motor} draws no current"),
            "look for an open wire of the motor, and whether its driver is enabled",
        )
    } else if drawn_a > 0.6 * stalled_a {
        Finding::new(
            format!("motor {motor} draws current and does not turn"),
            "look for a jam; give a higher voltage if its friction is high",
        )
    } else {
        Finding::new(
            format!("motor {motor} draws the current of a motor that turns, and counts nothing"),
            "look at its encoder's wires and supply",
        )
    }
}

/// What does not fit in how the tensions changed: that of the tendon goes the way that its motor turns.
#[must_use]
pub fn tension_finding(report: &JogReport<f32>) -> Option<Finding> {
    // A motor that turned another way, or another motor, shows nothing of the cells.
    if matches!(report.end, JogEnd::WrongWay | JogEnd::OtherEncoder(_)) {
        return None;
    }
    let own = usize::from(report.demand.motor).checked_sub(1)?;
    let sign = report.demand.travel_m.signum();
    let [before, after] = &report.tensions_n;
    let rises: [f32; 3] = std::array::from_fn(|i| sign * (after[i] - before[i]));
    let rise = *rises.get(own)?;
    let (other, most) = (1..)
        .zip(rises)
        .filter(|&(number, _)| number != own + 1)
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    let motor = report.demand.motor;
    if rise < -CHANGE_MIN_N {
        return Some(Finding::new(
            if sign > 0.0 {
                format!("load cell {motor} shows less where its tendon pulls more")
            } else {
                format!("load cell {motor} shows more where its tendon pulls less")
            },
            "swap the signal wires of the load cell",
        ));
    }
    (most > CHANGE_MIN_N && rise < OWN_PART * most).then(|| {
        Finding::new(
            format!("load cell {other} shows what tendon {motor} pulls"),
            format!(
                "jog motor {other}: if load cell {motor} shows what its tendon pulls, interchange the two; else look at the wires of load \
                 cell {motor}"
            ),
        )
    })
}
