//! The options that every command takes.

use crate::output::print;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use serde::Serialize;

#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct Options {
    /// Shows the log of the firmware under QEMU on standard error.
    #[arg(short, long, global = true, display_order = 900)]
    pub(crate) verbose: bool,
    /// Prints reports and errors as JSON, one value a line; errors on standard error.
    #[arg(long, global = true, display_order = 901)]
    pub(crate) json: bool,
}

impl Options {
    /// Prints a report for people, or for machines as one line of JSON.
    pub(crate) fn report(
        self,
        json: &(impl Serialize + ?Sized),
        text: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        print(&if self.json { to_line(json)? } else { text() })
    }
}
