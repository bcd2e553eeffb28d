//! `leg emulate`.

use crate::board::{Emulation, new_chip};
use crate::connection::emulated_leg;
use crate::numbers::seconds;
use crate::options::Options;
use crate::output::{load_rig, note};
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::json_object;
use leg_base::text_input::{self, Line};
use leg_host::byte_port::BytePort;
use leg_host::cancel_flag::CancelFlag;
use leg_host::emulated_board::EmulatedBoard;
use leg_host::pseudo_terminal::PseudoTerminal;
use leg_host::tcp_port::TcpPort;
use leg_sim::action::Action;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// This machine alone, and a free port.
const LOOPBACK: &str = "127.0.0.1:0";

/// Part of the time that may be missed before the user is warned.
const MISSED_PART: f64 = 0.05;

/// Emulates a board with a leg on a port, in real time.
///
/// The port's name is printed: give it to --port of the other commands. Ctrl-C ends the emulation.
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
    /// Listens on TCP in the place of a serial port; on a free port of this machine if no address is given. Whoever can
    /// connect can command the leg.
    #[arg(long, value_name = "HOST:PORT", num_args = 0..=1, default_missing_value = LOOPBACK)]
    tcp: Option<String>,
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
    let port = open_port(args.tcp.as_deref())?;
    let cancel = CancelFlag::set_by_ctrl_c();
    let disturbances = disturbances(args.disturbances, options);
    let name = port.name();
    options.report(&json_object! { port: &name }, || format!("{name}\n"))?;
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

fn open_port(tcp: Option<&str>) -> Result<Box<dyn BytePort>, Failure> {
    let Some(address) = tcp else {
        let terminal = PseudoTerminal::open().map_err(|error| {
            let help = if cfg!(unix) {
                "see that /dev/pts is mounted, or give --tcp"
            } else {
                "this system has none: give --tcp"
            };
            Failure::refused(format!("no pseudo-terminal: {error}"), help)
        })?;
        return Ok(Box::new(terminal));
    };
    let port = TcpPort::listen(address).map_err(|error| {
        Failure::refused(
            format!("cannot listen on {address}: {error}"),
            "give an address of this machine and a port that is not in use, as 127.0.0.1:5000",
        )
    })?;
    Ok(Box::new(port))
}

/// What the user does to the leg, read in a thread of its own.
fn disturbances(read: bool, options: Options) -> Receiver<Action> {
    let (sender, receiver) = channel();
    if read {
        std::thread::spawn(move || read_disturbances(&sender, options));
    }
    receiver
}

fn read_disturbances(sender: &Sender<Action>, options: Options) {
    let mut input = std::io::stdin().lock();
    let mut number = 0_u64;
    loop {
        number += 1;
        let (line, action) = match text_input::next_line(&mut input) {
            Ok(None) => return,
            // Nothing that comes after it is read.
            Err(error) => {
                note(&refusal(number, &error.to_string(), options));
                return;
            }
            Ok(Some(Line::Whole(bytes))) => {
                let line = String::from_utf8_lossy(&bytes).into_owned();
                let action = Action::parse(&line);
                (line, action)
            }
            Ok(Some(Line::TooLong)) => ("a disturbance".into(), Err(text_input::too_long())),
        };
        match action {
            Ok(disturbance) => {
                if sender.send(disturbance).is_err() {
                    return;
                }
            }
            Err(error) => note(&refusal(number, &format!("{line}: {error}"), options)),
        }
    }
}

/// What is said of a disturbance that is refused. It ends nothing, so that there is no exit code.
fn refusal(line: u64, error: &str, options: Options) -> String {
    let help = "`leg emulate --help` lists the disturbances";
    if !options.json {
        return format!("leg: standard input, line {line}: {error}; {help}");
    }
    let json = json_object! { error: error, help: help, file: "standard input", line: line };
    // Strings and integers always have a form in JSON.
    to_line(&json).unwrap_or_default().trim_end().into()
}

#[cfg(test)]
mod tests {
    use super::refusal;
    use crate::options::Options;

    #[test]
    fn a_refused_disturbance_has_its_line() {
        let options = |json| Options {
            verbose: false,
            json,
        };
        let help = "`leg emulate --help` lists the disturbances";
        assert_eq!(
            refusal(3, "x: no", options(false)),
            format!("leg: standard input, line 3: x: no; {help}")
        );
        let json =
            format!(r#"{{"error":"x: no","help":"{help}","file":"standard input","line":3}}"#);
        assert_eq!(refusal(3, "x: no", options(true)), json);
    }
}
