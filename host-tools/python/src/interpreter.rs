//! Work without the interpreter's lock, and the interpreter's end.
//!
//! A thread that asks an ending interpreter for its lock never gets it: it is unwound in the middle of Rust, or finds no interpreter.
//! So [`prepare_end`], which Python calls before, ends all such work and lets no other begin.

use crate::errors::leg_error;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyCFunction};
use std::cell::Cell;
use std::sync::atomic::Ordering::SeqCst;
use std::sync::atomic::{AtomicBool, AtomicUsize};
use std::thread;
use std::time::{Duration, Instant};

/// How long work is waited for at the end: a leg that is driven is held within it. What takes longer never comes back to Python.
const END_TIME: Duration = Duration::from_secs(5);

/// Wait before it is looked again.
const LOOK_TIME: Duration = Duration::from_millis(1);

/// Whether the interpreter is about to end.
static ENDS: AtomicBool = AtomicBool::new(false);

/// Whether work is not waited for any more.
static LEFT: AtomicBool = AtomicBool::new(false);

/// Calls that are under way.
static CALLS: AtomicUsize = AtomicUsize::new(0);

/// Those of them that have worked without the lock and wait for it.
static RETURNING: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    /// Whether this is the thread that ends the interpreter and gets its signals; none before it was asked.
    static IS_MAIN: Cell<Option<bool>> = const { Cell::new(None) };
}

const ENDING: &str = "the interpreter ends; a leg is in hold if it was driven";

/// A call from Python that works without the lock, or has Python's own code work in the middle of it: the end waits for it.
pub struct Call<'py> {
    py: Python<'py>,
    main: bool,
}

impl<'py> Call<'py> {
    /// Begins it, with the lock, as the end is told: that waits for this one, or this one is refused.
    ///
    /// # Errors
    /// The interpreter is about to end.
    pub fn begin(py: Python<'py>) -> PyResult<Self> {
        let main = is_main(py)?;
        if ENDS.load(SeqCst) && !main {
            return Err(leg_error(ENDING));
        }
        CALLS.fetch_add(1, SeqCst);
        Ok(Self { py, main })
    }

    /// Works while other threads of Python run.
    pub fn detached<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let main = self.main;
        let _returned = Returned;
        self.py.detach(|| {
            let _returning = Returning { main };
            work()
        })
    }
}

impl Drop for Call<'_> {
    fn drop(&mut self) {
        CALLS.fetch_sub(1, SeqCst);
    }
}

/// Counts a call that has the lock again.
struct Returned;

impl Drop for Returned {
    fn drop(&mut self) {
        RETURNING.fetch_sub(1, SeqCst);
    }
}

/// Makes a call wait for the lock once it is dropped; for ever where the interpreter is gone.
struct Returning {
    main: bool,
}

impl Drop for Returning {
    fn drop(&mut self) {
        RETURNING.fetch_add(1, SeqCst);
        if LEFT.load(SeqCst) && !self.main {
            RETURNING.fetch_sub(1, SeqCst);
            loop {
                thread::park();
            }
        }
    }
}

/// What ends work without the lock: a signal, as Ctrl-C, in the main thread; in another one the interpreter's end.
pub fn interrupted() -> Option<PyErr> {
    if IS_MAIN.get() == Some(true) {
        return Python::attach(|py| py.check_signals().err());
    }
    ENDS.load(SeqCst).then(|| leg_error(ENDING))
}

fn is_main(py: Python<'_>) -> PyResult<bool> {
    if let Some(known) = IS_MAIN.get() {
        return Ok(known);
    }
    let threading = py.import("threading")?;
    let this = threading.call_method0("current_thread")?;
    let main = this.is(&threading.call_method0("main_thread")?);
    IS_MAIN.set(Some(main));
    Ok(main)
}

/// Has Python tell its end, and that a process began as a copy of this one; once, if several interpreters are in the process.
pub fn watch(py: Python<'_>) -> PyResult<()> {
    static WATCHED: AtomicBool = AtomicBool::new(false);
    if WATCHED.swap(true, SeqCst) {
        return Ok(());
    }
    let end = PyCFunction::new_closure(py, None, None, |arguments, _| prepare_end(arguments.py()))?;
    py.import("atexit")?.call_method1("register", (end,))?;
    let os = py.import("os")?;
    if os.hasattr("register_at_fork")? {
        let forked = PyCFunction::new_closure(py, None, None, |_, _| begin_anew())?;
        let named = [("after_in_child", forked)].into_py_dict(py)?;
        os.call_method("register_at_fork", (), Some(&named))?;
    }
    Ok(())
}

/// Ends what other threads do without the lock.
fn prepare_end(py: Python<'_>) {
    ENDS.store(true, SeqCst);
    // The last of several interpreters in a process cannot let its lock go any more.
    if CALLS.load(SeqCst) == 0 {
        return;
    }
    py.detach(|| {
        let until = Instant::now() + END_TIME;
        while CALLS.load(SeqCst) > 0 && Instant::now() < until {
            thread::sleep(LOOK_TIME);
        }
        LEFT.store(true, SeqCst);
        // Who waits for the lock gets it now.
        while RETURNING.load(SeqCst) > 0 {
            thread::sleep(LOOK_TIME);
        }
    });
}

/// The only thread of a copy of a process is its main one; what the others did is not done there.
fn begin_anew() {
    IS_MAIN.set(Some(true));
    CALLS.store(0, SeqCst);
    RETURNING.store(0, SeqCst);
}
