//! Commands that write several files write all of them or none.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;
use std::process::Command;

fn leg(args: &[&str], directory: &Path) -> bool {
    let mut leg = Command::new(env!("CARGO_BIN_EXE_leg-under-test"));
    let output = leg.args(args).current_dir(directory).output().unwrap();
    output.status.success()
}

fn names(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_curve_is_not_written_without_its_plots_nor_they_without_it() {
    let directory = tempfile::tempdir().unwrap();
    let test = "force_n,elongation_mm\n0.5,0.01\n10,0.2\n50,0.9\n200,2.3\n";
    std::fs::write(directory.path().join("test.csv"), test).unwrap();
    let both = |out, plots| {
        leg(
            &["curve", "test.csv", "--out", out, "--plots", plots],
            directory.path(),
        )
    };
    assert!(!both("new.toml", "test.csv"));
    assert_eq!(names(directory.path()), ["test.csv"]);
    let taken = directory.path().join("plots/curve_stiffness.png");
    std::fs::create_dir_all(&taken).unwrap();
    assert!(!both("new.toml", "plots"));
    assert_eq!(names(directory.path()), ["plots", "test.csv"]);
    assert_eq!(
        names(&directory.path().join("plots")),
        ["curve_stiffness.png"]
    );
    std::fs::remove_dir(taken).unwrap();
    std::fs::create_dir(directory.path().join("taken.toml")).unwrap();
    assert!(!both("taken.toml", "plots"));
    assert!(names(&directory.path().join("plots")).is_empty());
    assert!(both("new.toml", "plots"));
    assert_eq!(names(&directory.path().join("plots")).len(), 6);
}

#[test]
fn no_figures_of_the_paper_stay_without_the_report() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::create_dir(directory.path().join("report.md")).unwrap();
    assert!(!leg(&["paper", "--out", "."], directory.path()));
    assert_eq!(names(directory.path()), ["report.md"]);
}
