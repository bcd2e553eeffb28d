//! The command `leg`.

use std::process::ExitCode;

fn main() -> ExitCode {
    leg_host_tools::cli::main()
}
