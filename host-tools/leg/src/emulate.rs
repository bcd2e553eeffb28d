//! `leg emulate`.

use crate::board::{Emulation, new_chip};
use crate::connection::emulated_leg;
use crate::numbers::seconds;
use crate::options::Options;
use crate::output::{load_rig, note};
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_base::text_input::{self, Line};
use leg_host::cancel_flag::CancelFlag;
use leg_host::emulated_board::EmulatedBoard;
use leg_host::pseudo_terminal::PseudoTerminal;
use leg_sim::action::Action;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// Part of the time that may be missed before the user is warned.
const MISSED_PART: f64 = 0.05;

/// Emulates a board with a leg on a serial port, in real time.
///
/// The path of the port is printed: give it to --port of the other commands. Ctrl-C ends the emulation.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Where the firmware runs.
    #[arg(long, value_enum, default_value_t = Emulation::Sim)]
    on: Emulation,
    /// The rig file or the name of a ready rig; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// The leg starts with slack tendons and must be homed; without it, homed, hanging straight down and disarmed.
    #[arg(long)]
    slack: bool,
    /// A new board: it keeps no settings yet. With --on chip only.
    #[arg(long, requires = "slack")]
    new_board: bool,
    /// Ends after so many seconds.
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    length: Option<Duration>,
    /// Reads disturbances of the leg on standard input, one JSON object a line: {"payload":{"kg":2,"over_s":1}},
    /// {"fault":{"driver_fault":1}}, {"repair":{"driver_fault":1}}, {"emergency_stop":true}, {"turn":{"motor":1,"turns":1}},
    /// {"hang":{"cell":1,"newtons":20}}, {"push":{"azimuth_deg":90,"force_n":5,"for_s":1}}.
    #[arg(long, alias = "touch", verbatim_doc_comment)]
    disturbances: bool,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let rig = load_rig(args.rig.as_deref())?;
    let initial = if args.slack {
        InitialState::Slack
    } else {
        InitialState::Homed
    };
    let leg = match (args.new_board, args.on) {
        (false, Emulation::Chip) if !args.slack => {
            return Err(Failure::refused(
                "a leg on an emulated chip does not start homed: a board forgets its zero",
                "give --slack, and home it first; or take --on sim or --on qemu",
            ));
        }
        (false, on) => emulated_leg(&rig, initial, on, options)?,
        (true, Emulation::Chip) => {
            EmulatedLeg::new(&rig, initial, new_chip()?).map_err(Failure::from_error)?
        }
        (true, _) => {
            return Err(Failure::refused(
                "only a chip has a flash that can be empty",
                "take --on chip, or leave --new-board out",
            ));
        }
    };
    let port = PseudoTerminal::open().map_err(|error| {
        let help = "see that /dev/pts is mounted";
        Failure::refused(format!("no pseudo-terminal: {error}"), help)
    })?;
    let cancel = CancelFlag::on_ctrl_c();
    let disturbances = disturbances(args.disturbances);
    options.report(&json_object! { port: port.path() }, || {
        format!("{}\n", port.path().display())
    })?;
    let board = EmulatedBoard::new(leg, port);
    let started = Instant::now();
    let missed = board.run(&cancel, args.length, &disturbances)?;
    let part = missed.as_secs_f64() / started.elapsed().as_secs_f64();
    if part > MISSED_PART {
        let percent = 100.0 * part;
        note(&format!(
            "leg: this machine is too slow for real time: the leg missed {percent:.0} % of it"
        ));
    }
    Ok(())
}

/// What the user does to the leg, read in a thread of its own.
fn disturbances(read: bool) -> Receiver<Action> {
    let (sender, receiver) = channel();
    if read {
        std::thread::spawn(move || read_disturbances(&sender));
    }
    receiver
}

fn read_disturbances(sender: &Sender<Action>) {
    let mut input = std::io::stdin().lock();
    while let Ok(Some(line)) = text_input::next_line(&mut input) {
        let (line, action) = match line {
            Line::Whole(bytes) => {
                let line = String::from_utf8_lossy(&bytes).into_owned();
                let action = Action::parse(&line);
                (line, action)
            }
            Line::TooLong => ("a disturbance".into(), Err(text_input::too_long())),
        };
        match action {
            Ok(disturbance) => {
                if sender.send(disturbance).is_err() {
                    return;
                }
            }
            Err(error) => note(&format!(
                "leg: {line}: {error}; `leg emulate --help` lists the disturbances"
            )),
        }
    }
}
