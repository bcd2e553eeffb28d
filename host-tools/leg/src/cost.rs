//! `leg cost`.

mod image;

use crate::options::Options;
use crate::output::require_none;
use crate::{board, progress};
use leg_base::failure::Failure;
use leg_bench::cost::{self, Cost};
use leg_boards::qemu::QemuClock;

/// Counts the instructions of the model's kernels on the emulated Cortex-M4F, against their budgets.
///
/// The counts are exact and the same in every run. A is hand-written C for one rig known at compile time, B is C++
/// with Eigen: the same work on the same core, by gcc 12 -O3 without contraction.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Measures the images instead: flash, RAM, a bound on the stack, and whether a panic can be reached.
    #[arg(long)]
    image: bool,
}

const HEADING: &str = "\
kernel                                minimum  median  maximum   budget      A     B
";

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    if args.image {
        return image::run(options);
    }
    let mut link = board::qemu(QemuClock::Counting, options)?;
    let progress = progress::bar(cost::measurements() as u64, "kernels");
    let measured = cost::measure(link.as_mut(), || progress.inc(1));
    progress.finish_and_clear();
    let costs = measured.map_err(Failure::from_error)?;
    options.report(&costs, || table(&costs))?;
    let failed = costs.iter().filter(|cost| !cost.passed);
    let names: Vec<String> = failed.map(|cost| cost.kernel.clone()).collect();
    let help = "look for what changed in the kernel or the compiler before you move a bound in cost/budget.rs";
    require_none("outside the budget", &names, help)
}

fn table(costs: &[Cost]) -> String {
    let rows: String = costs.iter().map(row).collect();
    let poses = cost::POSES;
    format!("Instructions on the emulated Cortex-M4F, over {poses} poses\n\n{HEADING}{rows}")
}

fn row(cost: &Cost) -> String {
    let reference = |count: Option<u32>| count.map_or("-".into(), |count| count.to_string());
    format!(
        "{:36}  {:7}  {:6}  {:7}   {:>4}-{:<4}  {:>4}  {:>4}  {}\n",
        cost.kernel,
        cost.minimum,
        cost.median,
        cost.maximum,
        cost.budget.lowest,
        cost.budget.highest,
        reference(cost.budget.reference_a),
        reference(cost.budget.reference_b),
        if cost.passed { "pass" } else { "FAIL" },
    )
}
