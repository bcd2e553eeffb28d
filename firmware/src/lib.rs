//! The leg's firmware without its hardware: what a board, QEMU and the host's own process run alike.
#![cfg_attr(not(test), no_std)]

pub mod counter;
pub mod drive;
pub mod exit;
pub mod frame;
pub mod kernels;
pub mod link;
pub mod messages;
pub mod protocol;
pub mod sensors;
pub mod server;
