//! `leg calibrate cells`.

use super::hand::{Hand, drivers_off};
use crate::cli::leg_args::LegArgs;
use crate::cli::line::Fresh;
use crate::cli::numbers::not_negative;
use crate::cli::print;
use crate::cli::settings::before_armed;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_firmware::settings::Settings;
use leg_host::cell_fit::{CellFit, CellFitError, Weighing, fit};
use leg_host::operator::Operator;
use leg_rig::fields::decimal;
use serde::Serialize;
use std::time::Duration;

/// Readings that are averaged.
const READINGS: u32 = 200;

/// How far a weight may be off the straight line, as a part of the heaviest.
const RESIDUAL_PART: f64 = 0.01;

/// Time between two of them: at least a tick.
const READING_TIME: Duration = Duration::from_millis(2);

/// Finds zero and gain of a load cell with known weights, drivers off. Each hangs on the cell in the place of its tendon.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The load cell, 1 to 3.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=3))]
    cell: u8,
    /// The weights, kg, in the order in which they are hung; two at least, 0 is the empty hook.
    #[arg(long, value_name = "KG,...", value_delimiter = ',', required = true, value_parser = not_negative)]
    weights: Vec<f64>,
    /// Sets the board to it, too, and reads it back. The leg has to be homed then.
    #[arg(long)]
    set: bool,
    /// Keeps that over a reset.
    #[arg(long, requires = "set")]
    save: bool,
    #[command(flatten)]
    leg: LegArgs,
}

/// What was found, for machines.
#[derive(Serialize)]
struct CellReport {
    cell: u8,
    #[serde(flatten)]
    fit: CellFit,
    cell_n_per_code: [f32; 3],
    cell_zero_code: [f32; 3],
}

pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let refused = |error: CellFitError| Failure::refused(error.to_string(), error.remedy());
    let first = args.weights.first();
    if args.weights.iter().all(|weight| Some(weight) == first) {
        return Err(refused(CellFitError::OneWeight));
    }
    let mut line = args.leg.open(Fresh::Slack, verbose)?;
    let operator = &mut line.operator;
    drivers_off(operator, "let weights be hung on its cells")?;
    let mut settings = operator.settings()?;
    let cell = usize::from(args.cell) - 1;
    let hand = Hand::of(line.emulated.as_ref());
    let gravity = f64::from(settings.rig.gravity_m_per_s2);
    let mut weighings = Vec::new();
    for &kg in &args.weights {
        let newtons = kg * gravity;
        hand.hang(operator, cell, [kg, newtons])?;
        weighings.push(Weighing {
            newtons,
            code: mean_code(operator, cell)?,
        });
    }
    let found = fit(&weighings).map_err(refused)?;
    let axis = &mut settings.axes[cell];
    axis.cell_n_per_code = found.n_per_code as f32;
    axis.cell_zero_code = found.zero_code as f32;
    report(args, &weighings, &found, &settings)?;
    straight(args.cell, &weighings, &found)?;
    if args.set {
        set(operator, &settings, args.save)?;
    }
    Ok(())
}

/// Refuses weights that no straight line explains: one was not what was said, or hung somewhere else.
fn straight(cell: u8, weighings: &[Weighing], found: &CellFit) -> Result<(), Failure> {
    let newtons = weighings.iter().map(|weighing| weighing.newtons);
    let heaviest_n = newtons.fold(0.0, f64::max);
    if found.residual_n <= RESIDUAL_PART * heaviest_n {
        return Ok(());
    }
    Err(Failure::missed(
        format!(
            "load cell {cell} is off a straight line by {:.3} N, more than {} % of the heaviest weight",
            found.residual_n,
            RESIDUAL_PART * 100.0
        ),
        "hang the weights again, in the order in which they were given; nothing was set",
    ))
}

fn mean_code(operator: &mut Operator, cell: usize) -> Result<f64, Failure> {
    let mut sum = 0.0;
    for _ in 0..READINGS {
        sum += f64::from(operator.sensors()?.cell_codes[cell]);
        operator.pause(READING_TIME)?;
    }
    Ok(sum / f64::from(READINGS))
}

fn report(
    args: &Args,
    weighings: &[Weighing],
    found: &CellFit,
    settings: &Settings,
) -> Result<(), Failure> {
    let axes = &settings.axes;
    let cell_n_per_code = axes.each_ref().map(|axis| axis.cell_n_per_code);
    let cell_zero_code = axes.each_ref().map(|axis| axis.cell_zero_code);
    if args.leg.json {
        return print(&to_line(&CellReport {
            cell: args.cell,
            fit: *found,
            cell_n_per_code,
            cell_zero_code,
        })?);
    }
    let rows: String = args
        .weights
        .iter()
        .zip(weighings)
        .map(|(kg, weighing)| {
            let told = whole_mn((weighing.code - found.zero_code) * found.n_per_code);
            let Weighing { newtons, code } = weighing;
            format!(
                "{kg:8.3} {newtons:9.3} {code:9.1} {told:9.3} {:8.3}\n",
                whole_mn(told - newtons)
            )
        })
        .collect();
    let list = |numbers: [f32; 3]| numbers.map(|number| decimal(number).to_string()).join(", ");
    print(&format!(
        "      kg         N      code    told N    off N\n{rows}\n\
         Load cell {}: {:.6} N by code, {:.1} without tension, off by at most {:.3} N\n\n\
         [calibration]\ncell_n_per_code = [{}]\ncell_zero_code = [{}]\n",
        args.cell,
        found.n_per_code,
        found.zero_code,
        found.residual_n,
        list(cell_n_per_code),
        list(cell_zero_code),
    ))
}

/// Rounded to a millinewton, without a sign where that is zero.
fn whole_mn(newtons: f64) -> f64 {
    (newtons * 1000.0).round() / 1000.0 + 0.0
}

fn set(operator: &mut Operator, settings: &Settings, save: bool) -> Result<(), Failure> {
    operator.set_settings(&settings.without_zero())?;
    if save {
        operator.save_settings()?;
    }
    let next = before_armed(operator)?;
    eprintln!("leg: the board is set to it; put the tendon back; {next}");
    Ok(())
}
