//! The command line `leg`, one file a command.

mod board;
mod board_notice;
mod calibrate;
mod check;
mod clear;
mod cost;
mod cost_image;
mod curve;
mod curve_charts;
mod curve_report;
mod disarm;
mod emulate;
mod eval;
mod evaluator;
mod export;
mod faults;
mod flash;
mod go;
mod hold;
mod home;
mod leg_args;
mod leg_told;
mod line;
mod log;
mod map;
mod map_report;
mod monitor;
mod numbers;
mod paper;
mod progress;
mod replay;
mod rig;
mod run;
mod run_errors;
mod run_report;
mod sensors;
mod settings;
mod setup;
mod stiffness;
mod stop;

use clap::{Parser, Subcommand};
use leg_base::failure::Failure;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

/// The tendon-driven leg on your desk: its model, and its firmware under an emulator.
#[derive(Debug, Parser)]
#[command(name = "leg", bin_name = "leg", version, after_help = EXIT_CODES)]
struct Cli {
    /// Shows the log of the firmware under QEMU on standard error.
    #[arg(short, long, global = true)]
    verbose: bool,
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  everything held
  1  something was checked and did not hold
  2  bad input, or something needed is missing";

#[derive(Debug, Subcommand)]
enum Command {
    Calibrate(calibrate::Args),
    Check(check::Args),
    Clear(clear::Args),
    Cost(cost::Args),
    Curve(curve::Args),
    Disarm(disarm::Args),
    Emulate(emulate::Args),
    Eval(eval::Args),
    Export(export::Args),
    Faults(faults::Args),
    Flash(flash::Args),
    Hold(hold::Args),
    Home(home::Args),
    Log(log::Args),
    Map(map::Args),
    Monitor(monitor::Args),
    Move(go::Args),
    Paper(paper::Args),
    Replay(replay::Args),
    Rig(rig::Args),
    Run(run::Args),
    Sensors(sensors::Args),
    Settings(settings::Args),
    /// Installs what the other commands need: the Rust target, QEMU, and the firmware built for it.
    ///
    /// The other commands do the same on their first use.
    Setup,
    Stiffness(stiffness::Args),
    Stop(stop::Args),
}

/// Runs the command of this process's arguments and tells its failure on standard error.
#[must_use]
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let ended = match &cli.command {
        Command::Calibrate(args) => calibrate::run(args, cli.verbose),
        Command::Check(args) => check::run(args, cli.verbose),
        Command::Clear(args) => clear::run(args, cli.verbose),
        Command::Cost(args) => cost::run(args, cli.verbose),
        Command::Curve(args) => curve::run(args),
        Command::Disarm(args) => disarm::run(args, cli.verbose),
        Command::Emulate(args) => emulate::run(args, cli.verbose),
        Command::Eval(args) => eval::run(args, cli.verbose),
        Command::Export(args) => export::run(args),
        Command::Faults(args) => faults::run(args),
        Command::Flash(args) => flash::run(args),
        Command::Hold(args) => hold::run(args, cli.verbose),
        Command::Home(args) => home::run(args, cli.verbose),
        Command::Log(args) => log::run(args, cli.verbose),
        Command::Map(args) => map::run(args),
        Command::Monitor(args) => monitor::run(args, cli.verbose),
        Command::Move(args) => go::run(args, cli.verbose),
        Command::Paper(args) => paper::run(args),
        Command::Replay(args) => replay::run(args),
        Command::Rig(args) => rig::run(args),
        Command::Run(args) => run::run(args, cli.verbose),
        Command::Sensors(args) => sensors::run(args, cli.verbose),
        Command::Settings(args) => settings::run(args, cli.verbose),
        Command::Setup => setup::run(),
        Command::Stiffness(args) => stiffness::run(args, cli.verbose),
        Command::Stop(args) => stop::run(args, cli.verbose),
    };
    match ended {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{}", failure.render(io::stderr().is_terminal()));
            failure.exit_code()
        }
    }
}

/// Writes to standard output.
fn print(text: &str) -> Result<(), Failure> {
    let written = io::stdout().lock().write_all(text.as_bytes());
    written.map_err(not_printed)
}

/// Standard output does not take more.
fn not_printed(error: io::Error) -> Failure {
    let help = "see that the program that reads the output is still there";
    Failure::refused(format!("cannot write to standard output: {error}"), help)
}
