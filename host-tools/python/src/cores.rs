//! The cores of this machine, for the model at many poses.

use crate::errors::leg_error;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::process;
use std::sync::{Arc, Mutex, PoisonError};

/// Threads, and the process whose they are.
type Threads = (u32, Arc<ThreadPool>);

static THREADS: Mutex<Option<Threads>> = Mutex::new(None);

/// One thread for each core. A copy of a process, as `multiprocessing` makes it, has none of its threads: it gets others.
///
/// Whoever calls it has the interpreter's lock, so that no copy is made meanwhile.
pub fn threads(_: Python<'_>) -> PyResult<Arc<ThreadPool>> {
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let here = process::id();
    if let Some((process, pool)) = &*threads
        && *process == here
    {
        return Ok(pool.clone());
    }
    let pool = ThreadPoolBuilder::new().build();
    let pool = Arc::new(pool.map_err(|_| leg_error("the system gives no threads for the model"))?);
    // Those of the other process are not there to be ended.
    std::mem::forget(threads.replace((here, pool.clone())));
    Ok(pool)
}
