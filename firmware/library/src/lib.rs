//! The leg's firmware without its hardware: what a board, QEMU and the host's own process run alike.
#![cfg_attr(not(test), no_std)]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a comparison that is negated refuses NaN, too"
)]

pub mod board;
pub mod can;
pub mod command;
pub mod control;
pub mod drive;
pub mod frame;
pub mod host_link;
pub mod leg;
pub mod linked_leg;
pub mod messages;
pub mod sensors;
pub mod settings;
pub mod store;
pub mod supervisor;
pub mod telemetry;
pub mod version;
