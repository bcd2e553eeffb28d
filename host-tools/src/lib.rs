//! The command `leg` and what it is made of.

pub mod atomic_file;
pub mod check;
pub mod cli;
pub mod cost;
pub mod evaluate;
pub mod experiment;
pub mod failure;
pub mod image;
mod json_entries;
pub mod jsonl;
pub mod line_error;
pub mod link;
pub mod nonlinear;
pub mod plot;
pub mod precision;
pub mod qemu;
pub mod ready_rigs;
pub mod rig_convert;
pub mod rig_file;
pub mod rig_show;
pub mod rounding;
pub mod setup;
mod suggest;
pub mod support_name;
pub mod toml_problem;
pub mod toml_section;
