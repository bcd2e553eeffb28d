//! A test bench around the firmware: kernels, the requests that run and count them, and their server.
//!
//! The product knows nothing of it: no message here is part of what a flashed board speaks.
#![cfg_attr(not(test), no_std)]

pub mod counter;
pub mod example;
pub mod exit;
pub mod kernels;
pub mod pipes;
pub mod protocol;
pub mod query;
pub mod server;
pub mod virtual_board;
pub mod virtual_leg;
