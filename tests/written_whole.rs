//! Commands that write several files write all of them or none.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;
use std::process::Command;

fn leg(args: &[&str], folder: &Path) -> bool {
    let mut leg = Command::new(env!("CARGO_BIN_EXE_leg-under-test"));
    let output = leg.args(args).current_dir(folder).output().unwrap();
    output.status.success()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_curve_is_not_written_without_its_plots_nor_they_without_it() {
    let folder = tempfile::tempdir().unwrap();
    let test = "force_n,elongation_mm\n0.5,0.01\n10,0.2\n50,0.9\n200,2.3\n";
    std::fs::write(folder.path().join("test.csv"), test).unwrap();
    let both = |out, plots| {
        leg(
            &["curve", "test.csv", "--out", out, "--plots", plots],
            folder.path(),
        )
    };
    assert!(!both("new.toml", "test.csv"));
    assert_eq!(names(folder.path()), ["test.csv"]);
    let taken = folder.path().join("plots/curve_stiffness.png");
    std::fs::create_dir_all(&taken).unwrap();
    assert!(!both("new.toml", "plots"));
    assert_eq!(names(folder.path()), ["plots", "test.csv"]);
    assert_eq!(names(&folder.path().join("plots")), ["curve_stiffness.png"]);
    std::fs::remove_dir(taken).unwrap();
    std::fs::create_dir(folder.path().join("taken.toml")).unwrap();
    assert!(!both("taken.toml", "plots"));
    assert!(names(&folder.path().join("plots")).is_empty());
    assert!(both("new.toml", "plots"));
    assert_eq!(names(&folder.path().join("plots")).len(), 4);
}

#[test]
fn no_figures_of_the_paper_stay_without_the_report() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("report.md")).unwrap();
    assert!(!leg(&["paper", "--out", "."], folder.path()));
    assert_eq!(names(folder.path()), ["report.md"]);
}
