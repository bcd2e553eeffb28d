//! `leg man`.

use crate::command;
use crate::output::{print, save_all};
use clap_mangen::Man;
use leg_base::failure::Failure;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Prints the manual page of `leg`, or writes a page for each command.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The directory for leg.1 and a page for each command, as leg-run.1; without it leg.1 is printed.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.out {
        None => {
            let mut page = Vec::new();
            let rendered = Man::new(command()).render(&mut page);
            rendered.map_err(Failure::from_error)?;
            print(&String::from_utf8_lossy(&page))
        }
        Some(directory) => {
            let made = |path: &Path| -> Result<(), Box<dyn Error>> {
                Ok(clap_mangen::generate_to(command(), path)?)
            };
            save_all("manual pages", directory, "--out", made, || Ok(()))
        }
    }
}
