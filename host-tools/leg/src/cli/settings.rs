//! `leg settings`.

use super::line::{Fresh, LineArgs};
use super::print;
use clap::Subcommand;
use leg_base::atomic_file;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_firmware::host_link::Reset;
use leg_firmware::settings::Settings;
use leg_host::operator::{Difference, Operator, differences};
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use leg_rig::settings_text;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Reads, replaces, keeps and compares what the leg's board is set to: mechanism, calibration, gains and limits.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Prints the settings in use as a rig file that gives the same bits again.
    Get {
        /// The file to write; standard output if left out.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
        /// JSON in SI units instead.
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        line: LineArgs,
    },
    /// Replaces the settings by those of a rig file, reads them back and compares. The leg has to be disarmed, and homed
    /// afterwards.
    Set {
        /// The rig file or a ready rig's name.
        #[arg(long, value_name = "FILE")]
        rig: PathBuf,
        /// Keeps them over a reset, too.
        #[arg(long)]
        save: bool,
        #[command(flatten)]
        line: LineArgs,
    },
    /// Keeps the settings in use over a reset. The leg has to be disarmed.
    Save {
        #[command(flatten)]
        line: LineArgs,
    },
    /// Says in what the settings in use differ from those of a rig file. Exit code 1 if they do.
    Diff {
        /// The rig file or a ready rig's name.
        #[arg(long, value_name = "FILE")]
        rig: PathBuf,
        /// Prints JSON instead of a table.
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        line: LineArgs,
    },
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, settings that it refuses, or settings that differ.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let open = |line: &LineArgs| {
        let opened = line.open(&RigFile::load(None)?, Fresh::Homed, verbose)?;
        Ok::<_, Failure>(opened.operator)
    };
    match &args.action {
        Action::Get { out, json, line } => get(&mut open(line)?, out.as_deref(), *json),
        Action::Set { rig, save, line } => {
            let settings = of_rig(rig)?;
            set(&mut open(line)?, &settings, *save)
        }
        Action::Save { line } => {
            let mut operator = open(line)?;
            keep(&mut operator)
        }
        Action::Diff { rig, json, line } => {
            let settings = of_rig(rig)?;
            diff(&mut open(line)?, &settings, *json)
        }
    }
}

/// What a rig file sets a board to.
fn of_rig(rig: &Path) -> Result<Settings, Failure> {
    let rig = RigFile::load(Some(rig))?;
    Ok(control_settings::settings(&rig, &rig.gains, None))
}

fn get(operator: &mut Operator, out: Option<&Path>, json: bool) -> Result<(), Failure> {
    let settings = operator.settings()?;
    let text = if json {
        to_line(&settings)?
    } else {
        settings_text::rig_file(&settings)
    };
    match out {
        None => print(&text),
        Some(file) => {
            atomic_file::replace(file, |new| std::fs::write(new, &text)).map_err(|error| {
                let help = "name a file in a directory that may be written";
                Failure::refused(format!("cannot write {}: {error}", file.display()), help)
            })
        }
    }
}

fn set(operator: &mut Operator, settings: &Settings, save: bool) -> Result<(), Failure> {
    operator.set_settings(settings)?;
    print("set, read back and found the same\n")?;
    if save {
        keep(operator)?;
    }
    print(&format!("{}\n", before_armed(operator)?))
}

fn keep(operator: &mut Operator) -> Result<(), Failure> {
    operator.save_settings()?;
    print(match operator.identity().reset {
        Reset::Emulated => {
            "taken; an emulated board is never reset, and keeps nothing when it ends\n"
        }
        _ => "kept over a reset\n",
    })
}

/// What has to be done before a leg with new settings is armed.
pub(super) fn before_armed(operator: &mut Operator) -> Result<&'static str, Failure> {
    let faults = operator.telemetry()?.telemetry.faults.without_limits();
    Ok(if faults.any() {
        "end its faults and home the leg before it is armed: `leg clear`, then `leg home`"
    } else {
        "home the leg before it is armed: `leg home`"
    })
}

fn diff(operator: &mut Operator, settings: &Settings, json: bool) -> Result<(), Failure> {
    let found = differences(settings, &operator.settings()?);
    print(&if json {
        to_line(&found)?
    } else {
        table(&found)
    })?;
    if found.is_empty() {
        return Ok(());
    }
    Err(Failure::missed(
        format!("{} settings differ", found.len()),
        "replace those of the board with `leg settings set`",
    ))
}

fn table(found: &[Difference]) -> String {
    if found.is_empty() {
        return "the board is set as the file says\n".into();
    }
    let rows: String = found
        .iter()
        .map(|difference| {
            let [ours, theirs] = [&difference.ours, &difference.theirs].map(value_words);
            format!("{:<44} {ours:>14} {theirs:>14}\n", difference.name)
        })
        .collect();
    format!("{:<44} {:>14} {:>14}\n{rows}", "setting", "file", "board")
}

fn value_words(value: &Option<Value>) -> String {
    match value {
        None => "-".into(),
        Some(Value::String(text)) => text.clone(),
        // The shortest decimal of an f32, which a JSON number does not tell.
        Some(Value::Number(number)) => number.as_f64().map_or_else(
            || number.to_string(),
            |value| settings_text::number(value as f32),
        ),
        Some(value) => value.to_string(),
    }
}
