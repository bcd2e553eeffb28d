//! The command `leg`: parses the command line, calls the crates below, prints reports and errors.
//!
//! [`main`] is the program; [`command`] is its command line for completions, manual pages and tests. Every command is
//! one file with `Args` (their doc comments are the help text) and `run(&Args, Options) -> Result<(), Failure>`:
//!
//! | file | commands |
//! |---|---|
//! | `run`, `replay` | a simulated leg through a scenario; a recording again |
//! | `eval`, `check`, `cost`, `paper` | the model at poses; accuracy; instructions and memory; the paper's numbers |
//! | `map`, `curve`, `export`, `rig` | maps of the workspace; tendon curves; MuJoCo; rig files |
//! | `leg_commands` | `home`, `move`, `stiffness`, `hold`, `stop`, `disarm`, `clear` |
//! | `jog`, `tune` | one motor of a disarmed leg, turned; measured, with the swing of the leg |
//! | `sensors`, `monitor`, `log`, `settings`, `calibrate` | what a leg reports, records and is set to |
//! | `moves` | how the true tip of a simulated leg goes, with payloads that it does not know |
//! | `bode` | margins of the feedback loops around a simulated leg |
//! | `strikes` | faults that strike a simulated leg in every state |
//! | `emulate`, `flash`, `faults` | an emulated board; the image into a board; the fault table |
//! | `board` | `setup`; links to the firmware in this process and under QEMU |
//! | `ui` | the window, in a browser |
//! | `completions`, `man` | for the shell and for `man` |
//!
//! The commands share `options` (`--verbose`, `--json`), `output` (printing and files), `connection` (a leg on a port,
//! on CAN or emulated), `numbers` (checked numbers) and `progress`.
//!
//! # A new command
//! 1. Write its file, with its `Args` and `run`; print through `Options::report`, which takes what `--json`
//!    prints, mostly a `json_object!`, and the text for people.
//! 2. Add it to `Command` and to the `match` in `run` of this file, and to the table above.
//! 3. Add its help text to `tests/command_line/help.trycmd` and a transcript of its work beside it.
//!
//! ```
//! let leg = leg_cli::command();
//! let run = leg.find_subcommand("run").and_then(|run| run.get_about());
//! assert!(run.is_some());
//! ```

mod board;
mod bode;
mod calibrate;
mod check;
mod completions;
mod connection;
mod cost;
mod curve;
mod emulate;
mod eval;
mod export;
mod faults;
mod flash;
mod jog;
mod leg_commands;
mod log;
mod man;
mod map;
mod monitor;
mod moves;
mod notices;
mod numbers;
mod options;
mod output;
mod paper;
mod plot;
mod progress;
mod replay;
mod rig;
mod run;
mod scope;
mod sensors;
mod settings;
mod strikes;
mod tune;
mod ui;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use leg_base::failure::Failure;
use leg_commands::LegCommand;
use options::Options;
use std::ffi::OsString;
use std::process::ExitCode;

/// Models, simulates and commands a tendon-driven leg, and checks its firmware without a board.
#[derive(Debug, Parser)]
#[command(name = "leg", bin_name = "leg", version, after_help = EXIT_CODES, next_display_order = None)]
struct Cli {
    #[command(flatten)]
    options: Options,
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  passed
  1  checked and failed
  2  bad input or a missing prerequisite

`leg completions` and `leg man` write shell completions and manual pages.";

#[derive(Debug, Subcommand)]
enum Command {
    Bode(bode::Args),
    Calibrate(calibrate::Args),
    /// Checks the firmware under QEMU: its f32 against f64, and its bits against f32 on the host.
    ///
    /// A grid and a random sample of the workspace of the paper's rig go through every kernel and the whole evaluation.
    Check,
    Completions(completions::Args),
    Cost(cost::Args),
    Curve(curve::Args),
    Emulate(emulate::Args),
    Eval(eval::Args),
    Export(export::Args),
    /// Prints the fault table: what each fault is, what raises it, what it leads to and how it ends.
    Faults,
    Flash(flash::Args),
    Jog(jog::Args),
    #[command(flatten)]
    Leg(LegCommand),
    Log(log::Args),
    Man(man::Args),
    Map(map::Args),
    Monitor(monitor::Args),
    Paper(paper::Args),
    Plot(plot::Args),
    Replay(replay::Args),
    Rig(rig::Args),
    Run(run::Args),
    Scope(scope::Args),
    Sensors(sensors::Args),
    Settings(settings::Args),
    /// Installs what the other commands and the tests need: the Rust target, QEMU, and the firmware built for it.
    ///
    /// The other commands do the same on their first use, as far as they need it.
    Setup,
    Moves(moves::Args),
    Strikes(strikes::Args),
    Tune(tune::Args),
    Ui(ui::Args),
}

/// The command line as clap describes it.
#[must_use]
pub fn command() -> clap::Command {
    negative_values(Cli::command())
}

/// Takes a negative number as a value everywhere, which is refused by its range, and not as an option that is not known.
fn negative_values(command: clap::Command) -> clap::Command {
    let command = command.mut_args(|arg| {
        let takes_values = arg.get_action().takes_values();
        arg.allow_negative_numbers(takes_values)
    });
    command.mut_subcommands(negative_values)
}

/// An argument, with a zero before the point of a negative number: without one clap takes it for an option.
fn with_zero(argument: OsString) -> OsString {
    let decimals = argument.to_str().and_then(|text| text.strip_prefix("-."));
    match decimals {
        Some(decimals) if decimals.starts_with(|first: char| first.is_ascii_digit()) => {
            format!("-0.{decimals}").into()
        }
        _ => argument,
    }
}

/// Runs the command that this process's arguments name, and prints its error on standard error.
#[must_use]
pub fn main() -> ExitCode {
    #[cfg(unix)]
    survive_file_size_limit();
    let arguments = std::env::args_os().map(with_zero);
    let matches = command().try_get_matches_from(arguments);
    let cli = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => return output::usage(&error),
    };
    match run(&cli.command, cli.options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::print_failure(&failure, cli.options.json);
            failure.exit_code()
        }
    }
}

/// Where a file would become larger than `ulimit -f` allows, the write fails, and its error names the file: the signal alone would end the
/// process without a word.
#[cfg(unix)]
fn survive_file_size_limit() {
    let signal = rustix::process::Signal::XFSZ.as_raw();
    // What cannot be caught ends the process as before.
    let _ = signal_hook::flag::register(signal, std::sync::Arc::default());
}

fn run(command: &Command, options: Options) -> Result<(), Failure> {
    match command {
        Command::Bode(args) => bode::run(args, options),
        Command::Calibrate(args) => calibrate::run(args, options),
        Command::Check => check::run(options),
        Command::Completions(args) => completions::run(args),
        Command::Cost(args) => cost::run(args, options),
        Command::Curve(args) => curve::run(args, options),
        Command::Emulate(args) => emulate::run(args, options),
        Command::Eval(args) => eval::run(args, options),
        Command::Export(args) => export::run(args),
        Command::Faults => faults::run(options),
        Command::Flash(args) => flash::run(args, options),
        Command::Jog(args) => jog::run(args, options),
        Command::Leg(command) => command.run(options),
        Command::Log(args) => log::run(args, options),
        Command::Man(args) => man::run(args),
        Command::Map(args) => map::run(args, options),
        Command::Monitor(args) => monitor::run(args, options),
        Command::Paper(args) => paper::run(args, options),
        Command::Plot(args) => plot::run(args, options),
        Command::Replay(args) => replay::run(args, options),
        Command::Rig(args) => rig::run(args, options),
        Command::Run(args) => run::run(args, options),
        Command::Scope(args) => scope::run(args, options),
        Command::Sensors(args) => sensors::run(args, options),
        Command::Settings(args) => settings::run(args, options),
        Command::Setup => board::setup(options),
        Command::Moves(args) => moves::run(args, options),
        Command::Strikes(args) => strikes::run(args, options),
        Command::Tune(args) => tune::run(args, options),
        Command::Ui(args) => ui::run(args, options),
    }
}

#[cfg(test)]
mod tests {
    use super::with_zero;

    #[test]
    fn a_negative_number_needs_no_zero_before_its_point() {
        for (given, taken) in [
            ("-.5", "-0.5"),
            ("-0.5", "-0.5"),
            (".5", ".5"),
            ("-.", "-."),
            ("-.toml", "-.toml"),
        ] {
            assert_eq!(with_zero(given.into()), taken);
        }
    }
}
