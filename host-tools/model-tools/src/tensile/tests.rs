#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Fit, TensileError, read};
use leg_model::{CurvePoint, Elasticity, TendonCurve};
use std::fmt::Write;
use std::path::Path;

fn paper() -> TendonCurve<f64> {
    TendonCurve::new(&CurvePoint::<f64>::PAPER).unwrap()
}

fn fit(text: &str) -> Result<Fit, TensileError> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("test.csv");
    std::fs::write(&path, text).unwrap();
    Fit::new(&read(&path)?, None)
}

/// A test of the paper's tendon in newtons and millimetres, with slack and a lag on the way back.
fn sampled(step_n: f64, take_up_mm: f64, lag_mm: f64) -> String {
    let mut text = String::from("force_n,elongation_mm\n");
    let elongation_mm = |force: f64| take_up_mm + 1e3 * paper().elongation(force).unwrap();
    if take_up_mm > 0.0 {
        writeln!(text, "0,0\n0.05,{}", 0.6 * take_up_mm).unwrap();
    }
    let steps = (199.0 / step_n) as i32;
    for step in 1..=steps {
        let force = step_n * f64::from(step);
        writeln!(text, "{force},{}", elongation_mm(force)).unwrap();
    }
    if lag_mm > 0.0 {
        for step in (1..steps).rev() {
            let force = step_n * f64::from(step);
            let lag = lag_mm * (1.0 - force / (step_n * f64::from(steps)));
            writeln!(text, "{force},{}", elongation_mm(force) + lag).unwrap();
        }
    }
    text
}

fn assert_papers(fit: &Fit, elongation_m: f64, stiffness: f64) {
    let found = TendonCurve::new(&fit.points).unwrap();
    for force in [5.0, 9.0, 20.0, 50.0, 70.0, 100.0, 150.0, 190.0] {
        let off = found.elongation(force).unwrap() - paper().elongation(force).unwrap();
        assert!(off.abs() < elongation_m, "{force} N: {off:e} m");
        let ratio = found.stiffness(force).unwrap() / paper().stiffness(force).unwrap();
        assert!((ratio - 1.0).abs() < stiffness, "{force} N: {ratio}");
    }
}

#[test]
fn the_papers_curve_comes_back() {
    let found = fit(&sampled(0.5, 0.0, 0.0)).unwrap();
    assert_papers(&found, 2e-6, 0.04);
    assert!(found.take_up_m.abs() < 2e-6);
    assert!(found.error_max_m < 2e-6 && found.error_rms_m <= found.error_max_m);
    assert!(found.points.len() <= 16 && found.hysteresis.is_none());
}

#[test]
fn take_up_and_the_way_back_leave_the_curve_as_it_is() {
    let found = fit(&sampled(0.5, 0.8, 0.05)).unwrap();
    assert_papers(&found, 2e-6, 0.04);
    assert!(
        (found.take_up_m - 0.8e-3).abs() < 2e-6,
        "{}",
        found.take_up_m
    );
    let hysteresis = found.hysteresis.unwrap();
    assert!(
        (hysteresis.elongation_m - 0.05e-3).abs() < 1e-6,
        "{hysteresis:?}"
    );
    assert!((0.005..0.05).contains(&hysteresis.lost), "{hysteresis:?}");
}

#[test]
fn units_are_read_from_the_header() {
    let rows = "1,10\n2,30\n4,50\n";
    let elongation = |text: &str, force: f64| {
        let curve = TendonCurve::new(&fit(text).unwrap().points).unwrap();
        curve.elongation(force).unwrap()
    };
    let newtons = elongation(&format!("force_n,elongation_mm\n{rows}"), 3.0);
    let kilo = elongation(
        &format!("# by hand\n\nforce_kn, elongation_um\n{rows}"),
        3e3,
    );
    assert!((newtons * 1e-3 / kilo - 1.0).abs() < 1e-12);
    let metres = elongation("elongation_m,force_n\n10,1\n30,2\n50,4\n", 3.0);
    assert!((metres / newtons / 1e3 - 1.0).abs() < 1e-12);
}

#[test]
fn noise_does_not_bend_the_curve() {
    let mut rng = fastrand::Rng::with_seed(3);
    let mut text = String::from("force_n,elongation_mm\n");
    for step in 1..=199 {
        let force = f64::from(step);
        // A fifth of what the elongation grows from row to row at the top.
        let noise = 8e-4 * (2.0 * rng.f64() - 1.0);
        let elongation_mm = 1e3 * paper().elongation(force).unwrap() + noise;
        writeln!(text, "{force},{elongation_mm}").unwrap();
    }
    let found = fit(&text).unwrap();
    assert!(found.error_rms_m < 8e-7, "{:e}", found.error_rms_m);
    let curve = TendonCurve::new(&found.points).unwrap();
    for force in 5..=199 {
        let force = f64::from(force);
        let ratio = curve.stiffness(force).unwrap() / paper().stiffness(force).unwrap();
        let bound = if force < 15.0 { 0.16 } else { 0.05 };
        assert!((ratio - 1.0).abs() < bound, "{force} N: {ratio}");
    }
}

#[test]
fn few_rows_are_met() {
    let rows = "1,0.1\n5,0.45\n20,1\n60,1.6\n100,1.9\n";
    let found = fit(&format!("force_n,elongation_mm\n{rows}")).unwrap();
    assert!(found.error_max_m < 2e-5 * 1.9e-3, "{:e}", found.error_max_m);
}

#[test]
fn branches_with_rows_at_other_forces_are_compared_at_equal_force() {
    let mut text = sampled(5.0, 0.0, 0.0);
    let back = (10..=77).rev().map(|step| 2.5 * f64::from(step) + 1.0);
    let row = |force: f64| (force, 1e3 * paper().elongation(force).unwrap());
    for (force, elongation_mm) in back.clone().map(row) {
        writeln!(text, "{force},{elongation_mm}").unwrap();
    }
    let elastic = fit(&text).unwrap().hysteresis.unwrap();
    assert!(elastic.lost.abs() < 1e-3, "{elastic:?}");
    assert!(elastic.elongation_m < 2e-6, "{elastic:?}");
    // A lag of 0.02 mm at every force but the first: its area over the energy is known.
    let mut text = sampled(5.0, 0.0, 0.0);
    for (force, elongation_mm) in back.map(row) {
        writeln!(text, "{force},{}", elongation_mm + 0.02).unwrap();
    }
    let lagging = fit(&text).unwrap().hysteresis.unwrap();
    let energy = |force| paper().energy(paper().elongation(force).unwrap()).unwrap();
    let area = 2e-5 * (193.5 - 26.0 + 0.5 * 1.5);
    let wanted = area / (energy(195.0) - energy(26.0));
    assert!(
        (lagging.lost / wanted - 1.0).abs() < 0.02,
        "{lagging:?}, {wanted}"
    );
}

#[test]
fn a_single_row_on_the_way_back_is_an_unloading_branch() {
    let text = sampled(1.0, 0.0, 0.0);
    let last = paper().elongation(198.5).unwrap() * 1e3 + 1e-3;
    let found = fit(&format!("{text}198.5,{last}\n")).unwrap().hysteresis;
    let found = found.unwrap();
    assert!((found.elongation_m - 1e-6).abs() < 2e-7, "{found:?}");
    assert!((0.0..0.5).contains(&found.lost), "{found:?}");
}

#[test]
fn lines_are_counted_past_comments_and_blanks() {
    let text = "\u{feff}# a\r\n\r\nforce_n,elongation_mm\r\n1,1\r\n# b\r\n\r\n2,x\r\n";
    let error = fit(text).unwrap_err().to_string();
    assert!(error.starts_with("line 7, column 2"), "{error}");
    let error = fit("# a\nforce_lbf\n").unwrap_err().to_string();
    assert!(error.starts_with("line 2, column 1"), "{error}");
}

#[test]
fn the_sample_test_gives_the_ready_rigs_curve() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples/tensile-test.csv");
    let found = Fit::new(&read(&sample).unwrap(), None).unwrap();
    assert_papers(&found, 2e-6, 0.04);
    assert!((found.take_up_m - 0.42e-3).abs() < 2e-6);
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    let headers = [
        (
            "force_lbf,elongation_mm\n1,1\n",
            "line 1, column 1: the unit of `force_lbf`",
        ),
        ("force_n,time_s\n1,1\n", "line 1, column 2: `time_s`"),
        ("force_n,force_kn\n1,1\n", "names 2 columns for the force"),
        ("force_n\n1\n", "names 0 columns for the elongation"),
        (
            "force_kn,elongation_mm\n1,1\n4e305,2\n",
            "line 3, column 1: `4e305` is too large in newtons",
        ),
        ("force_n;elongation_mm\n1;1\n", "separate columns by commas"),
    ];
    let rows = [
        ("1,1\n2,\n", "line 3, column 2: nothing is there"),
        ("1,1\n2,x\n", "line 3, column 2: `x` is no finite number"),
        (
            "1,1\nNaN,2\n",
            "line 3, column 1: `NaN` is no finite number",
        ),
        (
            "0,0\n-1,1\n-2,2\n-3,3\n",
            "the first below is on line 3: this is a test in compression",
        ),
        (
            "1,1\n2,2\n2,3\n3,4\n",
            "line 4: the force is that of line 3",
        ),
        (
            "1,1\n3,2\n2,3\n4,4\n",
            "line 4: the force goes backwards from line 3",
        ),
        (
            "1,1\n2,2\n3,1.5\n4,4\n",
            "line 4: the elongation goes backwards",
        ),
        ("1,1\n2,2\n", "has 2 taut rows"),
        ("", "has 0 taut rows"),
        (
            "1,1\n2,1\n3,2\n",
            "line 3: the elongation is that of line 2",
        ),
        (
            "1,1\n3,3\n2,2\n1.5,2.5\n",
            "line 5: the elongation goes backwards from line 4 while the tendon is unloaded",
        ),
        ("1,1\n2,2,2\n", "line 3: 3 fields under a header of 2"),
    ];
    let headers = headers.map(|(text, wanted)| (text.to_owned(), wanted));
    let rows = rows.map(|(rows, wanted)| (format!("force_n,elongation_mm\n{rows}"), wanted));
    for (text, wanted) in headers.into_iter().chain(rows) {
        let error = fit(&text).unwrap_err().to_string();
        assert!(error.contains(wanted), "{text:?}: {error}");
    }
    assert!(read(Path::new("nowhere.csv")).is_err());
}
