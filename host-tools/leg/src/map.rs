//! `leg map`.

mod report;

use crate::numbers::{finite, payload_kg};
use crate::options::Options;
use crate::output::{load_rig, not_saved};
use crate::progress;
use leg_base::failure::Failure;
use leg_bench::plot::PlotError;
use leg_bench::plot::field::{self, Layout, PlotField};
use leg_boards::image;
use leg_model_tools::map_csv;
use leg_model_tools::workspace_map::{Grid, MapQuantity, WorkspaceMap};
use leg_rig::rig_file::RigFile;
use report::{MapReport, QuantityExtremes};
use std::path::PathBuf;

/// Draws deviation, stiffness, tension margin and feasible pretensions over the workspace.
///
/// With --json every pose is printed.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The rig file or a ready rig's name; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Mass at the tip, kg.
    #[arg(long, value_name = "KG", default_value = "1", value_parser = payload_kg)]
    payload_kg: f64,
    /// Pretension, N; that of the rig if left out.
    #[arg(long, alias = "level-n", value_name = "N", value_parser = finite)]
    pretension_n: Option<f64>,
    /// Columns of the map, at least 3.
    #[arg(long, default_value = "360", value_parser = clap::value_parser!(u32).range(3..))]
    azimuths: u32,
    /// Rows of the map, at least 2.
    #[arg(long, default_value = "31", value_parser = clap::value_parser!(u32).range(2..))]
    tilts: u32,
    /// The quantities to draw; all but the nonlinear ones if left out. The nonlinear ones are computed only if named here.
    #[arg(long, value_enum)]
    quantity: Vec<MapQuantity>,
    /// The directory for the pictures; target/leg-map in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Writes every pose to a CSV file as well.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// The most poses of one map.
const POSES_MAX: u64 = 10_000_000;

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let rig = rig(args)?;
    let grid = grid(args)?;
    let bar = progress::bar(grid.tilts.into(), "rows");
    let done = || bar.inc(1);
    let with_nonlinear = args.quantity.iter().any(|asked| asked.is_nonlinear());
    let map = WorkspaceMap::compute(&rig, args.payload_kg, grid, with_nonlinear, done);
    bar.finish_and_clear();
    if map.counts().feasible == 0 {
        return Err(nothing_feasible(&rig, args.payload_kg, &map));
    }
    // What was found is told, whether it can be saved or not.
    let saved = match &args.csv {
        Some(file) => map_csv::save_around(&map, file, || draw(args, &rig, &map)),
        None => draw(args, &rig, &map),
    };
    let csv = args.csv.as_deref().filter(|_| saved.is_ok());
    let report = MapReport {
        rig: &rig,
        payload_kg: args.payload_kg,
        map: &map,
        pictures: saved.as_deref().unwrap_or_default(),
        extremes: QuantityExtremes::all(&map),
    };
    options.report(&report.json(), || report.table(csv))?;
    saved.map(|_| ())
}

/// The rig at the asked pretension, if the model accepts it with the payload.
fn rig(args: &Args) -> Result<RigFile, Failure> {
    let mut rig = load_rig(args.rig.as_deref())?;
    rig.pretension_n = args.pretension_n.unwrap_or(rig.pretension_n);
    let hanging = rig.query(0.0, 0.0, args.payload_kg);
    match leg_model::evaluate(&rig.parameters, &hanging) {
        // The rig file was accepted and the payload checked, so that it is the pretension.
        Err(leg_model::Error::Refused { reason, .. }) => Err(Failure::refused(
            format!("--pretension-n {reason}"),
            "give a pretension within the tendons' curve",
        )),
        _ => Ok(rig),
    }
}

fn grid(args: &Args) -> Result<Grid, Failure> {
    let (azimuths, tilts) = (args.azimuths, args.tilts);
    if u64::from(azimuths) * u64::from(tilts) > POSES_MAX {
        let sentence = format!("a map of {azimuths} × {tilts} poses is too large");
        let help = format!("give at most {POSES_MAX} poses");
        return Err(Failure::refused(sentence, help));
    }
    Ok(Grid { azimuths, tilts })
}

fn nothing_feasible(rig: &RigFile, payload_kg: f64, map: &WorkspaceMap) -> Failure {
    if let Some((reason, count)) = map.reasons_for_no_result().first() {
        let all = map.cells.len();
        return Failure::failed(
            format!(
                "no pose of the workspace is known to be feasible with {payload_kg} kg: {count} of {all} have no \
                 result: {reason}"
            ),
            "give a smaller payload or change the rig",
        );
    }
    let sentence = format!(
        "no pose of the workspace is feasible with {payload_kg} kg and tensions from {} to {} N",
        rig.f_min_n, rig.f_max_n
    );
    Failure::failed(
        sentence,
        "give a smaller payload or wider bounds on the tensions",
    )
}

/// Every picture whole or not at all.
fn draw(args: &Args, rig: &RigFile, map: &WorkspaceMap) -> Result<Vec<PathBuf>, Failure> {
    let default = || image::workspace_root().join("target/leg-map");
    let directory = args.out.clone().unwrap_or_else(default);
    let asked = if args.quantity.is_empty() {
        MapQuantity::plain()
    } else {
        &args.quantity
    };
    let mut pictures = Vec::new();
    for &quantity in asked {
        let title = format!(
            "{}: payload {} kg, pretension {} N, support {}",
            capitalised(quantity.words()),
            args.payload_kg,
            rig.pretension_n,
            rig.support_name.word()
        );
        let field = PlotField::workspace(map, quantity, title);
        for (layout, suffix) in [(Layout::Flat, "contour"), (Layout::Polar, "polar")] {
            let stem = directory.join(format!("{}_{suffix}", quantity.name()));
            let picture = field::save(&field, layout, &stem);
            let refused = |error: PlotError| not_saved("picture", &directory, "--out", &error);
            pictures.push(picture.map_err(refused)?);
        }
    }
    Ok(pictures)
}

fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}
