//! `leg calibrate cells`.

use super::manual_steps::{ManualSteps, require_drivers_off};
use crate::connection::{LegArgs, Purpose};
use crate::numbers::not_negative;
use crate::options::Options;
use crate::settings::next_step;
use leg_base::failure::Failure;
use leg_firmware::settings::Settings;
use leg_host::cell_fit::{CellFit, CellFitError, KnownWeight, fit};
use leg_host::operator::Operator;
use leg_rig::number::decimal;
use serde::Serialize;
use std::time::Duration;

/// Readings that are averaged: noise of a few codes falls below a tenth of a code.
const READINGS: u32 = 200;

/// How far a weight may be off the straight line, as a part of the heaviest.
const RESIDUAL_PART: f64 = 0.01;

/// Time between two readings: at least a tick.
const READING_TIME: Duration = Duration::from_millis(2);

/// Finds zero and gain of a load cell by known weights, drivers off. Each hangs on the cell in the place of its tendon.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The load cell, 1 to 3.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=3))]
    cell: u8,
    /// The weights, kg, in the order in which they are hung; at least two, 0 is the empty hook.
    #[arg(long, value_name = "KG,...", value_delimiter = ',', required = true, value_parser = not_negative)]
    weights: Vec<f64>,
    /// Sets the board to the result and reads it back. The leg must be homed again afterwards.
    #[arg(long)]
    set: bool,
    /// Keeps the result over a reset.
    #[arg(long, requires = "set")]
    save: bool,
    #[command(flatten)]
    leg: LegArgs,
}

#[derive(Serialize)]
struct CellReport<'a> {
    cell: u8,
    #[serde(flatten)]
    fit: CellFit,
    cell_n_per_code: [f32; 3],
    cell_zero_code: [f32; 3],
    #[serde(skip)]
    weights_kg: &'a [f64],
    #[serde(skip)]
    weighings: &'a [KnownWeight],
}

pub(super) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let refused = |error: CellFitError| Failure::refused(error.to_string(), error.remedy());
    let first = args.weights.first();
    if args.weights.iter().all(|weight| Some(weight) == first) {
        return Err(refused(CellFitError::OneWeight));
    }
    let mut connection = args.leg.open(Purpose::Calibrate, options)?;
    let operator = &mut connection.operator;
    require_drivers_off(operator, "let weights be hung on its cells")?;
    let mut settings = operator.settings()?;
    let steps = ManualSteps::new(connection.emulated.as_ref());
    let weighings = weigh(args, operator, &steps, &settings)?;
    let fit = fit(&weighings).map_err(refused)?;
    let axis = &mut settings.axes[usize::from(args.cell) - 1];
    axis.cell_n_per_code = fit.n_per_code as f32;
    axis.cell_zero_code = fit.zero_code as f32;
    let axes = &settings.axes;
    let report = CellReport {
        cell: args.cell,
        fit,
        cell_n_per_code: axes.each_ref().map(|axis| axis.cell_n_per_code),
        cell_zero_code: axes.each_ref().map(|axis| axis.cell_zero_code),
        weights_kg: &args.weights,
        weighings: &weighings,
    };
    options.report(&report, CellReport::text)?;
    report.require_straight()?;
    if args.set {
        set(operator, &settings, args.save)?;
    }
    Ok(())
}

fn weigh(
    args: &Args,
    operator: &mut Operator,
    steps: &ManualSteps<'_>,
    settings: &Settings,
) -> Result<Vec<KnownWeight>, Failure> {
    let cell = usize::from(args.cell) - 1;
    let gravity = f64::from(settings.rig.gravity_m_per_s2);
    let mut weighings = Vec::new();
    for &kg in &args.weights {
        let newtons = kg * gravity;
        steps.hang_weight(operator, cell, [kg, newtons])?;
        let code = mean_code(operator, cell)?;
        weighings.push(KnownWeight { newtons, code });
    }
    Ok(weighings)
}

fn mean_code(operator: &mut Operator, cell: usize) -> Result<f64, Failure> {
    let mut sum = 0.0;
    for _ in 0..READINGS {
        sum += f64::from(operator.sensors()?.cell_codes[cell]);
        operator.pause(READING_TIME)?;
    }
    Ok(sum / f64::from(READINGS))
}

impl CellReport<'_> {
    fn text(&self) -> String {
        let rows: String = self
            .weights_kg
            .iter()
            .zip(self.weighings)
            .map(|(kg, weighing)| self.row(*kg, weighing))
            .collect();
        let list = |numbers: [f32; 3]| numbers.map(|number| decimal(number).to_string()).join(", ");
        format!(
            "      kg         N      code    cell N    off N\n{rows}\n\
             Load cell {}: {:.6} N per code, {:.1} without tension, off by at most {:.3} N\n\n\
             [calibration]\ncell_n_per_code = [{}]\ncell_zero_code = [{}]\n",
            self.cell,
            self.fit.n_per_code,
            self.fit.zero_code,
            self.fit.residual_n,
            list(self.cell_n_per_code),
            list(self.cell_zero_code),
        )
    }

    fn row(&self, kg: f64, &KnownWeight { newtons, code }: &KnownWeight) -> String {
        let cell_n = whole_mn((code - self.fit.zero_code) * self.fit.n_per_code);
        let off_n = whole_mn(cell_n - newtons);
        format!("{kg:8.3} {newtons:9.3} {code:9.1} {cell_n:9.3} {off_n:8.3}\n")
    }

    /// Fails where no straight line explains the weights: one was not what was said, or hung somewhere else.
    fn require_straight(&self) -> Result<(), Failure> {
        let newtons = self.weighings.iter().map(|weighing| weighing.newtons);
        let heaviest_n = newtons.fold(0.0, f64::max);
        if self.fit.residual_n <= RESIDUAL_PART * heaviest_n {
            return Ok(());
        }
        Err(Failure::failed(
            format!(
                "load cell {} is off a straight line by {:.3} N, more than {} % of the heaviest weight",
                self.cell,
                self.fit.residual_n,
                RESIDUAL_PART * 100.0
            ),
            "hang the weights again, in the order in which they were given; nothing was set",
        ))
    }
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
    let next = next_step(operator)?;
    eprintln!("leg: the board is set to it; put the tendon back; {next}");
    Ok(())
}
