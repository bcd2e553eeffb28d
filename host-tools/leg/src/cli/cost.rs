//! `leg cost`.

use super::{board, cost_image, print};
use indicatif::ProgressBar;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_bench::cost::{self, Cost};
use leg_boards::qemu::Clock;

/// Counts the instructions of the model's kernels on the emulated Cortex-M4F, against their budgets.
///
/// The counts are exact and the same in every run. A is hand-written C for one rig known at compile time, B is C++
/// with Eigen: the same work on the same core, by gcc 12 -O3 without contraction.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Measures the images instead: flash, RAM, a bound on the stack, and whether a panic can be reached.
    #[arg(long)]
    image: bool,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

const HEADING: &str = "\
kernel                                minimum  median  maximum   budget      A     B
";

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: a missing prerequisite, a link that fails, or a kernel or an image outside its budget.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    if args.image {
        return cost_image::run(args.json);
    }
    let mut link = board::qemu_with(Clock::Counting, verbose)?;
    let progress = ProgressBar::new(cost::counted() as u64);
    let measured = cost::measure(link.as_mut(), || progress.inc(1));
    progress.finish_and_clear();
    let costs = measured.map_err(|error| Failure::from_error(&error))?;
    print(&if args.json {
        to_line(&costs)?
    } else {
        table(&costs)
    })?;
    judge(&costs)
}

fn table(costs: &[Cost]) -> String {
    let rows: String = costs.iter().map(row).collect();
    let poses = cost::POSES;
    format!("Instructions on the emulated Cortex-M4F, over {poses} poses\n\n{HEADING}{rows}")
}

fn row(cost: &Cost) -> String {
    let reference = |count: Option<u32>| count.map_or("-".into(), |count| count.to_string());
    format!(
        "{:36}  {:7}  {:6}  {:7}   {:>4}-{:<4}  {:>4}  {:>4}{}\n",
        cost.kernel,
        cost.minimum,
        cost.median,
        cost.maximum,
        cost.budget.lowest,
        cost.budget.highest,
        reference(cost.budget.reference_a),
        reference(cost.budget.reference_b),
        if cost.held { "" } else { "  missed" },
    )
}

fn judge(costs: &[Cost]) -> Result<(), Failure> {
    let missed: Vec<&str> = costs
        .iter()
        .filter(|cost| !cost.held)
        .map(|cost| cost.kernel.as_str())
        .collect();
    if missed.is_empty() {
        return Ok(());
    }
    let sentence = format!("outside the budget: {}", missed.join("; "));
    let help = "look for what changed in the kernel or the compiler before you move a bound in cost/budget.rs";
    Err(Failure::missed(sentence, help))
}
