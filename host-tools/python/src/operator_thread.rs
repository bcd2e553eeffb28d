//! An operator in a thread of its own, which Python asks: it cannot leave the thread in which its transport was opened.

use leg_base::failure::Failure;
use leg_firmware::supervisor::State;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator, OperatorError};
use leg_host::transport::Transport;
use leg_host::transport::emulated::EmulatedLine;
use leg_host::transport::serial::{self, Serial};
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::link::InProcess;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// How often it is looked whether Python has a signal: nobody feels 50 ms as a delay.
const LOOK_TIME: Duration = Duration::from_millis(50);

/// Where a leg is.
pub enum Place {
    /// On a serial port; that of the board's ST-LINK if none is named.
    Port(Option<String>),
    /// In this process.
    Emulated(Box<RigFile>, InitialState),
}

/// Why a leg did not do what it was asked.
pub enum LegFailure {
    /// It cannot be reached.
    Open(Failure),
    /// The operator's error, and what the leg does then where the error does not say it.
    Operator(Box<OperatorError>, Option<State>),
    /// The thread has ended.
    Closed,
}

impl From<OperatorError> for LegFailure {
    fn from(error: OperatorError) -> Self {
        Self::Operator(Box::new(error), None)
    }
}

/// What the thread is asked to do.
type Job = Box<dyn FnOnce(&mut Operator) + Send>;

/// The operator in its thread.
pub struct OperatorThread {
    jobs: Sender<Job>,
    thread: JoinHandle<()>,
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
            Ok(operator) => {
                if opened.send(Ok(())).is_ok() {
                    serve(operator, &to_do);
                }
            }
            Err(failure) => {
                // Whoever asked may have gone.
                let _ = opened.send(Err(failure));
            }
        });
        wait(&result, cancel, interrupted)??;
        Ok(Self { jobs, thread })
    }

    /// Lets the operator work.
    pub fn ask<T: Send + 'static>(
        &self,
        cancel: &CancelFlag,
        interrupted: impl FnMut() -> bool,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError> + Send + 'static,
    ) -> Result<T, LegFailure> {
        let (done, result) = channel();
        let job: Job = Box::new(move |operator| {
            let result = work(operator).map_err(|error| with_state(error, operator));
            // Whoever asked may have gone.
            let _ = done.send(result);
        });
        self.jobs.send(job).map_err(|_| LegFailure::Closed)?;
        wait(&result, cancel, interrupted)?
    }

    /// Ends the thread, and with it the connection.
    pub fn close(self) {
        drop(self.jobs);
        // A thread that panicked has ended, too.
        let _ = self.thread.join();
    }
}

fn connect(place: Place, cancel: CancelFlag) -> Result<Operator, LegFailure> {
    let (transport, host): (Box<dyn Transport>, _) = match place {
        Place::Port(port) => {
            let port = port.map_or_else(serial::find_board, Ok);
            let open = |port: String| Serial::open_watched(&port, |_| !cancel.is_set());
            let serial = port.and_then(open).map_err(LegFailure::Open)?;
            (Box::new(serial), HostIdentity::random())
        }
        Place::Emulated(rig, initial) => {
            let leg = EmulatedLeg::new(&rig, initial, Box::new(InProcess::new()));
            let leg = leg.map_err(|error| LegFailure::Open(Failure::from_error(error)))?;
            let line = EmulatedLine::new(leg, "the emulated leg");
            (Box::new(line.connect()), HostIdentity::FIXED)
        }
    };
    Ok(Operator::open(transport, host, cancel)?)
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

fn serve(mut operator: Operator, to_do: &Receiver<Job>) {
    while let Ok(job) = to_do.recv() {
        job(&mut operator);
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
