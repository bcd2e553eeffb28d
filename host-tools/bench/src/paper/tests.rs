#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::kinematics::CONFIGURATIONS;
use super::{Paper, Verdict, draw, markdown};

fn ours(paper: &Paper, what: &str) -> f64 {
    let row = paper.rows.iter().find(|row| row.what.contains(what));
    row.unwrap_or_else(|| panic!("no row {what}")).ours
}

fn assert_near(paper: &Paper, what: &str, expected: f64, within: f64) {
    let found = ours(paper, what);
    assert!((found - expected).abs() <= within, "{what}: {found}");
}

#[test]
fn every_verdict_is_the_known_one() {
    let paper = Paper::compute().unwrap();
    let surprises: Vec<_> = paper.surprises().collect();
    assert!(surprises.is_empty(), "{surprises:#?}");
    let differing = paper
        .rows
        .iter()
        .filter(|row| row.verdict() == Verdict::Differs);
    assert!((3..=8).contains(&differing.count()));
}

#[test]
fn the_numbers_are_the_known_ones() {
    let paper = Paper::compute().unwrap();
    let deviations = [
        (0.0, 2.0, 2.023),
        (0.5, 3.6, 3.635),
        (1.0, 5.3, 5.238),
        (2.0, 8.5, 8.418),
    ];
    for (payload, published, expected) in deviations {
        let what = format!("largest deviation with {payload} kg");
        // Both the maxima and the stiffness are given with four digits.
        assert_near(&paper, &what, expected, 0.001);
        // One stiffness fits four published maxima, which are read off a figure, within 0.1 mm.
        assert_near(&paper, &what, published, 0.1);
    }
    assert_near(&paper, "on average", 3.9, 0.1);
    assert_near(&paper, "load's own stiffness, at most", 0.5, 0.1);
    for (tilt, expected) in [(10, 0.15), (20, 1.34), (30, 5.46)] {
        assert_near(&paper, &format!("at a tilt of {tilt}°"), expected, 0.005);
    }
    assert_near(&paper, "Eq. (24), L_upper = 6 mm: moment", 99.93, 0.005);
    assert_near(&paper, "Eq. (25), L_upper = 0: moment", 100.03, 0.005);
}

/// Table 3 prints N·m; with its forces it can only be N·mm, about y alone.
#[test]
fn the_tensions_of_table_3_have_no_moment_beside_that_about_y() {
    for configuration in &CONFIGURATIONS {
        let (_, moment_map) = configuration.model().unwrap();
        let moment_nm = moment_map * configuration.tensions_n;
        assert!(moment_nm.x.abs() < 1e-12 && moment_nm.z.abs() < 1e-12);
    }
}

/// Every number that the paper prints of its results.
#[test]
fn every_published_number_has_its_row() {
    let paper = Paper::compute().unwrap();
    let all: Vec<f64> = paper
        .rows
        .iter()
        .chain(&paper.entries)
        .map(|row| row.published)
        .collect();
    let printed = [
        -0.5084, 0.9173, 19.0664, 8.2748, -0.6522, 18.4579, 9.5554, // Eqs. (24), (25)
        -2.44, -2.64, -0.7, 2.38, -0.52, 2.33, 100.0, // Table 3
        29_000.0, 15_000.0, 8.0, // Fig. 6
        2.0, 3.6, 5.3, 8.5, 1.5, 3.4, 3.1, 3.8, 2.5, 4.2, 0.6, 0.9, 4.7, // Fig. 9
        1.4, // Fig. 10
    ];
    for number in printed {
        assert!(all.contains(&number), "no row for {number}");
    }
    assert_eq!(paper.entries.len(), 36);
}

#[test]
fn every_erratum_has_two_numbers_that_differ() {
    let paper = Paper::compute().unwrap();
    assert_eq!(paper.errata.len(), 15);
    for erratum in &paper.errata {
        let scale = erratum.printed.abs().max(erratum.corrected.abs());
        let difference = (erratum.printed - erratum.corrected).abs();
        assert!(difference > 0.15 * scale, "{erratum:?}");
    }
    let erratum = |place: &str| {
        paper
            .errata
            .iter()
            .find(|erratum| erratum.place == place)
            .unwrap()
    };
    assert!(erratum("Eq. (1)").corrected < 1e-14 && erratum("Eq. (15)").corrected < 1e-7);
    assert!(erratum("Eqs. (5), (6), (23)").corrected < 1e-12);
    assert!((erratum("Sec. 4").corrected / erratum("Sec. 4").printed - 32.0 / 15.0).abs() < 1e-9);
}

#[test]
fn the_report_names_every_row_and_every_picture() {
    let directory = tempfile::tempdir().unwrap();
    let figures = draw(directory.path()).unwrap();
    assert_eq!(figures.len(), 8);
    let paper = Paper::compute().unwrap();
    let report = markdown(&paper, &figures);
    for (path, caption) in &figures {
        for kind in ["svg", "png", "pdf"] {
            assert!(path.with_extension(kind).exists(), "{kind}");
        }
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(report.contains(&format!("![{caption}]({name})")));
    }
    for row in &paper.rows {
        assert!(
            report.contains(&row.what) && report.contains(row.why),
            "{}",
            row.what
        );
    }
    assert!(!report.contains("NaN"));
}
