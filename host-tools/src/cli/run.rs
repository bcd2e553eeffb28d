//! `leg run`.

use super::run_report::Report;
use super::{board, print, progress};
use crate::experiment::{self, BOUND_PERCENT, Fig9};
use crate::failure::Failure;
use crate::rig_file::RigFile;
use crate::{image, plot};
use clap::ValueEnum;
use std::path::{Path, PathBuf};

/// Lets the firmware evaluate the paper's Fig. 9 experiment, and sets it beside the paper and the model in f64.
///
/// The leg leans along azimuth 30° from one edge of the workspace to the other, with 0, 0.5, 1 and 2 kg at the tip.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Where the firmware runs.
    #[arg(long, value_enum, default_value_t = On::Qemu)]
    on: On,
    /// The rig file; the paper's rig if left out. Only that is compared with the paper.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// The folder for fig9.svg and fig9.png; target/leg-run in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Prints JSON with every pose instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum On {
    /// On an emulated Cortex-M4F.
    Qemu,
    /// In this process.
    Sim,
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a rig file or link that is refused, plots that cannot be written, or maxima that miss the paper's.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let rig = RigFile::load(args.rig.as_deref())?;
    let (mut link, place) = match args.on {
        On::Qemu => (board::qemu(verbose)?, "under QEMU"),
        On::Sim => (board::in_process()?, "in this process"),
    };
    let progress = progress::bar(experiment::pose_count(), "poses");
    let measured = Fig9::measure(&rig, link.as_mut(), || progress.inc(1));
    progress.finish_and_clear();
    let fig9 = measured.map_err(|error| Failure::from_error(&error))?;
    let plot = draw(&fig9, place, &folder(args))?;
    let report = Report {
        rig: &rig,
        place,
        fig9: &fig9,
        plot: &plot,
    };
    print(&if args.json {
        report.json()?
    } else {
        report.table()
    })?;
    judge(&fig9)
}

fn judge(fig9: &Fig9) -> Result<(), Failure> {
    if fig9.held() {
        return Ok(());
    }
    let sentence = format!("a maximum is more than {BOUND_PERCENT} % off the paper's");
    Err(Failure::missed(
        sentence,
        "compare the model and the rig with what the paper used",
    ))
}

fn folder(args: &Args) -> PathBuf {
    args.plots
        .clone()
        .unwrap_or_else(|| image::workspace_root().join("target/leg-run"))
}

fn draw(fig9: &Fig9, place: &str, folder: &Path) -> Result<PathBuf, Failure> {
    let title = format!("Fig. 9: deviation of the tip, firmware in f32 {place}");
    plot::save_both(&fig9.chart(title), &folder.join("fig9")).map_err(|error| {
        let sentence = format!("no plots in {}: {error}", folder.display());
        Failure::refused(sentence, "name another folder with --plots")
    })
}

#[cfg(test)]
mod tests {
    use super::judge;
    use crate::experiment::{Curve, Fig9};
    use crate::failure::Failure;

    fn fig9(max_mm: f64) -> Fig9 {
        let curve = Curve {
            paper_max_mm: Some(2.0),
            firmware_mm: vec![max_mm],
            host_mm: vec![max_mm],
            ..Curve::default()
        };
        Fig9 {
            azimuth_deg: 30.0,
            tilts_deg: vec![30.0],
            curves: vec![curve],
        }
    }

    #[test]
    fn a_maximum_beyond_the_bound_ends_with_exit_code_1() {
        assert!(judge(&fig9(2.02)).is_ok());
        assert!(matches!(judge(&fig9(2.1)), Err(Failure::Missed(_))));
    }
}
