//! A board on a serial port.

#[cfg(not(unix))]
mod alone;
#[cfg(unix)]
mod hub;
mod port;
#[cfg(unix)]
mod shared;

#[cfg(all(test, unix))]
mod tests;

#[cfg(not(unix))]
pub use alone::Serial;
pub use port::find_board;
#[cfg(unix)]
pub use shared::Serial;
