//! The command `leg`.

use std::process::ExitCode;

fn main() -> ExitCode {
    leg_cli::main()
}
