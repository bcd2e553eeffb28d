//! `leg settings`.

use crate::connection::{ConnectionArgs, Purpose};
use crate::options::Options;
use crate::output::{load_rig, note, print, write};
use clap::Subcommand;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::json_object;
use leg_base::tick_time::seconds;
use leg_firmware::host_link::ResetCause;
use leg_firmware::recorder::TRIPLES_MAX;
use leg_firmware::settings::{Settings, SignalSet};
use leg_host::operator::{Operator, SettingDifference, setting_differences};
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;
use leg_rig::{number, settings_text};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Reads, replaces, saves and compares the settings of a board: mechanism, calibration, gains and limits.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    action: SettingsAction,
}

#[derive(Debug, Subcommand)]
enum SettingsAction {
    /// Prints the settings in use as a rig file that gives the same bits again; with --json in SI units.
    Get {
        /// The file to write; standard output if left out.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
        #[command(flatten)]
        connection: ConnectionArgs,
    },
    /// Replaces the settings by those of a rig file, reads them back and compares. The leg must be disarmed, and homed
    /// afterwards.
    Set {
        /// The rig file or a ready rig's name.
        #[arg(long, value_name = "FILE")]
        rig: PathBuf,
        /// Keeps the settings over a reset.
        #[arg(long)]
        save: bool,
        #[command(flatten)]
        connection: ConnectionArgs,
    },
    /// Keeps the settings in use over a reset. The leg must be disarmed.
    Save {
        #[command(flatten)]
        connection: ConnectionArgs,
    },
    /// Compares the settings in use with those of a rig file. Exit code 1 if they differ.
    Diff {
        /// The rig file or a ready rig's name.
        #[arg(long, value_name = "FILE")]
        rig: PathBuf,
        #[command(flatten)]
        connection: ConnectionArgs,
    },
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let open = |connection: &ConnectionArgs| -> Result<Operator, Failure> {
        let rig = RigFile::load(None)?;
        Ok(connection.open(&rig, Purpose::Use, options)?.operator)
    };
    match &args.action {
        SettingsAction::Get { out, connection } => {
            get(&mut open(connection)?, out.as_deref(), options)
        }
        SettingsAction::Set {
            rig,
            save,
            connection,
        } => {
            let settings = load_settings(rig)?;
            set(&mut open(connection)?, &settings, *save, options)
        }
        SettingsAction::Save { connection } => {
            let kept = keep(&mut open(connection)?)?;
            options.report(&json_object! { kept: kept }, || kept_text(kept).into())
        }
        SettingsAction::Diff { rig, connection } => {
            let settings = load_settings(rig)?;
            diff(&mut open(connection)?, &settings, options)
        }
    }
}

/// The settings of a board that a rig file gives.
fn load_settings(rig: &Path) -> Result<Settings, Failure> {
    let rig = load_rig(Some(rig))?;
    Ok(control_settings::settings(&rig, &rig.gains, None))
}

fn get(operator: &mut Operator, out: Option<&Path>, options: Options) -> Result<(), Failure> {
    let settings = operator.settings()?;
    let text = if options.json {
        to_line(&settings)?
    } else {
        settings_text::rig_file(&settings)
    };
    write(out, &text)
}

/// What to know of a recorder with so many signals that it keeps them for less time than the default ones.
fn short_recording(recorded: SignalSet) -> Option<String> {
    let kept_ms = |signals: usize| {
        let rows = TRIPLES_MAX.checked_div(signals)?;
        Some(1000.0 * seconds(rows as u64))
    };
    let (signals, usual) = (recorded.len(), SignalSet::default().len());
    let (short_ms, usual_ms) = kept_ms(signals).zip(kept_ms(usual))?;
    (signals > usual).then(|| {
        format!("leg: the board's recorder keeps {signals} signals for {short_ms:.0} ms, {usual} for {usual_ms:.0} ms")
    })
}

fn kept_text(kept: bool) -> &'static str {
    if kept {
        "kept over a reset\n"
    } else {
        "taken; an emulated board is never reset, and keeps nothing when it ends\n"
    }
}

fn set(
    operator: &mut Operator,
    settings: &Settings,
    save: bool,
    options: Options,
) -> Result<(), Failure> {
    operator.set_settings(settings)?;
    if !options.json {
        // Printed before the settings are kept, which may fail.
        print("set, read back and found the same\n")?;
    }
    if let Some(short) = short_recording(settings.recorded) {
        note(&short);
    }
    let kept = if save { Some(keep(operator)?) } else { None };
    let next = next_step(operator)?;
    let json = json_object! {
        verified: true,
        saved: kept.map(|kept| json_object! { kept: kept }),
        next: next,
    };
    options.report(&json, || format!("{}{next}\n", kept.map_or("", kept_text)))
}

/// Saves the settings on the board; returns whether they outlast a reset.
fn keep(operator: &mut Operator) -> Result<bool, Failure> {
    operator.save_settings()?;
    Ok(operator.identity().reset != ResetCause::Emulated)
}

/// What has to be done before a leg with new settings is armed.
pub(crate) fn next_step(operator: &mut Operator) -> Result<&'static str, Failure> {
    let faults = operator.telemetry()?.telemetry.faults.stopping();
    Ok(if faults.any() {
        "end its faults and home the leg before it is armed: `leg clear`, then `leg home`"
    } else {
        "home the leg before it is armed: `leg home`"
    })
}

fn diff(operator: &mut Operator, settings: &Settings, options: Options) -> Result<(), Failure> {
    let found = setting_differences(settings, &operator.settings()?);
    options.report(&found, || table(&found))?;
    if found.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(
        format!("{} settings differ", found.len()),
        "replace those of the board with `leg settings set`",
    ))
}

fn table(found: &[SettingDifference]) -> String {
    if found.is_empty() {
        return "the board is set as the file says\n".into();
    }
    let rows: String = found
        .iter()
        .map(|difference| {
            let [ours, theirs] = [&difference.ours, &difference.theirs].map(value_text);
            format!("{:<44} {ours:>14} {theirs:>14}\n", difference.name)
        })
        .collect();
    format!("{:<44} {:>14} {:>14}\n{rows}", "setting", "file", "board")
}

fn value_text(value: &Option<Value>) -> String {
    match value {
        None => "-".into(),
        Some(Value::String(text)) => text.clone(),
        // The shortest decimal of an f32: a JSON number has more digits.
        Some(Value::Number(number)) => number
            .as_f64()
            .map_or_else(|| number.to_string(), |value| number::exact(value as f32)),
        Some(value) => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::short_recording;
    use leg_firmware::settings::{RECORDED_SIGNALS, SignalSet};

    #[test]
    fn more_signals_than_usual_are_kept_for_less_time_which_is_said() {
        assert_eq!(short_recording(SignalSet::default()), None);
        assert_eq!(short_recording(SignalSet::NONE), None);
        let said = short_recording(SignalSet::new(&RECORDED_SIGNALS));
        let expected = "leg: the board's recorder keeps 8 signals for 75 ms, 3 for 200 ms";
        assert_eq!(said.as_deref(), Some(expected));
    }
}
