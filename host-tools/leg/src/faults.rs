//! `leg faults`.

use crate::options::Options;
use leg_base::description;
use leg_base::failure::Failure;
use leg_firmware::supervisor::{Clearing, FAULT_TABLE, Fault, FaultEntry, Reaction};
use serde::Serialize;

#[derive(Serialize)]
struct FaultRow {
    code: u8,
    fault: Fault,
    name: &'static str,
    reaction: Reaction,
    cause: &'static str,
    remedy: &'static str,
    ends: &'static str,
}

pub(crate) fn run(options: Options) -> Result<(), Failure> {
    let rows: Vec<FaultRow> = FAULT_TABLE.into_iter().map(FaultRow::new).collect();
    options.report(&rows, |rows| table(rows))
}

impl FaultRow {
    fn new(entry: &FaultEntry) -> Self {
        Self {
            code: entry.fault.code(),
            fault: entry.fault,
            name: entry.name,
            reaction: entry.reaction,
            cause: entry.cause,
            remedy: entry.remedy,
            ends: match entry.clears {
                Clearing::CauseGone => "with its cause",
                Clearing::Command => "by `clear`, its cause gone",
            },
        }
    }

    fn text(&self) -> String {
        format!(
            "{:4}  {:28}  {:9}  {}\n{:47}remedy: {}\n",
            self.code,
            self.name,
            description::reaction(self.reaction),
            self.cause,
            "",
            self.remedy
        )
    }
}

fn table(rows: &[FaultRow]) -> String {
    let rows: String = rows.iter().map(FaultRow::text).collect();
    format!(
        "code  fault                         reaction   raised when\n{rows}\n\
         limit: the leg goes on with what is possible; ends with its cause.\n\
         hold: the leg stays where it is, its tendons kept above the minimum tension.\n\
         ramp down: the tendons are paid out until they barely pull, then the drivers are off.\n\
         gate off: the drivers are off at once; the screws hold.\n\
         All but limits end by `clear` alone, once their cause is gone.\n"
    )
}
