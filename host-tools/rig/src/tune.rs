//! What a leg's motors, gears and tendons are, measured by the leg itself: `leg tune`, and the window.
//!
//! [`measure_motor`] jogs one motor of a disarmed leg, without a tension and against one; [`measure_swing`] homes the leg and lets
//! it swing a little at several pretensions. [`comparison`] sets what was found beside what a rig file says, and [`section`] writes
//! it as a part of one. They ask a [`TunedLeg`], which is whatever host there is, and wait for it as it waits.

mod comparison;
mod error;
mod estimate;
mod jog_plan;
mod jogs;
mod motor;
mod play;
mod ring;
mod servo;
mod stretch;
mod swing;
mod tuned_leg;

pub use comparison::{ComparisonRow, certain_values, comparison, section, table};
pub use error::{LegError, TuneError};
pub use estimate::UncertainValue;
pub use jog_plan::JogPlan;
pub use jogs::Jogged;
pub use motor::MotorConstants;
pub use play::Travels;
pub use ring::Ring;
pub use servo::{MeasuredServo, configured_servo};
pub use swing::{Swing, SwingPlan, Swings, measure_swing};
pub use tuned_leg::TunedLeg;

use leg_base::jog_report::Finding;
use leg_firmware::settings::Settings;

/// One motor, as it was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredMotor {
    /// Its number, from 1.
    pub motor: u8,
    /// What it is.
    pub constants: MotorConstants,
    /// How its servo follows; none where that ended before it was measured.
    pub servo: Option<MeasuredServo>,
    /// What is wrong with the servo.
    pub servo_finding: Option<Finding>,
    /// The jogs from which that follows.
    pub jogs: Vec<Jogged>,
}

impl MeasuredMotor {
    /// What its load cell shows without a tension, N.
    #[must_use]
    pub fn slack_n(&self) -> f64 {
        motor::slack_n(&self.jogs)
    }
}

/// Jogs a motor of a disarmed leg by the plan, calls `seen` after each jog that counts, and leaves the tendon where it was.
///
/// # Errors
/// A [`TuneError`]: whatever ends a jog but its travel and the tension. The motor is off then. Where the motor obeyed, the tendon
/// is paid out to where it was all the same; else the error says how far it is from there.
pub async fn measure_motor<L: TunedLeg>(
    leg: &mut L,
    plan: &JogPlan,
    settings: &Settings,
    seen: &mut dyn FnMut(&Jogged),
) -> Result<MeasuredMotor, TuneError<L::Error>> {
    let (jogs, servo) = jogs::jog_all(leg, plan, settings, seen).await?;
    let (servo, servo_finding) = match servo {
        Ok(servo) => (Some(servo.clone()), servo.finding(plan.motor)),
        Err(finding) => (None, Some(finding)),
    };
    let own = usize::from(plan.motor).saturating_sub(1);
    let axis = settings.axes.get(own);
    let current_step_a = axis.map_or(0.0, |axis| f64::from(axis.current_a_per_code));
    Ok(MeasuredMotor {
        motor: plan.motor,
        constants: MotorConstants::fit(&jogs, current_step_a)?,
        servo,
        servo_finding,
        jogs,
    })
}

/// What is said before anything moves.
#[must_use]
pub fn plan_text(jogs: &JogPlan, swing: Option<&SwingPlan>) -> String {
    let [low_v, high_v] = jogs.voltages_v;
    let [low_hz, high_hz] = jogs.servo.range_hz();
    let [out_mm, in_mm] = jogs.reach_m().map(|reach_m| 1000.0 * reach_m);
    let mut text = format!(
        "motor {} turns slowly both ways, from {low_v:.2} V to {high_v:.2} V: it pays out by up to {out_mm:.0} mm, until its tendon is slack,\n\
         reels in by up to {in_mm:.0} mm, until that pulls, ends a jog where a load cell shows more than {} N, and goes back;\n\
         slack, its servo makes steps of {:.2} mm and turns it at {:.1} mm/s with a sine of {:.2} V added, from {} to {} Hz\n",
        jogs.motor,
        jogs.tension_max_n,
        1000.0 * jogs.servo.step_m,
        1000.0 * jogs.servo.speed_m_per_s,
        jogs.servo.sine_v,
        low_hz,
        high_hz,
    );
    if let Some(swing) = swing {
        text += &swing_text(swing);
    }
    text
}

fn swing_text(swing: &SwingPlan) -> String {
    let levels: Vec<_> = swing.levels_n.iter().map(|n| format!("{n:.0}")).collect();
    let play = swing.travels_n.map_or_else(
        || "its range of pretensions is too small to find play and stretch".into(),
        |[low_n, high_n]| {
            format!("its pretension goes up and down between {low_n:.0} and {high_n:.0} N")
        },
    );
    format!(
        "the leg is homed if it is not; {play};\n\
         at pretensions of {} N it begins to lean by {:.0}°, is stopped half way and swings on its screws; it is held then\n",
        levels.join(", "),
        swing.tilt_deg,
    )
}
