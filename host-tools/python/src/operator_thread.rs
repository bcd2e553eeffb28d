//! An operator in a thread of its own, which Python asks: it cannot leave the thread in which its transport was opened.

use leg_base::failure::Failure;
use leg_firmware::can::LegAddress;
use leg_firmware::supervisor::State;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator, OperatorError};
use leg_host::transport::Transport;
#[cfg(target_os = "linux")]
use leg_host::transport::can::SocketCan;
use leg_host::transport::can::{CanTransport, EmulatedCan};
use leg_host::transport::emulated::EmulatedLine;
use leg_host::transport::serial::{self, Serial};
use leg_host::transport::tcp::{self, Tcp};
use leg_rig::rig_file::RigFile;
use leg_sim::action::Action;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::link::InProcess;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;
use std::{mem, process};

/// How often it is looked whether Python has a signal: nobody feels 50 ms as a delay.
const LOOK_TIME: Duration = Duration::from_millis(50);

/// Where a leg is.
pub enum Place {
    /// On a serial port, or emulated at the other end of a TCP connection; that of the board's ST-LINK if none is named.
    Port(Option<String>),
    /// On a CAN FD bus: the interface.
    Can(String, LegAddress),
    /// In this process; on an emulated bus if it has an address there.
    Emulated(Box<RigFile>, InitialState, Option<LegAddress>),
}

/// Why a leg did not do what it was asked.
pub enum LegFailure {
    /// It cannot be reached, or not do that.
    Refused(Failure),
    /// The operator's error, and what the leg does then where the error does not say it.
    Operator(Box<OperatorError>, Option<State>),
    /// The thread has ended.
    Closed,
}

impl From<Failure> for LegFailure {
    fn from(failure: Failure) -> Self {
        Self::Refused(failure)
    }
}

impl From<OperatorError> for LegFailure {
    fn from(error: OperatorError) -> Self {
        Self::Operator(Box::new(error), None)
    }
}

/// A leg that knows this host.
struct Connection {
    operator: Operator,
    /// The leg itself, if it is emulated here.
    emulated: Option<EmulatedLine>,
}

/// What the thread is asked to do.
type Job = Box<dyn FnOnce(&mut Connection) + Send>;

/// The operator in its thread.
pub struct OperatorThread {
    jobs: Sender<Job>,
    thread: JoinHandle<()>,
    /// Where it runs: a copy of that process, as `multiprocessing` makes it, has no other thread than its main one.
    process: u32,
}

impl OperatorThread {
    /// Opens a leg. Cancelling ends what it is asked, with a driven leg in hold.
    pub fn open(
        place: Place,
        cancel: &CancelFlag,
        interrupted: impl FnMut() -> bool,
    ) -> Result<Self, LegFailure> {
        let (jobs, to_do) = channel::<Job>();
        let (opened, result) = channel();
        let flag = cancel.clone();
        let thread = thread::spawn(move || match connect(place, flag) {
            Ok(connection) => {
                if opened.send(Ok(())).is_ok() {
                    serve(connection, &to_do);
                }
            }
            Err(failure) => {
                // Whoever asked may have gone.
                let _ = opened.send(Err(failure));
            }
        });
        wait(&result, cancel, interrupted)??;
        Ok(Self {
            jobs,
            thread,
            process: process::id(),
        })
    }

    /// Lets the operator work.
    pub fn ask<T: Send + 'static>(
        &self,
        cancel: &CancelFlag,
        interrupted: impl FnMut() -> bool,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError> + Send + 'static,
    ) -> Result<T, LegFailure> {
        self.submit(cancel, interrupted, |Connection { operator, .. }| {
            work(operator).map_err(|error| with_state(error, operator))
        })
    }

    /// Does something to an emulated leg.
    pub fn disturb(
        &self,
        cancel: &CancelFlag,
        interrupted: impl FnMut() -> bool,
        action: Action,
    ) -> Result<(), LegFailure> {
        self.submit(cancel, interrupted, move |connection| {
            let Some(leg) = &connection.emulated else {
                let remedy = "open it with Leg.emulated";
                return Err(Failure::refused("only an emulated leg is disturbed", remedy).into());
            };
            leg.with_plant(|plant| action.apply(plant));
            Ok(())
        })
    }

    fn submit<T: Send + 'static>(
        &self,
        cancel: &CancelFlag,
        interrupted: impl FnMut() -> bool,
        work: impl FnOnce(&mut Connection) -> Result<T, LegFailure> + Send + 'static,
    ) -> Result<T, LegFailure> {
        let (done, result) = channel();
        let job: Job = Box::new(move |connection| {
            // Whoever asked may have gone.
            let _ = done.send(work(connection));
        });
        self.jobs.send(job).map_err(|_| LegFailure::Closed)?;
        wait(&result, cancel, interrupted)?
    }

    /// Whether it runs in this process.
    pub fn is_here(&self) -> bool {
        self.process == process::id()
    }

    /// Ends the thread, and with it the connection.
    pub fn close(self) {
        if !self.is_here() {
            // It is the other process that ends it.
            mem::forget(self);
            return;
        }
        drop(self.jobs);
        // A thread that panicked has ended, too.
        let _ = self.thread.join();
    }
}

fn connect(place: Place, cancel: CancelFlag) -> Result<Connection, LegFailure> {
    let (transport, host, emulated): (Box<dyn Transport>, _, _) = match place {
        Place::Port(port) => (serial_or_tcp(port, &cancel)?, HostIdentity::random(), None),
        Place::Can(interface, leg) => (can(&interface, leg)?, HostIdentity::random(), None),
        Place::Emulated(rig, initial, address) => {
            let leg = EmulatedLeg::new(&rig, initial, Box::new(InProcess::new()));
            let line = EmulatedLine::new(leg.map_err(Failure::from_error)?, "the emulated leg");
            let end = line.connect();
            let transport: Box<dyn Transport> = match address {
                Some(leg) => Box::new(CanTransport::new(EmulatedCan::new(end, leg), leg)),
                None => Box::new(end),
            };
            (transport, HostIdentity::FIXED, Some(line))
        }
    };
    let operator = Operator::open(transport, host, cancel)?;
    Ok(Connection { operator, emulated })
}

fn serial_or_tcp(port: Option<String>, cancel: &CancelFlag) -> Result<Box<dyn Transport>, Failure> {
    let port = port.map_or_else(serial::find_board, Ok)?;
    Ok(match port.strip_prefix(tcp::SCHEME) {
        Some(address) => Box::new(Tcp::open(address)?),
        None => Box::new(Serial::open_watched(&port, |_| !cancel.is_set())?),
    })
}

#[cfg(target_os = "linux")]
fn can(interface: &str, leg: LegAddress) -> Result<Box<dyn Transport>, Failure> {
    let port = SocketCan::open(interface, leg).map_err(Failure::from_error)?;
    Ok(Box::new(CanTransport::new(port, leg)))
}

#[cfg(not(target_os = "linux"))]
fn can(_: &str, _: LegAddress) -> Result<Box<dyn Transport>, Failure> {
    Err(Failure::refused(
        "CAN is supported on Linux only",
        "connect the board's serial port",
    ))
}

/// The error with what the leg does now, where it leaves that out.
fn with_state(error: OperatorError, operator: &mut Operator) -> LegFailure {
    let state = match error {
        OperatorError::Faulted(..) | OperatorError::NotCleared(_) => operator
            .telemetry()
            .ok()
            .map(|report| report.telemetry.state),
        _ => None,
    };
    LegFailure::Operator(Box::new(error), state)
}

fn serve(mut connection: Connection, to_do: &Receiver<Job>) {
    while let Ok(job) = to_do.recv() {
        job(&mut connection);
    }
}

/// Waits for a result, and cancels once if it is interrupted meanwhile.
fn wait<T>(
    result: &Receiver<T>,
    cancel: &CancelFlag,
    mut interrupted: impl FnMut() -> bool,
) -> Result<T, LegFailure> {
    loop {
        match result.recv_timeout(LOOK_TIME) {
            Ok(value) => return Ok(value),
            Err(RecvTimeoutError::Timeout) => {
                if interrupted() {
                    cancel.set();
                }
            }
            Err(RecvTimeoutError::Disconnected) => return Err(LegFailure::Closed),
        }
    }
}
