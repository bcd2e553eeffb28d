//! What every host crate uses: failures in words, files written whole, numbers and names as text.

pub mod atomic_file;
pub mod failure;
pub mod json_entries;
pub mod json_line;
pub mod numeric;
pub mod paths;
pub mod suggest;
pub mod tick_time;
pub mod words;
