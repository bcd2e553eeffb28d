//! `leg faults`.

use super::print;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::words;
use leg_firmware::supervisor::{FaultEntry, Reaction, TABLE};
use serde::Serialize;

/// Prints the fault table: what each fault is, what raises it, what it leads to and how it ends.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Standard output that cannot be written.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    print(&if args.json { json()? } else { table() })
}

/// When a fault of a reaction is over.
fn ends(reaction: Reaction) -> &'static str {
    match reaction {
        Reaction::Limit => "with its cause",
        _ => "by `clear`, its cause gone",
    }
}

fn table() -> String {
    let rows: String = TABLE.iter().map(row).collect();
    format!(
        "code  fault                         reaction   raised when\n{rows}\n\
         limit: the leg goes on with what is possible; ends with its cause.\n\
         hold: the leg stays where it is, its tendons kept above the minimum tension.\n\
         ramp down: the tendons are let out until they barely pull, then the drivers are off.\n\
         gate off: the drivers are off at once; the screws hold.\n\
         All but limits end by `clear` alone, once their cause is gone.\n"
    )
}

fn row(entry: &FaultEntry) -> String {
    let fault = entry.fault;
    format!(
        "{:4}  {:28}  {:9}  {}\n{:47}remedy: {}\n",
        fault.code(),
        entry.name,
        words::reaction(fault.reaction()),
        entry.cause,
        "",
        entry.remedy
    )
}

#[derive(Serialize)]
struct JsonRow {
    code: u8,
    fault: leg_firmware::supervisor::Fault,
    name: &'static str,
    reaction: Reaction,
    cause: &'static str,
    remedy: &'static str,
    ends: &'static str,
}

fn json() -> Result<String, Failure> {
    let rows: Vec<JsonRow> = TABLE
        .iter()
        .map(|entry| JsonRow {
            code: entry.fault.code(),
            fault: entry.fault,
            name: entry.name,
            reaction: entry.fault.reaction(),
            cause: entry.cause,
            remedy: entry.remedy,
            ends: ends(entry.fault.reaction()),
        })
        .collect();
    to_line(&rows)
}
