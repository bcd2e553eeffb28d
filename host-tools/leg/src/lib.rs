//! The command `leg`.

pub mod cli;
