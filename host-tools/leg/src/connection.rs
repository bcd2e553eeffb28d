//! The connection to a leg: a board's serial port, a CAN FD bus, or an emulated leg.

use crate::board::Emulation;
use crate::notices::notices;
use crate::options::Options;
use crate::output::{load_rig, note};
use crate::progress;
use indicatif::ProgressBar;
use leg_base::description;
use leg_base::failure::Failure;
use leg_firmware::can::LegAddress;
use leg_firmware::telemetry::Telemetry;
use leg_host::byte_port::BytePort;
use leg_host::cancel_flag::CancelFlag;
use leg_host::emulated_board::EmulatedBoard;
use leg_host::leg_report::pose_words;
use leg_host::operator::{HostIdentity, Operator, OperatorError};
use leg_host::tcp_port::TcpPort;
use leg_host::transport::Transport;
#[cfg(target_os = "linux")]
use leg_host::transport::can::{CanPort, CanTransport, SocketCan};
use leg_host::transport::emulated::EmulatedLine;
use leg_host::transport::serial::{self, Serial};
use leg_host::transport::tcp::{self, Tcp};
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
#[cfg(target_os = "linux")]
use std::io;
use std::net::Ipv4Addr;
use std::path::PathBuf;
use std::sync::mpsc::channel;
use std::thread;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Connection")]
pub(crate) struct ConnectionArgs {
    /// Commands an emulated leg, a fresh one for each command: homed, hanging straight down and disarmed; for `leg home` and
    /// `leg calibrate` slack and not homed. One on a chip is homed first. It has its own time and does not wait for the clock.
    #[arg(long, value_enum)]
    on: Option<Emulation>,
    /// The serial port of the board, or what `leg emulate` prints; the port of the board's ST-LINK if left out.
    #[arg(long, value_name = "PORT", conflicts_with = "on")]
    port: Option<String>,
    /// The CAN FD interface to which the board is connected, as `can0`; Linux only. One command at a time may use a leg on
    /// CAN; only `leg stop` works beside another.
    #[arg(long, value_name = "INTERFACE", conflicts_with_all = ["on", "port"])]
    can: Option<String>,
    /// The address of the leg on the CAN bus, 1 to 6.
    #[arg(long, value_name = "N", requires = "can", conflicts_with_all = ["on", "port"], default_value = "1", value_parser = leg_address)]
    leg: LegAddress,
}

// No doc comment: it would be the help of the commands that take these arguments alone.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Connection")]
pub(crate) struct LegArgs {
    #[command(flatten)]
    connection: ConnectionArgs,
    /// The rig file or the name of a ready rig for the emulated leg; the paper's rig if left out.
    #[arg(long, value_name = "FILE", requires = "on")]
    rig: Option<PathBuf>,
}

fn leg_address(text: &str) -> Result<LegAddress, String> {
    let number = text.parse().ok().and_then(LegAddress::new);
    number.ok_or_else(|| "it is none of 1 to 6".into())
}

/// What a connection is opened for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// An emulated leg is homed.
    Use,
    /// Homing or calibration: an emulated leg is slack and not homed.
    Calibrate,
    /// Nothing but a stop, beside whatever else goes on.
    Stop,
}

impl Purpose {
    /// How an emulated leg starts. A chip forgets its zero when it starts.
    const fn initial(self, on: Emulation) -> InitialState {
        match (self, on) {
            (Self::Calibrate, _) | (_, Emulation::Chip) => InitialState::Slack,
            (Self::Use | Self::Stop, _) => InitialState::Homed,
        }
    }
}

/// A leg that knows this host.
pub(crate) struct LegConnection {
    pub(crate) operator: Operator,
    /// The emulated leg, for what is done to it from outside.
    pub(crate) emulated: Option<EmulatedLine>,
}

fn emulated_name(on: Emulation) -> String {
    format!("the leg {}", on.text())
}

/// A simulated leg with its firmware.
pub(crate) fn emulated_leg(
    rig: &RigFile,
    initial: InitialState,
    on: Emulation,
    options: Options,
) -> Result<EmulatedLeg, Failure> {
    EmulatedLeg::new(rig, initial, on.link(options)?).map_err(Failure::from_error)
}

impl LegArgs {
    /// Whether a leg is named: an emulated one, a port or a bus.
    pub(crate) const fn names_leg(&self) -> bool {
        let ConnectionArgs { on, port, can, .. } = &self.connection;
        on.is_some() || port.is_some() || can.is_some()
    }

    /// Opens a connection on which time passes as for a board: an emulated leg keeps to the clock, in a thread of its own. Gives the
    /// leg's name, too.
    pub(crate) fn open_in_real_time(
        &self,
        options: Options,
    ) -> Result<(Operator, String), Failure> {
        let rig = load_rig(self.rig.as_deref())?;
        let Some(on) = self.connection.on else {
            let operator = self.connection.open(&rig, Purpose::Use, options)?.operator;
            let name = operator.name().into();
            return Ok((operator, name));
        };
        let port = emulate_in_thread(rig, on, options)?;
        let address = port.strip_prefix(tcp::SCHEME).unwrap_or(&port);
        let transport = Box::new(Tcp::open(address)?);
        let cancel = CancelFlag::set_by_ctrl_c();
        let operator = Operator::open(transport, HostIdentity::random(), cancel)?;
        Ok((operator, emulated_name(on)))
    }

    pub(crate) fn open(
        &self,
        purpose: Purpose,
        options: Options,
    ) -> Result<LegConnection, Failure> {
        let rig = load_rig(self.rig.as_deref())?;
        self.connection.open(&rig, purpose, options)
    }
}

impl ConnectionArgs {
    /// Whether the leg is on a CAN bus.
    pub(crate) const fn is_can(&self) -> bool {
        self.can.is_some()
    }

    /// Opens the connection. `rig` is that of an emulated leg.
    pub(crate) fn open(
        &self,
        rig: &RigFile,
        purpose: Purpose,
        options: Options,
    ) -> Result<LegConnection, Failure> {
        let cancel = CancelFlag::set_by_ctrl_c();
        let Some(on) = self.on else {
            let transport = match &self.can {
                None => self.serial(&cancel)?,
                Some(interface) => can(interface, self.leg, purpose)?,
            };
            let host = HostIdentity::random();
            let operator = Operator::open_watched(transport, host, cancel, |error| {
                note_late(&error.failure());
            })?;
            for notice in notices(operator.identity()) {
                note(&format!("leg: {notice}"));
            }
            return Ok(LegConnection {
                operator,
                emulated: None,
            });
        };
        let leg = emulated_leg(rig, purpose.initial(on), on, options)?;
        let emulated = EmulatedLine::new(leg, &emulated_name(on));
        let host = Box::new(emulated.connect());
        let mut operator = Operator::open(host, HostIdentity::FIXED, cancel)?;
        if (purpose, on) == (Purpose::Use, Emulation::Chip) {
            home_first(&mut operator)?;
        }
        Ok(LegConnection {
            operator,
            emulated: Some(emulated),
        })
    }

    fn serial(&self, cancel: &CancelFlag) -> Result<Box<dyn Transport>, Failure> {
        let port = self.port.clone();
        let port = port.map_or_else(serial::find_board, Ok)?;
        if let Some(address) = port.strip_prefix(tcp::SCHEME) {
            return Ok(Box::new(Tcp::open(address)?));
        }
        let serial = Serial::open_watched(&port, |failure| {
            note_late(failure);
            !cancel.is_set()
        })?;
        if let Some(reason) = serial.unshared() {
            note(&format!(
                "leg: other commands cannot use this port meanwhile ({reason}): let TMPDIR be a directory that may be written, with a short path"
            ));
        }
        Ok(Box::new(serial))
    }
}

/// Emulates a board in a thread that lasts as long as the process, and names its port.
fn emulate_in_thread(rig: RigFile, on: Emulation, options: Options) -> Result<String, Failure> {
    let (sender, started) = channel();
    thread::spawn(move || {
        let opened = emulated_leg(&rig, Purpose::Use.initial(on), on, options).and_then(|leg| {
            let port = TcpPort::listen((Ipv4Addr::LOCALHOST, 0)).map_err(Failure::from_error)?;
            Ok((leg, port))
        });
        let (leg, port) = match opened {
            Ok(opened) => opened,
            Err(failure) => return drop(sender.send(Err(failure))),
        };
        // Whoever waits for the name is told, or has gone.
        let _ = sender.send(Ok(port.name()));
        let (_nobody, disturbances) = channel();
        let board = EmulatedBoard::new(leg, Box::new(port));
        // It lasts longer than whoever is connected to it.
        if let Err(failure) = board.run(&CancelFlag::default(), None, &disturbances) {
            note(&format!("leg: {failure}"));
        }
    });
    started.recv().map_err(Failure::from_error)?
}

/// Homes a leg that has just started, and disarms it: as a leg starts that keeps its zero.
fn home_first(operator: &mut Operator) -> Result<(), OperatorError> {
    note("leg: a board forgets its zero when it starts: the leg is homed first");
    let bar = show_progress(operator);
    let homed = operator.home().and_then(|_| operator.disarm());
    operator.set_watcher(|_| ());
    bar.finish_and_clear();
    homed
}

/// Shows on a terminal what the leg does.
fn show_progress(operator: &mut Operator) -> ProgressBar {
    let bar = progress::message();
    let watching = bar.clone();
    operator.set_watcher(move |telemetry| {
        watching.set_message(progress_text(telemetry));
        watching.tick();
    });
    bar
}

/// Says what goes wrong before it is given up.
fn note_late(failure: &Failure) {
    let (Failure::Failed(message) | Failure::Refused(message)) = failure;
    let help = message.help.as_deref().unwrap_or_default();
    note(&format!(
        "leg: {failure}; it is tried again for some seconds. {help}"
    ));
}

#[cfg(target_os = "linux")]
fn can(interface: &str, leg: LegAddress, purpose: Purpose) -> Result<Box<dyn Transport>, Failure> {
    let openers = [SocketCan::open, SocketCan::open_urgent];
    let link = can_link(interface, leg, purpose, openers);
    Ok(Box::new(link.map_err(Failure::from_error)?))
}

/// The link to a leg by an interface, which is opened for this program alone, or beside the one that drives the leg.
#[cfg(target_os = "linux")]
fn can_link<P: CanPort>(
    interface: &str,
    leg: LegAddress,
    purpose: Purpose,
    [alone, beside]: [fn(&str, LegAddress) -> io::Result<P>; 2],
) -> io::Result<CanTransport<P>> {
    match purpose {
        Purpose::Stop => beside(interface, leg).map(|port| CanTransport::urgent_only(port, leg)),
        Purpose::Use | Purpose::Calibrate => {
            alone(interface, leg).map(|port| CanTransport::new(port, leg))
        }
    }
}

#[cfg(not(target_os = "linux"))]
fn can(_: &str, _: LegAddress, _: Purpose) -> Result<Box<dyn Transport>, Failure> {
    Err(Failure::refused(
        "CAN is supported on Linux only",
        "connect the board's serial port",
    ))
}

impl LegConnection {
    /// Does `work`, shows meanwhile on a terminal what the leg does, and returns what it does in the end.
    pub(crate) fn watched<T>(
        mut self,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError>,
    ) -> Result<Telemetry<f32>, Failure> {
        let bar = show_progress(&mut self.operator);
        let result = work(&mut self.operator);
        bar.finish_and_clear();
        result?;
        Ok(self.operator.telemetry()?.telemetry)
    }
}

fn progress_text(telemetry: &Telemetry<f32>) -> String {
    let [a, b, c] = telemetry.tensions_n;
    let pose = pose_words(telemetry.pose);
    let state = description::state(telemetry.state);
    format!("{state}, {pose}, tensions {a:.0} {b:.0} {c:.0} N")
}

#[cfg(all(test, target_os = "linux"))]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Purpose, can_link};
    use leg_firmware::can::{CanFrame, Identifier, LegAddress};
    use leg_host::transport::Transport;
    use leg_host::transport::can::CanPort;
    use std::io;
    use std::time::Duration;

    /// A port with the name of how it was opened, that tells by an error what it was handed.
    struct TellingPort(&'static str);

    impl CanPort for TellingPort {
        fn name(&self) -> &str {
            self.0
        }

        fn send(&mut self, frame: &CanFrame) -> io::Result<()> {
            Err(io::Error::other(format!("{:?}", frame.identifier())))
        }

        fn receive(&mut self, _: Duration) -> io::Result<CanFrame> {
            Err(io::ErrorKind::TimedOut.into())
        }
    }

    /// The program that drives the leg has its ordinary identifier.
    #[test]
    fn a_stop_alone_goes_beside_the_program_that_drives_a_leg_on_can() {
        let leg = LegAddress::ALL[2];
        for (purpose, opened, identifier) in [
            (Purpose::Stop, "beside", Identifier::Urgent(leg)),
            (Purpose::Use, "alone", Identifier::ToLeg(leg)),
            (Purpose::Calibrate, "alone", Identifier::ToLeg(leg)),
        ] {
            let openers = [
                |_: &str, _: LegAddress| Ok(TellingPort("alone")),
                |_: &str, _: LegAddress| Ok(TellingPort("beside")),
            ];
            let mut link = can_link("can0", leg, purpose, openers).unwrap();
            assert_eq!(link.name(), format!("{opened}, {leg}"));
            let sent = link.send(&[1, 0]).unwrap_err().to_string();
            assert_eq!(sent, format!("{identifier:?}"), "{purpose:?}");
        }
    }
}
