//! `leg cost --image`.

use crate::board;
use crate::options::Options;
use crate::output::require_none;
use leg_base::failure::Failure;
use leg_bench::image_budget::{
    self, BudgetCheck, EXCEPTION_ENTRY, ImageBudget, ImageNeeds, Root, RootKind,
};
use leg_boards::image::FirmwareImage;
use serde::Serialize;
use std::fs;

/// What an image needs, and whether it may.
#[derive(Debug, Serialize)]
struct Judged {
    image: &'static str,
    needs: ImageNeeds,
    checks: Vec<BudgetCheck>,
}

const HEADING: &str = "\
what                                    bytes   there are   budget
";

const ROOTS_HEADING: &str = "\
root              kind          stack  calls by address  panic
";

/// Builds both images and measures them.
pub(super) fn run(options: Options) -> Result<(), Failure> {
    board::prepare_target()?;
    let judged: Result<Vec<Judged>, Failure> = FirmwareImage::ALL.into_iter().map(judged).collect();
    let judged = judged?;
    options.report(&judged, || table(&judged))?;
    require_passed(&judged)
}

fn judged(board: FirmwareImage) -> Result<Judged, Failure> {
    let elf = board::build_image(board)?;
    let bytes = fs::read(&elf).map_err(|error| {
        let sentence = format!("cannot read {}: {error}", elf.display());
        Failure::refused(sentence, "build it again with `leg setup`")
    })?;
    let needs = image_budget::needs(&bytes).map_err(Failure::from_error)?;
    let budget = ImageBudget::new(board);
    let checks = image_budget::checks(&needs, &budget);
    Ok(Judged {
        image: board.binary(),
        checks: checks.map_err(Failure::from_error)?,
        needs,
    })
}

fn table(judged: &[Judged]) -> String {
    let tables: Vec<String> = judged.iter().map(image_table).collect();
    let note = format!(
        "The stack's bound: the deepest chain of calls below each root, all of them on top of each other with the\n\
         {EXCEPTION_ENTRY} bytes that the core adds for each but the thread.\n"
    );
    tables.join("\n") + "\n" + &note
}

fn image_table(judged: &Judged) -> String {
    let checks: String = judged.checks.iter().map(check_row).collect();
    let roots: String = judged.needs.roots.iter().map(root_row).collect();
    format!(
        "{}\n\n{HEADING}{checks}\n{ROOTS_HEADING}{roots}",
        judged.image
    )
}

fn check_row(check: &BudgetCheck) -> String {
    format!(
        "{:36}  {:7}     {:7}   {}-{}  {}\n",
        check.what,
        check.usage.used,
        check.usage.size,
        check.bounds.lowest,
        check.bounds.highest,
        if check.passed { "pass" } else { "FAIL" },
    )
}

fn root_row(root: &Root) -> String {
    let kind = match root.kind {
        RootKind::Thread => "thread",
        RootKind::Exception => "exception",
        RootKind::Interrupt => "interrupt",
    };
    let calls: usize = root.indirect.iter().map(|caller| caller.calls).sum();
    let undeclared = root
        .indirect
        .iter()
        .filter(|caller| !caller.declared)
        .count();
    let calls = match undeclared {
        0 => calls.to_string(),
        _ => format!("{calls}, {undeclared} unknown"),
    };
    // The function that begins the panic says nothing: the one before it does.
    let panic = root.panic.as_ref().map_or_else(
        || "none".to_owned(),
        |way| {
            way.iter()
                .rev()
                .nth(1)
                .map_or("at once".into(), |last| format!("in {last}"))
        },
    );
    format!(
        "{:16}  {kind:9}  {:8}  {calls:>16}  {panic}\n",
        root.name, root.stack_bytes
    )
}

fn require_passed(judged: &[Judged]) -> Result<(), Failure> {
    let failed = judged.iter().flat_map(|judged| {
        let failed = judged.checks.iter().filter(|check| !check.passed);
        failed.map(|check| format!("{} of {}", check.what, judged.image))
    });
    let failed: Vec<String> = failed.collect();
    let help = "look for what changed in the image before you move a bound in image_budget/budget.rs; --json reports which calls take the stack and lead to a panic";
    require_none("outside the budget", &failed, help)
}
