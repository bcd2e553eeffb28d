//! `leg tune`.

mod charts;

use crate::calibrate::confirm;
use crate::connection::{ConnectionArgs, Purpose};
use crate::options::Options;
use crate::output::{chart_line, load_rig, note, print, write};
use crate::progress;
use indicatif::ProgressBar;
use leg_base::description;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_base::paths::relative_path;
use leg_firmware::settings::Settings;
use leg_host::operator::{Operator, OperatorError, setting_differences};
use leg_host::tune::{measure_motor, measure_swing, supply_v};
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use leg_rig::tune::{
    ComparisonRow, JogPlan, Jogged, MeasuredMotor, Swing, SwingPlan, Swings, comparison, plan_text,
    section, table,
};
use std::path::{Path, PathBuf};

/// Measures one motor and the swing of the leg, and prints what was measured beside what the rig file says.
///
/// The leg must be disarmed and hang free, without a payload. One motor is jogged both ways, without a tension and against one:
/// resistance, torque constant, friction, pull. Its servo makes steps, and is swept from 8 to 500 Hz: its margins. Then the leg is homed and swings a little at three pretensions: play of the gears,
/// stretch of the tendons, first mode, inertia. It says before what it will do, and asks on a real leg. Any fault, counts the wrong
/// way and Ctrl-C end it with the motors off or held, and nothing is written; what the jogs measured until then is printed.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The motor.
    #[arg(value_name = "MOTOR", value_parser = clap::value_parser!(u8).range(1..=3))]
    motor: u8,
    /// Jogs the motor alone: the leg is not homed, and does not swing.
    #[arg(long)]
    jogs_only: bool,
    /// Does not ask before a real leg moves.
    #[arg(long)]
    yes: bool,
    /// Writes what was measured as sections of a rig file; refuses a file that exists.
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Draws the measured points and the curves through them, SVG, PNG and PDF.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// The rig file or the name of a ready rig with which the leg is compared, that of an emulated leg too; the paper's rig if
    /// left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    #[command(flatten)]
    connection: ConnectionArgs,
}

/// What ends it before its time.
const ENDINGS: &str = "any fault, Ctrl-C and `leg stop` end it: the motors are off or held then, and nothing is written\n";

/// All that was measured.
struct Measured {
    motor: MeasuredMotor,
    swings: Option<Swings>,
}

impl Measured {
    fn rows(&self, rig: &RigFile) -> Vec<ComparisonRow> {
        comparison(&self.motor, self.swings.as_ref(), rig)
    }
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    require_absent(args.write.as_deref())?;
    if !args.jogs_only && args.connection.is_can() {
        return Err(Failure::refused(
            "the swing of a leg cannot be measured on CAN: it carries no stream of telemetry",
            "use the serial port, or give --jogs-only",
        ));
    }
    let rig = load_rig(args.rig.as_deref())?;
    let mut connection = args.connection.open(&rig, Purpose::Calibrate, options)?;
    require_disarmed(&mut connection.operator)?;
    let settings = connection.operator.settings()?;
    note_differences(&rig, &settings);
    let supply_v = supply_v(&mut connection.operator, &settings)?;
    let jogs = JogPlan::new(args.motor, &settings, supply_v);
    let swing = (!args.jogs_only).then(|| SwingPlan::new(&rig));
    if !options.json {
        print(&format!("{}{ENDINGS}", plan_text(&jogs, swing.as_ref())))?;
    }
    if !args.yes {
        let look = "see that the leg is disarmed and hangs free, keep fingers off it and your hand at the emergency stop";
        confirm(&mut connection, look)?;
    }
    let bar = progress::message();
    let motor = motor(&mut connection.operator, &jogs, &settings, &bar);
    let swings = match (&motor, &swing) {
        (Ok(_), Some(plan)) => swings(&mut connection.operator, plan, &rig, &bar).map(Some),
        _ => Ok(None),
    };
    bar.finish_and_clear();
    let motor = motor?;
    match swings {
        Ok(swings) => report(args, options, &rig, &Measured { motor, swings }),
        Err(error) => {
            // The motor may be why, as one with more friction than is configured: what it is must not be lost.
            let swings = None;
            let measured = Measured { motor, swings };
            show(options, &rig, &measured, &Saved::default())?;
            Err(error)
        }
    }
}

fn motor(
    operator: &mut Operator,
    jogs: &JogPlan,
    settings: &Settings,
    bar: &ProgressBar,
) -> Result<MeasuredMotor, Failure> {
    let seen = &mut |jogged: &Jogged| {
        bar.set_message(format!(
            "motor {}: {:+.2} V, {:+.2} mm/s, {:+.3} A",
            jogs.motor,
            jogged.voltage_v,
            1000.0 * jogged.speed_m_per_s,
            jogged.current_a
        ));
        bar.tick();
    };
    Ok(measure_motor(operator, jogs, settings, seen)?)
}

fn swings(
    operator: &mut Operator,
    plan: &SwingPlan,
    rig: &RigFile,
    bar: &ProgressBar,
) -> Result<Swings, Failure> {
    bar.set_message("the leg is homed, and its pretension changed");
    bar.tick();
    let seen = &mut |swing: &Swing| {
        let hz = swing.frequency_hz.value;
        bar.set_message(format!("{:.0} N: {hz:.2} Hz", swing.pretension_n));
        bar.tick();
    };
    Ok(measure_swing(operator, plan, rig, seen)?)
}

/// What was saved of it.
#[derive(Default)]
struct Saved {
    charts: Vec<PathBuf>,
    section: Option<PathBuf>,
}

/// Saves what was measured where it shall be, and prints it even where that cannot be.
fn report(
    args: &Args,
    options: Options,
    rig: &RigFile,
    measured: &Measured,
) -> Result<(), Failure> {
    let mut saved = Saved::default();
    let result = save(args, rig, measured, &mut saved);
    show(options, rig, measured, &saved)?;
    result
}

fn save(args: &Args, rig: &RigFile, measured: &Measured, saved: &mut Saved) -> Result<(), Failure> {
    let Measured { motor, swings } = measured;
    if let Some(file) = &args.write {
        require_absent(Some(file))?;
        write(Some(file), &section(motor.motor, &measured.rows(rig)))?;
        saved.section = Some(file.clone());
    }
    if let Some(directory) = &args.plots {
        saved.charts = charts::save(directory, motor, swings.as_ref(), rig)?;
    }
    Ok(())
}

fn show(
    options: Options,
    rig: &RigFile,
    measured: &Measured,
    saved: &Saved,
) -> Result<(), Failure> {
    let motor = &measured.motor;
    let rows = measured.rows(rig);
    let json = json_object! {
        motor: motor.motor,
        rows: &rows,
        jogs: &motor.jogs,
        servo: &motor.servo,
        servo_finding: &motor.servo_finding,
        charts: &saved.charts,
        written: &saved.section,
    };
    options.report(&json, || {
        let charts: String = saved.charts.iter().map(|svg| chart_line(svg)).collect();
        let written = saved.section.as_deref().map_or_else(
            || format!("\n{}", section(motor.motor, &rows)),
            |file| {
                format!(
                    "Sections for the rig file: {}\n",
                    relative_path(file).display()
                )
            },
        );
        // Whatever is not so ends the jogs.
        let directions = format!(
            "Motor {} counts the way that it is driven, alone, and its load cell shows what its tendon pulls.\n",
            motor.motor
        );
        let servo = motor.servo_finding.as_ref().map_or_else(String::new, |finding| {
            format!("Finding: {}: {}\n", finding.what, finding.remedy)
        });
        format!("{}{directions}{servo}{charts}{written}", table(&rows))
    })
}

/// Refuses a leg that cannot be jogged, before anybody is asked to stand by.
fn require_disarmed(operator: &mut Operator) -> Result<(), Failure> {
    let telemetry = operator.telemetry()?.telemetry;
    let faults = telemetry.faults.stopping();
    if faults.any() {
        return Err(OperatorError::Faulted("jog a motor", faults).failure());
    }
    if telemetry.state.driven() {
        return Err(Failure::refused(
            format!(
                "the leg is {}, and its motors are measured while it is disarmed",
                description::state(telemetry.state)
            ),
            "run `leg disarm` first",
        ));
    }
    Ok(())
}

/// Refuses a file that exists: what somebody measured before is not to be lost.
fn require_absent(file: Option<&Path>) -> Result<(), Failure> {
    match file {
        Some(file) if file.exists() => Err(Failure::refused(
            format!("{} exists", file.display()),
            "name another file with --write, or remove it",
        )),
        _ => Ok(()),
    }
}

/// Says where the board is set to something else than the rig file.
fn note_differences(rig: &RigFile, settings: &Settings) {
    let expected = control_settings::settings(rig, &rig.gains, None);
    let count = setting_differences(&expected, settings).len();
    if count > 0 {
        note(&format!(
            "leg: {count} settings of the board are not those of the rig file; see `leg settings diff`"
        ));
    }
}
