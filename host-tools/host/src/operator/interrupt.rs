//! Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// Whether the user wants an end.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// The one that Ctrl-C raises, and the end of the terminal.
    #[must_use]
    pub fn on_ctrl_c() -> Self {
        static ONLY: OnceLock<Interrupt> = OnceLock::new();
        let make = || {
            let interrupt = Self::default();
            let raised = interrupt.clone();
            // Without a handler Ctrl-C ends the process, and the board's own timeout holds the leg.
            let _ = ctrlc::set_handler(move || raised.raise());
            interrupt
        };
        ONLY.get_or_init(make).clone()
    }

    /// Raises it.
    pub fn raise(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether it was raised.
    #[must_use]
    pub fn raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
