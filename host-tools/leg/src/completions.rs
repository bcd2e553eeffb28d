//! `leg completions`.

use crate::command;
use crate::output::print;
use clap_complete::Shell;
use leg_base::failure::Failure;

/// Prints the completions of `leg` for a shell.
///
/// For bash: `leg completions bash > ~/.local/share/bash-completion/completions/leg`. The help of other shells says where
/// theirs go.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The shell.
    #[arg(value_enum)]
    shell: Shell,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command(), "leg", &mut script);
    print(&String::from_utf8_lossy(&script))
}
