//! `leg map`.

use super::map_report::Report;
use super::{print, progress};
use leg_base::failure::Failure;
use leg_boards::image;
use leg_model_tools::map_csv;
use leg_model_tools::plot::field::{self, Layout};
use leg_model_tools::workspace_map::{Grid, Quantity, WorkspaceMap};
use leg_rig::rig_file::RigFile;
use std::path::PathBuf;

/// Draws the rig over its workspace: deviation, stiffness, tension margin, feasible pretensions.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The rig file or a ready rig's name; the paper's rig if left out.
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Mass at the tip, kg.
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    payload_kg: f64,
    /// Pretension, N; the rig's if left out.
    #[arg(long, alias = "level-n", allow_negative_numbers = true)]
    pretension_n: Option<f64>,
    /// Columns of the map, at least 3.
    #[arg(long, default_value_t = 360)]
    azimuths: u32,
    /// Rows of the map, at least 2.
    #[arg(long, default_value_t = 31)]
    tilts: u32,
    /// What to draw; all but the nonlinear ones if left out. Those are computed only if asked for here.
    #[arg(long, value_enum)]
    quantity: Vec<Quantity>,
    /// The directory for the pictures; target/leg-map in the workspace if left out.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Writes every pose to a CSV file as well.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Prints JSON with every pose instead of a table.
    #[arg(long)]
    json: bool,
}

/// The most poses of one map.
const POSES_MAX: u64 = 10_000_000;

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a rig file or number that is refused, no feasible pose, files that cannot be written.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let rig = rig(args)?;
    let grid = grid(args)?;
    let bar = progress::bar(grid.tilts.into(), "rows");
    let done = || bar.inc(1);
    let map = if args.quantity.iter().any(|asked| asked.is_nonlinear()) {
        WorkspaceMap::compute_with_nonlinear(&rig, args.payload_kg, grid, done)
    } else {
        WorkspaceMap::compute(&rig, args.payload_kg, grid, done)
    };
    bar.finish_and_clear();
    if map.counts().feasible == 0 {
        return Err(nothing_feasible(&rig, args.payload_kg, &map));
    }
    let pictures = match &args.csv {
        Some(file) => map_csv::save_around(&map, file, || draw(args, &rig, &map))?,
        None => draw(args, &rig, &map)?,
    };
    let report = Report {
        rig: &rig,
        payload_kg: args.payload_kg,
        map: &map,
        pictures: &pictures,
        csv: args.csv.as_deref(),
    };
    print(&if args.json {
        report.json()?
    } else {
        report.table()
    })
}

/// The rig at the asked pretension, if the model accepts it with the payload.
fn rig(args: &Args) -> Result<RigFile, Failure> {
    let mut rig = RigFile::load(args.rig.as_deref())?;
    rig.pretension_n = args.pretension_n.unwrap_or(rig.pretension_n);
    let hanging = rig.query(0.0, 0.0, args.payload_kg);
    match leg_model::evaluate(&rig.parameters, &hanging) {
        Err(leg_model::Error::Refused { quantity, reason }) => Err(refused(quantity, reason)),
        _ => Ok(rig),
    }
}

/// The rig itself was accepted with its file, so that only what the command line gives can be refused.
fn refused(quantity: leg_model::Quantity, reason: leg_model::Reason) -> Failure {
    let (argument, help) = match quantity {
        leg_model::Quantity::Payload => ("--payload-kg", "give 0 to 1e6"),
        _ => (
            "--pretension-n",
            "give a pretension within the tendons' curve, from -1e7 to 1e7",
        ),
    };
    Failure::refused(format!("{argument} {reason}"), help)
}

fn grid(args: &Args) -> Result<Grid, Failure> {
    let (azimuths, tilts) = (args.azimuths, args.tilts);
    if azimuths < 3 || tilts < 2 {
        let sentence = format!("a map of {azimuths} × {tilts} poses cannot be drawn");
        let help = "give at least --azimuths 3 and --tilts 2";
        return Err(Failure::refused(sentence, help));
    }
    if u64::from(azimuths) * u64::from(tilts) > POSES_MAX {
        let sentence = format!("a map of {azimuths} × {tilts} poses is too large");
        let help = format!("give at most {POSES_MAX} poses");
        return Err(Failure::refused(sentence, help));
    }
    Ok(Grid { azimuths, tilts })
}

fn nothing_feasible(rig: &RigFile, payload_kg: f64, map: &WorkspaceMap) -> Failure {
    if let Some((reason, count)) = map.without_result().first() {
        let all = map.cells.len();
        return Failure::missed(
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
    Failure::missed(
        sentence,
        "give a smaller payload or wider bounds on the tensions",
    )
}

/// Every picture whole or not at all.
fn draw(args: &Args, rig: &RigFile, map: &WorkspaceMap) -> Result<Vec<PathBuf>, Failure> {
    let default = || image::workspace_root().join("target/leg-map");
    let directory = args.out.clone().unwrap_or_else(default);
    let asked = if args.quantity.is_empty() {
        Quantity::plain()
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
        let field = map.field(quantity, title);
        for (layout, suffix) in [(Layout::Flat, "contour"), (Layout::Polar, "polar")] {
            let stem = directory.join(format!("{}_{suffix}", quantity.name()));
            let picture = field::save_both(&field, layout, &stem).map_err(|error| {
                let sentence = format!("no picture in {}: {error}", directory.display());
                Failure::refused(sentence, "name another directory with --out")
            });
            pictures.push(picture?);
        }
    }
    Ok(pictures)
}

fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}
