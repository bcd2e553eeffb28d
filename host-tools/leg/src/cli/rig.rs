//! `leg rig`.

use super::print;
use clap::Subcommand;
use leg_base::atomic_file;
use leg_base::failure::Failure;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_convert::{self, Format};
use leg_rig::rig_file::{RigFile, RigText};
use leg_rig::rig_settings::{self, Setting};
use leg_rig::rig_show;
use std::path::PathBuf;

/// Shows, checks, lists and converts rig files.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Lists the rigs that come with the tool; `--rig` takes their names.
    List,
    /// Prints what the model makes of a rig file.
    Show {
        /// The rig file or a ready rig's name; the paper's rig if left out.
        rig: Option<PathBuf>,
        /// Lists gains and limits of the controller instead, each with its range, its default and its meaning.
        #[arg(long)]
        control: bool,
        /// Lists actuators, sensors and their calibration instead.
        #[arg(long, conflicts_with = "control")]
        actuator: bool,
        /// Lists what else the simulated leg is instead.
        #[arg(long, conflicts_with_all = ["control", "actuator"])]
        simulation: bool,
        /// Prints JSON.
        #[arg(long)]
        json: bool,
    },
    /// Checks a rig file and tells line and column of the first fault.
    Validate {
        /// The rig file.
        rig: PathBuf,
    },
    /// Writes a rig file as JSON, or JSON as a rig file: the same keys. Comments are lost.
    Convert {
        /// The rig file (TOML or JSON) or a ready rig's name.
        rig: PathBuf,
        /// The format to write.
        #[arg(long, value_enum)]
        to: Format,
        /// The file to write; standard output if left out.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
}

/// What lists settings of a rig.
type List = fn(&RigFile) -> Vec<Setting>;

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a rig file that is refused or a file that cannot be written.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    match &args.action {
        Action::List => print(&list()?),
        Action::Show {
            rig,
            control,
            actuator,
            simulation,
            json,
        } => {
            let file = RigFile::load(rig.as_deref())?;
            let list = [
                (*control, rig_settings::control as List),
                (*actuator, rig_settings::actuator),
                (*simulation, rig_settings::simulation),
            ];
            let list = list.into_iter().find_map(|(asked, of)| asked.then_some(of));
            print(&match (list, *json) {
                (None, false) => rig_show::words(&file),
                (None, true) => rig_show::json(&file)?,
                (Some(list), false) => rig_settings::table(&list(&file)),
                (Some(list), true) => rig_settings::json(&list(&file))?,
            })
        }
        Action::Validate { rig } => {
            let file = RigFile::load(Some(rig))?;
            let support = file.support_name.word();
            print(&format!(
                "{}: a rig on the support `{support}`, nothing wrong with it\n",
                rig.display()
            ))
        }
        Action::Convert { rig, to, out } => {
            let source = RigText::load(Some(rig))?;
            let converted = rig_convert::convert(&source, *to)?;
            match out {
                None => print(&converted),
                Some(file) => atomic_file::replace(file, |new| std::fs::write(new, &converted))
                    .map_err(|error| {
                        let help = "name a file in a directory that may be written";
                        Failure::refused(format!("cannot write {}: {error}", file.display()), help)
                    }),
            }
        }
    }
}

/// The ready rigs with what their joints do, as the model computes it from geometry and material.
fn list() -> Result<String, Failure> {
    let mut table = String::from(
        "                                          bending   torsion\n\
         rig                    Fig. 2  freedoms   N·m/rad   N·m/rad  support\n",
    );
    for rig in READY_RIGS {
        let support = RigFile::parse(rig.name, rig.text)?.support;
        let joint = support.joint();
        let torsion = match support.twists() {
            true => format!("{:.3}", joint.torsion_nm_per_rad),
            false => "blocked".into(),
        };
        table += &format!(
            "{:<22} {:<7} {:>8} {:>9.3} {torsion:>9}  {}\n",
            rig.name,
            rig.figure_2,
            if support.twists() { 3 } else { 2 },
            joint.bending_nm_per_rad,
            rig.words
        );
    }
    Ok(table)
}
