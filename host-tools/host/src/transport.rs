//! What carries the bytes between host and board.

pub mod can;
pub mod emulated;
pub mod serial;
pub mod tcp;

use std::io;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

/// Carries the frames of [`leg_firmware::frame`] to one board and back. What is lost is lost: the frames' own sequence
/// numbers and CRC show it.
pub trait Transport {
    /// What it is, for a message to the user: `can0, leg 3`.
    fn name(&self) -> &str;

    /// Sends whole frames, each with its final zero; returns when the system has taken them all.
    /// [`io::ErrorKind::InvalidInput`] if a transport that cannot send parts of a frame is given one,
    /// [`io::ErrorKind::TimedOut`] if the system does not take them.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Sends one whole frame before all that waits, where the transport can: a stop.
    fn send_urgent(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.send(bytes)
    }

    /// Waits for bytes and returns how many came, at least one; 0 only for a `bytes` without room, and where the other
    /// side has ended for good. [`io::ErrorKind::TimedOut`] if none came in time.
    fn receive(&mut self, bytes: &mut [u8], timeout: Duration) -> io::Result<usize>;

    /// Frames of the transport's own that came damaged or incomplete, and so are missing in the bytes.
    fn damaged(&self) -> u64 {
        0
    }

    /// Time since some moment, by the clock of the timeouts: the host's, or that of an emulated leg.
    fn now(&self) -> Duration {
        host_time()
    }

    /// Whether that clock is an emulated leg's own, which goes on only while bytes are waited for.
    fn clock_is_emulated(&self) -> bool {
        false
    }
}

/// Time since some moment, by the host's clock.
fn host_time() -> Duration {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}
