//! `leg emulate`.

use super::line::{Fresh, controller};
use super::numbers::seconds;
use super::print;
use super::run::On;
use leg_base::failure::Failure;
use leg_host::emulated_board::EmulatedBoard;
use leg_host::operator::Interrupt;
use leg_host::pseudo_terminal::PseudoTerminal;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::touch::Touch;
use std::io::BufRead;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// Part of the time that may be missed before the user is told.
const MISSED_PART: f64 = 0.05;

/// Emulates a board with a leg on a serial port, in real time.
///
/// It prints the path of the port: give that to --port of the other commands. It ends with Ctrl-C.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Where the firmware runs.
    #[arg(long, value_enum, default_value_t = On::Sim)]
    on: On,
    /// The rig file or the name of a ready rig; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Begins with slack tendons and has to be homed; else it is homed, hangs straight down and is disarmed.
    #[arg(long)]
    slack: bool,
    /// Ends after so many seconds.
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    length: Option<Duration>,
    /// Reads on standard input what is done to the leg, one JSON object a line: {"payload":{"kg":2,"over_s":1}},
    /// {"fault":{"driver_fault":1}}, {"repair":{"driver_fault":1}}, {"emergency_stop":true}, {"turn":{"motor":1,"turns":1}},
    /// {"hang":{"cell":1,"newtons":20}}.
    #[arg(long, verbatim_doc_comment)]
    touch: bool,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a rig that is refused, a firmware or a system that fails.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let rig = RigFile::load(args.rig.as_deref())?;
    let fresh = if args.slack {
        Fresh::Slack
    } else {
        Fresh::Homed
    };
    let leg = EmulatedLeg::new(&rig, fresh.beginning(), controller(args.on, verbose)?)
        .map_err(|error| Failure::from_error(&error))?;
    let port = PseudoTerminal::open().map_err(|error| {
        Failure::refused(
            format!("no pseudo-terminal: {error}"),
            "see that /dev/pts is mounted",
        )
    })?;
    let interrupt = Interrupt::on_ctrl_c();
    let touches = touches(args.touch);
    print(&format!("{}\n", port.path().display()))?;
    let board = EmulatedBoard::new(leg, port);
    let began = std::time::Instant::now();
    let missed = board
        .run(&interrupt, args.length, &touches)
        .map_err(|error| Failure::from_error(&error))?;
    let part = missed.as_secs_f64() / began.elapsed().as_secs_f64();
    if part > MISSED_PART {
        let percent = 100.0 * part;
        eprintln!(
            "leg: this machine is too slow for real time: the leg missed {percent:.0} % of it"
        );
    }
    Ok(())
}

/// What the user does to the leg.
fn touches(read: bool) -> Receiver<Touch> {
    let (sender, receiver) = channel();
    if read {
        std::thread::spawn(move || read_touches(&sender));
    }
    receiver
}

fn read_touches(sender: &Sender<Touch>) {
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        match Touch::parse(&line) {
            Ok(touch) => {
                if sender.send(touch).is_err() {
                    return;
                }
            }
            Err(error) => {
                eprintln!("leg: {line}: {error}; `leg emulate --help` shows what there is")
            }
        }
    }
}
