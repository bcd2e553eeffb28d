//! The line to a leg: a board's serial port, or an emulated leg.

use super::board_notice::notices;
use super::run::On;
use super::{board, progress};
use leg_base::failure::Failure;
use leg_base::words;
use leg_firmware::can::LegAddress;
use leg_firmware::telemetry::Telemetry;
use leg_host::operator::{Host, Interrupt, Operator};
use leg_host::transport::Transport;
#[cfg(target_os = "linux")]
use leg_host::transport::can::{CanTransport, SocketCan};
use leg_host::transport::emulated::Emulated;
use leg_host::transport::serial::{self, Serial, SerialError};
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{Beginning, Behind, EmulatedLeg};
use leg_sim::simulation::{Controller, InThisProcess};
use std::path::PathBuf;

/// How long the tendons of a leg that has to be homed are beyond their ways, m.
const SLACK_M: f64 = 3e-3;

/// Where the leg is.
#[derive(Debug, clap::Args)]
pub(super) struct LineArgs {
    /// A leg without a board, a fresh one for each command: homed, hanging straight down, disarmed. `leg home` and `leg
    /// calibrate` get it slack and not homed. Its time is its own: it does not wait for the clock.
    #[arg(long, value_enum)]
    on: Option<On>,
    /// The board's serial port; that of the ST-LINK if left out.
    #[arg(long, value_name = "PATH", conflicts_with = "on")]
    port: Option<String>,
    /// The CAN FD interface to which the board is connected, as `can0`: Linux only. One command at a time may talk to a leg on
    /// CAN; only `leg stop` goes beside another.
    #[arg(long, value_name = "INTERFACE", conflicts_with_all = ["on", "port"])]
    can: Option<String>,
    /// Which of the legs on the CAN bus, 1 to 6.
    #[arg(long, value_name = "N", requires = "can", default_value = "1", value_parser = leg_address)]
    leg: LegAddress,
}

fn leg_address(text: &str) -> Result<LegAddress, String> {
    let number = text.parse().ok().and_then(LegAddress::new);
    number.ok_or_else(|| "it is none of 1 to 6".into())
}

/// Which leg is emulated.
#[derive(Debug, clap::Args)]
pub(super) struct RigArgs {
    /// The rig file or the name of a ready rig for the emulated leg; the paper's rig if left out.
    #[arg(long, value_name = "FILE", requires = "on")]
    rig: Option<PathBuf>,
}

impl RigArgs {
    pub(super) fn load(&self) -> Result<RigFile, Failure> {
        Ok(RigFile::load(self.rig.as_deref())?)
    }
}

/// An emulated leg's state when the command begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fresh {
    Homed,
    Slack,
}

impl Fresh {
    pub(super) const fn beginning(self) -> Beginning {
        match self {
            Self::Homed => Beginning::Hanging,
            Self::Slack => Beginning::Slack(SLACK_M),
        }
    }
}

/// What a line is opened for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    All,
    /// Nothing but a stop, beside whatever else goes on.
    Stop,
}

/// A leg that knows this host.
pub(super) struct Line {
    pub(super) operator: Operator,
    /// The emulated leg, for what is done to it from outside.
    pub(super) emulated: Option<Emulated>,
}

impl LineArgs {
    /// Opens the line. `rig` is that of an emulated leg.
    pub(super) fn open(&self, rig: &RigFile, fresh: Fresh, verbose: bool) -> Result<Line, Failure> {
        self.open_for(Use::All, rig, fresh, verbose)
    }

    /// The same for one use.
    pub(super) fn open_for(
        &self,
        to: Use,
        rig: &RigFile,
        fresh: Fresh,
        verbose: bool,
    ) -> Result<Line, Failure> {
        let interrupt = Interrupt::on_ctrl_c();
        let Some(on) = self.on else {
            let transport = match &self.can {
                None => self.serial()?,
                Some(interface) => can(interface, self.leg, to)?,
            };
            let operator = Operator::open(transport, Host::random(), interrupt)?;
            for notice in notices(operator.identity()) {
                eprintln!("leg: {notice}");
            }
            return Ok(Line {
                operator,
                emulated: None,
            });
        };
        let leg = EmulatedLeg::new(rig, fresh.beginning(), controller(on, verbose)?)
            .map_err(|error| Failure::from_error(&error))?;
        let emulated = Emulated::new(leg, &format!("the leg {}", on.words()));
        let host = Box::new(emulated.beside());
        Ok(Line {
            operator: Operator::open(host, Host::FIXED, interrupt)?,
            emulated: Some(emulated),
        })
    }

    fn serial(&self) -> Result<Box<dyn Transport>, Failure> {
        let opened = match &self.port {
            Some(port) => Serial::open(port),
            None => serial::find().and_then(|port| Serial::open(&port)),
        };
        match opened {
            Ok(serial) => {
                if let Some(reason) = serial.alone() {
                    eprintln!(
                        "leg: other commands cannot use this port meanwhile ({reason}): let TMPDIR be a directory that may be written, with a short path"
                    );
                }
                Ok(Box::new(serial))
            }
            Err(error) => Err(no_line(&error)),
        }
    }
}

#[cfg(target_os = "linux")]
fn can(interface: &str, leg: LegAddress, to: Use) -> Result<Box<dyn Transport>, Failure> {
    let opened = match to {
        Use::All => SocketCan::open(interface, leg).map(|port| CanTransport::new(port, leg)),
        Use::Stop => {
            SocketCan::open_beside(interface, leg).map(|port| CanTransport::urgent_only(port, leg))
        }
    };
    match opened {
        Ok(transport) => Ok(Box::new(transport)),
        Err(error) => Err(Failure::from_error(&error)),
    }
}

#[cfg(not(target_os = "linux"))]
fn can(_: &str, _: LegAddress, _: Use) -> Result<Box<dyn Transport>, Failure> {
    Err(Failure::refused(
        "CAN is served on Linux only",
        "connect the board's serial port",
    ))
}

fn no_line(error: &SerialError) -> Failure {
    Failure::refused(error.to_string(), error.remedy())
}

/// The firmware without a board.
pub(super) fn controller(on: On, verbose: bool) -> Result<Box<dyn Controller>, Failure> {
    Ok(match on {
        On::Sim => Box::new(InThisProcess::default()),
        On::Qemu => Box::new(Behind::new(board::qemu(verbose)?)),
    })
}

/// A version in words.
pub(super) fn version([major, minor, patch]: [u8; 3]) -> String {
    format!("{major}.{minor}.{patch}")
}

/// Shows on a terminal what the leg does while `work` is done.
pub(super) fn shown<T>(
    operator: &mut Operator,
    work: impl FnOnce(&mut Operator) -> Result<T, leg_host::operator::OperatorError>,
) -> Result<T, Failure> {
    let bar = progress::telling();
    let watching = bar.clone();
    operator.set_watcher(move |telemetry| {
        watching.set_message(progress_words(telemetry));
        watching.tick();
    });
    let result = work(operator);
    bar.finish_and_clear();
    Ok(result?)
}

fn progress_words(telemetry: &Telemetry<f32>) -> String {
    let [a, b, c] = telemetry.tensions_n;
    let pose = leg_host::leg_report::pose_words(telemetry.pose);
    let state = words::state(telemetry.state);
    format!("{state}, {pose}, tensions {a:.0} {b:.0} {c:.0} N")
}
