//! What every host crate uses: failures as text, files written whole, numbers and names as text.
//!
//! Begin with [`Failure`](failure::Failure), what every command ends with instead of success: a sentence, what to do about
//! it, where it is, and the exit code.
//!
//! ```
//! use leg_base::failure::Failure;
//!
//! let failure = Failure::refused("cannot read the rig file x.toml", "give a file that exists");
//! assert_eq!(
//!     failure.render(false),
//!     "error: cannot read the rig file x.toml\nhelp: give a file that exists"
//! );
//! ```

pub mod angles;
pub mod atomic_file;
pub mod description;
pub mod disk;
pub mod failure;
pub mod flat_json;
pub mod jog_report;
pub mod json_line;
pub mod longest_times;
pub mod numeric;
pub mod paths;
pub mod recorder_rows;
pub mod refusal;
pub mod rounding;
pub mod settling;
pub mod suggest;
pub mod text_input;
pub mod tick_time;
pub mod timed_path;
