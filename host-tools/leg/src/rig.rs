//! `leg rig`.

use crate::options::Options;
use crate::output::{load_rig, print, print_notes, write};
use clap::Subcommand;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::json_object;
use leg_model_tools::rig_drawing;
use leg_rig::ready_rigs::{READY_RIGS, ReadyRig};
use leg_rig::rig_convert::{self, RigFormat};
use leg_rig::rig_file::{RigFile, RigText};
use leg_rig::rig_settings::{self, Setting};
use leg_rig::rig_show;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Shows, draws, checks, lists and converts rig files.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    action: RigAction,
}

#[derive(Debug, Subcommand)]
enum RigAction {
    /// Lists the ready rigs; `--rig` takes their names.
    List,
    /// Prints the mechanism of a rig file as the model sees it, and what follows from its motors.
    ///
    /// Gains and limits that follow from `[actuator]` stand with their formula; one that the file gives wins.
    Show {
        /// The rig file or a ready rig's name; the paper's rig if left out.
        rig: Option<PathBuf>,
        /// Lists gains and limits of the controller, each with its range, its default and its meaning.
        #[arg(long)]
        control: bool,
        /// Lists actuators, sensors and their calibration.
        #[arg(long, conflicts_with = "control")]
        actuator: bool,
        /// Lists the settings of the simulated leg.
        #[arg(long, conflicts_with_all = ["control", "actuator"])]
        simulation: bool,
    },
    /// Draws the leg in proportion as an SVG file: from the side with its dimensions, and the tendons enlarged.
    Draw {
        /// The rig file or a ready rig's name; the paper's rig if left out.
        rig: Option<PathBuf>,
        /// The file to write; standard output if left out.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Checks a rig file and reports line and column of the first error; what is doubtful is a warning.
    Validate {
        /// The rig file.
        rig: PathBuf,
    },
    /// Converts a rig file to JSON, or JSON to a rig file, with the same keys. Comments are lost.
    Convert {
        /// The rig file (TOML or JSON) or a ready rig's name.
        rig: PathBuf,
        /// The format to write.
        #[arg(long, value_enum)]
        to: RigFormat,
        /// The file to write; standard output if left out.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
}

/// What lists settings of a rig.
type List = fn(&RigFile) -> Vec<Setting>;

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    match &args.action {
        RigAction::List => {
            let rigs = ready_rigs()?;
            options.report(&rigs, || list_text(&rigs))
        }
        RigAction::Show {
            rig,
            control,
            actuator,
            simulation,
        } => {
            let file = load_rig(rig.as_deref())?;
            let lists = [
                (*control, rig_settings::control as List),
                (*actuator, rig_settings::actuator),
                (*simulation, rig_settings::simulation),
            ];
            let list = lists.into_iter().find(|(asked, _)| *asked);
            print(&match (list, options.json) {
                (None, false) => rig_show::words(&file),
                (None, true) => rig_show::json(&file)?,
                (Some((_, list)), false) => rig_settings::table(&list(&file)),
                (Some((_, list)), true) => to_line(&list(&file))?,
            })
        }
        RigAction::Draw { rig, out } => {
            let svg = rig_drawing::svg(&load_rig(rig.as_deref())?).map_err(Failure::from_error)?;
            write(out.as_deref(), &svg)
        }
        RigAction::Validate { rig } => validate(rig, options),
        RigAction::Convert { rig, to, out } => {
            let source = RigText::load(Some(rig))?;
            let (text, notes) = rig_convert::convert(&source, *to)?;
            print_notes(&notes);
            write(out.as_deref(), &text)
        }
    }
}

fn validate(rig: &Path, options: Options) -> Result<(), Failure> {
    let (file, notes) = RigText::load(Some(rig))?.read()?;
    print_notes(&notes);
    let support = file.support_name.word();
    let json = json_object! { file: rig, support: support, notes: &notes };
    options.report(&json, || {
        let warnings = notes.iter().filter(|note| note.contains(": warning: "));
        let doubts = match warnings.count() {
            0 => "nothing wrong with it".into(),
            count => format!("nothing that cannot work; warnings: {count}"),
        };
        format!(
            "{}: a rig on the support `{support}`, {doubts}\n",
            rig.display()
        )
    })
}

/// A ready rig with what its joint does, as the model computes it from geometry and material.
#[derive(Serialize)]
struct ReadyRigRow {
    rig: &'static str,
    figure_2: &'static str,
    freedoms: u8,
    bending_nm_per_rad: f64,
    /// None where the joint blocks torsion.
    torsion_nm_per_rad: Option<f64>,
    support: &'static str,
}

fn ready_rigs() -> Result<Vec<ReadyRigRow>, Failure> {
    let row = |rig: &ReadyRig| -> Result<ReadyRigRow, Failure> {
        let support = RigFile::parse(rig.name, rig.text)?.support;
        let joint = support.joint();
        Ok(ReadyRigRow {
            rig: rig.name,
            figure_2: rig.figure_2,
            freedoms: if support.twists() { 3 } else { 2 },
            bending_nm_per_rad: joint.bending_nm_per_rad,
            torsion_nm_per_rad: support.twists().then_some(joint.torsion_nm_per_rad),
            support: rig.words,
        })
    };
    READY_RIGS.iter().map(row).collect()
}

fn list_text(rigs: &[ReadyRigRow]) -> String {
    let row = |rig: &ReadyRigRow| {
        let blocked = || "blocked".into();
        let torsion = rig.torsion_nm_per_rad;
        let torsion = torsion.map_or_else(blocked, |torsion| format!("{torsion:.3}"));
        format!(
            "{:<22} {:<7} {:>8} {:>9.3} {torsion:>9}  {}\n",
            rig.rig, rig.figure_2, rig.freedoms, rig.bending_nm_per_rad, rig.support
        )
    };
    let rows: String = rigs.iter().map(row).collect();
    format!(
        "                                          bending   torsion\n\
         rig                    Fig. 2  freedoms   N·m/rad   N·m/rad  support\n{rows}"
    )
}
