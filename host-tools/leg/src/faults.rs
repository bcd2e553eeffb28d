//! `leg faults`.

use crate::options::Options;
use leg_base::failure::Failure;
use leg_base::{description, json_object};
use leg_firmware::supervisor::{Clearing, FAULT_TABLE, FaultEntry};

pub(crate) fn run(options: Options) -> Result<(), Failure> {
    let json = |entry: &FaultEntry| {
        json_object! {
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
    };
    let rows: Vec<_> = FAULT_TABLE.into_iter().map(json).collect();
    options.report(&rows, table)
}

fn table() -> String {
    let row = |entry: &FaultEntry| {
        format!(
            "{:4}  {:28}  {:9}  {}\n{:47}remedy: {}\n",
            entry.fault.code(),
            entry.name,
            description::reaction(entry.reaction),
            entry.cause,
            "",
            entry.remedy
        )
    };
    let rows: String = FAULT_TABLE.into_iter().map(row).collect();
    format!(
        "code  fault                         reaction   raised when\n{rows}\n\
         limit: the leg goes on with what is possible; ends with its cause.\n\
         hold: the leg brakes and rests on its screws; its drivers stay on.\n\
         ramp down: the tendons are paid out by their counters, then the drivers are off.\n\
         gate off: the drivers are off at once; the screws hold.\n\
         All but limits end by `clear` alone, once their cause is gone.\n"
    )
}
