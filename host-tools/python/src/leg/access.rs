//! Who has a leg: one thread of Python at a time, which may be interrupted; another one may stop what it does.

use super::Leg;
use crate::errors::{leg_error, leg_failure};
use crate::interpreter;
use crate::operator_thread::{LegFailure, OperatorThread, Place};
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{Operator, OperatorError};
use leg_host::signals::LegConstants;
use leg_sim::action::Action;
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard, OnceLock, TryLockError};
use std::thread;
use std::time::Duration;

/// How long it takes until a thread that uses the leg is told again that another one stops it.
const TOLD_AGAIN: Duration = Duration::from_millis(1);

/// A leg for one thread alone; none once it is closed.
type Owned<'leg> = MutexGuard<'leg, Option<OperatorThread>>;

/// How a call has the leg for its thread alone.
type Lock = for<'leg> fn(&'leg Leg, &mut Option<PyErr>) -> PyResult<Owned<'leg>>;

/// A leg in a call, which a signal of Python ends.
pub(super) struct Call<'a> {
    thread: &'a OperatorThread,
    cancel: &'a CancelFlag,
    signal: &'a mut Option<PyErr>,
}

impl Call<'_> {
    /// Lets the operator work. A signal ends it, and a driven leg is held then.
    pub fn ask<T: Send + 'static>(
        self,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError> + Send + 'static,
    ) -> Result<T, LegFailure> {
        self.thread
            .ask(self.cancel, || interrupted(self.signal), work)
    }

    /// Does something to an emulated leg.
    pub fn disturb(self, action: Action) -> Result<(), LegFailure> {
        self.thread
            .disturb(self.cancel, || interrupted(self.signal), action)
    }
}

impl Leg {
    pub(super) fn opened(py: Python<'_>, place: Place) -> PyResult<Self> {
        let cancel = CancelFlag::default();
        let mut signal = None;
        let thread = interpreter::Call::begin(py)?
            .detached(|| OperatorThread::open(place, &cancel, || interrupted(&mut signal)));
        if let Some(signal) = signal {
            return Err(signal);
        }
        let leg = Self {
            thread: Mutex::new(Some(thread.map_err(leg_failure)?)),
            cancel,
            constants: OnceLock::new(),
        };
        let settings = leg.ask(py, Operator::settings)?;
        leg.constants.get_or_init(|| LegConstants::new(&settings));
        Ok(leg)
    }

    /// The leg for this thread alone.
    pub(super) fn owned(&self) -> PyResult<Owned<'_>> {
        self.owned_if_free()?.ok_or_else(|| {
            leg_error(
                "another thread uses this leg; stop() is the only call that does not wait for it",
            )
        })
    }

    /// The same; none while another thread has it.
    fn owned_if_free(&self) -> PyResult<Option<Owned<'_>>> {
        match self.thread.try_lock() {
            Ok(thread) => Ok(Some(thread)),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Poisoned(_)) => Err(leg_error("this leg is lost; open it again")),
        }
    }

    /// Ends what another thread does with the leg, which is in hold then, and has the leg for this thread alone.
    ///
    /// The other thread may only be about to begin, and takes back then what was told to it before: it is told until it has ended.
    fn taken_over(&self, signal: &mut Option<PyErr>) -> PyResult<Owned<'_>> {
        loop {
            if let Some(thread) = self.owned_if_free()? {
                return Ok(thread);
            }
            self.cancel.set();
            if interrupted(signal) {
                return self.owned();
            }
            thread::sleep(TOLD_AGAIN);
        }
    }

    /// Lets the operator work while other threads of Python run. Ctrl-C ends it, and a driven leg is held then.
    pub(super) fn ask<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError> + Send + 'static,
    ) -> PyResult<T> {
        self.call(py, |call| call.ask(work))
    }

    /// The same in the place of another thread, whose call is ended.
    pub(super) fn ask_at_once<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Operator) -> Result<T, OperatorError> + Send + 'static,
    ) -> PyResult<T> {
        self.call_with_lock(py, Self::taken_over, |call| call.ask(work))
    }

    /// Uses the leg while other threads of Python run.
    pub(super) fn call<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(Call<'_>) -> Result<T, LegFailure> + Send,
    ) -> PyResult<T> {
        self.call_with_lock(py, |leg, _| leg.owned(), work)
    }

    /// The same with the leg locked in one way or another, to which a signal of Python may come, too.
    fn call_with_lock<T: Send>(
        &self,
        py: Python<'_>,
        lock: Lock,
        work: impl FnOnce(Call<'_>) -> Result<T, LegFailure> + Send,
    ) -> PyResult<T> {
        let mut signal = None;
        let result = interpreter::Call::begin(py)?.detached(|| {
            let thread = lock(self, &mut signal)?;
            let Some(thread) = thread.as_ref() else {
                return Err(leg_error("this leg is closed; open it again"));
            };
            if !thread.is_here() {
                return Err(leg_error(
                    "this leg was opened in another process; open it in this one",
                ));
            }
            self.cancel.clear();
            let call = Call {
                thread,
                cancel: &self.cancel,
                signal: &mut signal,
            };
            work(call).map_err(leg_failure)
        });
        // It is raised even where the work came to its end meanwhile.
        signal.map_or(result, Err)
    }
}

/// Whether Python has a signal, as Ctrl-C, or ends; it is kept for later.
fn interrupted(signal: &mut Option<PyErr>) -> bool {
    if signal.is_none() {
        *signal = interpreter::interrupted();
        return signal.is_some();
    }
    false
}
