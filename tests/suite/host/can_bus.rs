//! CAN FD: the transport of a host, a simulated leg that is moved over it, and six legs that share it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod bus;
mod emulated_leg;
mod port;
mod six_legs;
mod transport;
