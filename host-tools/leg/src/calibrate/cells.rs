//! `leg calibrate cells`.

use super::manual_steps::manual_step;
use crate::connection::{LegArgs, LegConnection, Purpose};
use crate::numbers::not_negative;
use crate::options::Options;
use crate::output::note;
use crate::settings::next_step;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_firmware::settings::Settings;
use leg_host::calibration::{
    CellFit, KnownWeight, fit, mean_code, require_drivers_off, too_few_weights,
};
use leg_host::operator::Operator;
use leg_rig::number::decimal;

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

pub(super) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let first = args.weights.first();
    if args.weights.iter().all(|weight| Some(weight) == first) {
        return Err(too_few_weights());
    }
    let mut connection = args.leg.open(Purpose::Calibrate, options)?;
    require_drivers_off(&mut connection.operator, "let weights be hung on its cells")?;
    let mut settings = connection.operator.settings()?;
    let weighings = weigh(args, &mut connection, &settings)?;
    let fit = fit(&weighings)?;
    calibrate(&mut settings, args, &fit);
    let n_per_code = settings.axes.each_ref().map(|axis| axis.cell_n_per_code);
    let zero_code = settings.axes.each_ref().map(|axis| axis.cell_zero_code);
    let json = json_object! {
        cell: args.cell,
        #[serde(flatten)]
        fit: fit,
        cell_n_per_code: n_per_code,
        cell_zero_code: zero_code,
    };
    options.report(&json, || {
        let list = |numbers: [f32; 3]| numbers.map(|number| decimal(number).to_string()).join(", ");
        format!(
            "{}\n[calibration]\ncell_n_per_code = [{}]\ncell_zero_code = [{}]\n",
            table(args, &weighings, &fit),
            list(n_per_code),
            list(zero_code),
        )
    })?;
    fit.require_straight(args.cell, &weighings)?;
    if args.set {
        set(&mut connection.operator, args, &fit)?;
    }
    Ok(())
}

fn calibrate(settings: &mut Settings, args: &Args, fit: &CellFit) {
    let axis = &mut settings.axes[usize::from(args.cell) - 1];
    axis.cell_n_per_code = fit.n_per_code as f32;
    axis.cell_zero_code = fit.zero_code as f32;
}

fn weigh(
    args: &Args,
    connection: &mut LegConnection,
    settings: &Settings,
) -> Result<Vec<KnownWeight>, Failure> {
    let (number, cell) = (args.cell, usize::from(args.cell) - 1);
    let gravity = f64::from(settings.rig.gravity_m_per_s2);
    let mut weighings = Vec::new();
    for kg in &args.weights {
        let newtons = kg * gravity;
        let step = format!("hang {kg} kg on load cell {number} in the place of its tendon");
        manual_step(connection, &step, |plant| {
            plant.hang_on_cell(cell, Some(newtons));
        })?;
        let code = mean_code(&mut connection.operator, cell)?;
        weighings.push(KnownWeight { newtons, code });
    }
    Ok(weighings)
}

fn table(args: &Args, weighings: &[KnownWeight], fit: &CellFit) -> String {
    let row = |(kg, &KnownWeight { newtons, code }): (&f64, &KnownWeight)| {
        let cell_n = whole_mn((code - fit.zero_code) * fit.n_per_code);
        let off_n = whole_mn(cell_n - newtons);
        format!("{kg:8.3} {newtons:9.3} {code:9.1} {cell_n:9.3} {off_n:8.3}\n")
    };
    let rows: String = args.weights.iter().zip(weighings).map(row).collect();
    format!(
        "      kg         N      code    cell N    off N\n{rows}\n\
         Load cell {}: {:.6} N per code, {:.1} without tension, off by at most {:.3} N\n",
        args.cell, fit.n_per_code, fit.zero_code, fit.residual_n,
    )
}

/// Rounded to a millinewton, without a sign where that is zero.
fn whole_mn(newtons: f64) -> f64 {
    (newtons * 1000.0).round() / 1000.0 + 0.0
}

fn set(operator: &mut Operator, args: &Args, fit: &CellFit) -> Result<(), Failure> {
    // Another host may have set something else while the weights were hung: that stays.
    let mut settings = operator.settings()?;
    calibrate(&mut settings, args, fit);
    operator.set_settings(&settings.unhomed())?;
    if args.save {
        operator.save_settings()?;
    }
    let next = next_step(operator)?;
    note(&format!(
        "leg: the board is set to it; put the tendon back; {next}"
    ));
    Ok(())
}
