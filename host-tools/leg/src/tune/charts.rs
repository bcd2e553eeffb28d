//! The charts of `leg tune`: what was measured as crosses, what follows from it as lines.

use crate::output::save_all;
use leg_base::failure::Failure;
use leg_bench::plot::bode::{self, BodeLine, BodeMargin, BodePlot, BodePoint};
use leg_bench::plot::{Chart, ChartLine};
use leg_rig::loop_response::{Margins, ResponsePoint};
use leg_rig::rig_file::RigFile;
use leg_rig::tune::{Jogged, MeasuredMotor, MeasuredServo, Swing, Swings, configured_servo};
use std::path::{Path, PathBuf};

/// Points of the line through a swing.
const LINE_POINTS: usize = 400;

/// Name of the plot of the servo.
const SERVO: &str = "servo";

/// Saves the charts in a directory; names the SVG files.
pub(super) fn save(
    directory: &Path,
    motor: &MeasuredMotor,
    swings: Option<&Swings>,
    rig: &RigFile,
) -> Result<Vec<PathBuf>, Failure> {
    let mut charts = vec![("speed", speeds(motor)), ("pull", pulls(motor))];
    if let Some(swings) = swings {
        charts.push(("swing", swing(swings)));
        charts.push(("mode", modes(swings)));
    }
    let draw = |staging: &Path| {
        for (name, chart) in &charts {
            leg_bench::plot::save(chart, &staging.join(name))?;
        }
        if let Some(measured) = &motor.servo {
            let plot = servo(motor.motor, measured, rig);
            bode::save(&plot, &staging.join(SERVO))?;
        }
        Ok(())
    };
    save_all("chart", directory, "--plots", draw, || Ok(()))?;
    let drawn = motor.servo.is_some().then_some(SERVO);
    let names = charts.iter().map(|&(name, _)| name).chain(drawn);
    Ok(names
        .map(|name| directory.join(format!("{name}.svg")))
        .collect())
}

fn chart(title: String, x_title: &str, y_title: &str, lines: Vec<ChartLine>) -> Chart {
    Chart {
        title,
        x_title: x_title.into(),
        y_title: y_title.into(),
        lines,
        marks_label: "measured".into(),
        ..Chart::default()
    }
}

/// Voltage over speed, without a tension: the line has the slope of the torque constant.
fn speeds(motor: &MeasuredMotor) -> Chart {
    let constants = &motor.constants;
    let [friction_in, friction_out] = constants.friction_a.map(|friction| friction.value);
    let resistance = constants.resistance_ohm.value;
    let slope = constants.back_emf_v_s_per_m.value + resistance * constants.viscous_a_s_per_m.value;
    let free = || motor.jogs.iter().filter(|jog| !jog.loaded);
    let lines = [
        ("pulling in", 1.0, friction_in),
        ("paying out", -1.0, friction_out),
    ];
    let line = |&(label, sign, friction_a): &(&str, f64, f64)| {
        let offset_v = resistance * friction_a + constants.driver_loss_v.value;
        let jogs: Vec<_> = free().filter(|jog| jog.voltage_v * sign > 0.0).collect();
        let fastest = jogs
            .iter()
            .map(|jog| jog.speed_m_per_s.abs())
            .fold(0.0, f64::max);
        let at = |speed: f64| (1000.0 * speed, offset_v + slope * speed);
        ChartLine {
            label: label.into(),
            points: vec![at(0.0), at(fastest)],
            marks: jogs
                .iter()
                .map(|jog| (1000.0 * jog.speed_m_per_s.abs(), jog.voltage_v.abs()))
                .collect(),
        }
    };
    chart(
        format!("Motor {} without a tension", motor.motor),
        "Speed of the tendon, mm/s",
        "Voltage, V",
        lines.iter().map(line).collect(),
    )
}

/// Current over tension, at a standstill: without the part of the viscous friction.
fn pulls(motor: &MeasuredMotor) -> Chart {
    let constants = &motor.constants;
    let slack_n = motor.slack_n();
    let tension = |jog: &Jogged| {
        if jog.loaded {
            jog.tension_n - slack_n
        } else {
            0.0
        }
    };
    let highest_n = motor.jogs.iter().map(tension).fold(0.0, f64::max);
    let line = |(label, sign, way): (&str, f64, usize)| {
        let (friction_a, pull) = (
            constants.friction_a[way].value,
            constants.pull_a_per_n[way].value,
        );
        let jogs = motor.jogs.iter().filter(|jog| jog.voltage_v * sign > 0.0);
        let still_a = |jog: &Jogged| {
            (jog.current_a - constants.viscous_a_s_per_m.value * jog.speed_m_per_s) * sign
        };
        ChartLine {
            label: label.into(),
            points: vec![
                (0.0, friction_a),
                (highest_n, friction_a + pull * highest_n),
            ],
            marks: jogs.map(|jog| (tension(jog), still_a(jog))).collect(),
        }
    };
    chart(
        format!("Motor {} against a tension", motor.motor),
        "Tension, N",
        "Current without viscous friction, A",
        vec![line(("pulling in", 1.0, 0)), line(("paying out", -1.0, 1))],
    )
}

/// The transfer of the servo's loop, with its margins, beside that of the rig file.
fn servo(motor: u8, servo: &MeasuredServo, rig: &RigFile) -> BodePlot {
    let points = |points: &[ResponsePoint]| {
        let point = |point: &ResponsePoint| BodePoint {
            hz: point.hz,
            gain_db: point.gain_db,
            phase_deg: point.phase_deg,
        };
        points.iter().map(point).collect::<Vec<_>>()
    };
    let measured = &servo.points;
    let margins = Margins::new(measured);
    let line = |name: &str, unit: &str, margin: BodeMargin| {
        let (BodeMargin::Gain(hz, value) | BodeMargin::Phase(hz, value)) = margin;
        BodeLine {
            label: vec![
                format!("measured, {name} margin"),
                format!("{value:.1} {unit} at {hz:.1} Hz"),
            ],
            points: points(measured),
            margin: Some(margin),
        }
    };
    let gain = margins.gain_hz.zip(margins.gain_db);
    let phase = margins.phase_hz.zip(margins.phase_deg);
    let named = [
        gain.map(|(hz, db)| line("gain", "dB", BodeMargin::Gain(hz, db))),
        phase.map(|(hz, deg)| line("phase", "°", BodeMargin::Phase(hz, deg))),
    ];
    BodePlot {
        title: format!("Servo of motor {motor}, broken at its voltage"),
        others_label: "by the rig file".into(),
        others: vec![points(&configured_servo(motor, rig))],
        named: named.into_iter().flatten().collect(),
    }
}

fn swing(swings: &Swings) -> Chart {
    let line = |swing: &Swing| {
        let first = swing.moments_nm.first().map_or(0.0, |point| point.0);
        let last = swing.moments_nm.last().map_or(0.0, |point| point.0);
        let step = (last - first) / LINE_POINTS as f64;
        let at = |i: usize| {
            let time = first + step * i as f64;
            (time, swing.ring.value(time))
        };
        ChartLine {
            label: format!(
                "{:.1} N: {:.2} Hz",
                swing.pretension_n, swing.frequency_hz.value
            ),
            points: (0..=LINE_POINTS).map(at).collect(),
            marks: swing.moments_nm.iter().step_by(4).copied().collect(),
        }
    };
    chart(
        "Swing of the leg on its screws".into(),
        "Time, s",
        "Moment of the tendons, N·m",
        swings.all.iter().map(line).collect(),
    )
}

fn modes(swings: &Swings) -> Chart {
    let of = |hz: fn(&Swing) -> f64| {
        swings
            .all
            .iter()
            .map(move |swing| (swing.pretension_n, hz(swing)))
    };
    chart(
        "First mode of the leg".into(),
        "Pretension, N",
        "Frequency, Hz",
        vec![ChartLine {
            label: "by the rig file".into(),
            points: of(|swing| swing.configured_hz).collect(),
            marks: of(|swing| swing.frequency_hz.value).collect(),
        }],
    )
}
