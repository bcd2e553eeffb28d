//! Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// Whether the user has asked for an end; clones share it.
#[derive(Clone, Debug, Default)]
pub struct CancelFlag(Arc<AtomicBool>);

static ONLY: OnceLock<CancelFlag> = OnceLock::new();

impl CancelFlag {
    /// The one that is set by Ctrl-C and by the end of the terminal.
    pub fn set_by_ctrl_c() -> Self {
        let make = || {
            let flag = Self::default();
            let set = flag.clone();
            // Without a handler Ctrl-C ends the process, and the board's own timeout holds the leg.
            let _ = ctrlc::set_handler(move || set.set());
            flag
        };
        ONLY.get_or_init(make).clone()
    }

    /// Whether Ctrl-C has set that one; where nobody has asked for it, Ctrl-C ends the process.
    pub fn ctrl_c_pressed() -> bool {
        ONLY.get().is_some_and(Self::is_set)
    }

    /// Sets it.
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Takes it back, for what comes next.
    pub fn clear(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    /// Whether it is set.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
