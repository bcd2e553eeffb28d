//! Loading and unloading, and the slack that is taken up before.

use super::{TensileError, TestRow, faulty};

/// The two branches of a test.
pub(super) struct Branches {
    /// Taut rows up to the largest force.
    pub loading: Vec<TestRow>,
    /// Taut rows after it, if the test has any.
    pub unloading: Vec<TestRow>,
}

/// Splits a test at its largest force. Rows below `taut_n` are the slack that is taken up.
pub(super) fn split(rows: &[TestRow], taut_n: f64) -> Result<Branches, TensileError> {
    let forces = rows.iter().map(|row| row.force_n).enumerate();
    let top = forces
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(index, _)| index);
    let (loading, unloading) = rows.split_at((top + 1).min(rows.len()));
    // What comes before the last slack row is taking up, whatever its force.
    let start = loading
        .iter()
        .rposition(|row| row.force_n < taut_n)
        .map_or(0, |last| last + 1);
    let loading = loading[start..].to_vec();
    let mut unloading = unloading.to_vec();
    unloading.retain(|row| row.force_n >= taut_n);
    check(&loading, 1.0, "loaded")?;
    check(&unloading, -1.0, "unloaded")?;
    if loading.len() < 3 {
        return Err(TensileError::TooFewRows(loading.len()));
    }
    Ok(Branches { loading, unloading })
}

/// Force and elongation change in one direction (`sign`) from row to row.
fn check(rows: &[TestRow], sign: f64, branch: &str) -> Result<(), TensileError> {
    let backwards = |quantity: &str, before: u64| {
        format!(
            "the {quantity} goes backwards from line {before} while the tendon is {branch}; average rows until force and elongation change together"
        )
    };
    for pair in rows.windows(2) {
        let [before, row] = pair else { continue };
        let force_n = (row.force_n - before.force_n) * sign;
        let elongation_m = (row.elongation_m - before.elongation_m) * sign;
        let before = before.line;
        let problem = if force_n == 0.0 {
            format!(
                "the force is that of line {before}; keep one row for each force, for example their mean"
            )
        } else if force_n < 0.0 {
            backwards("force", before)
        } else if elongation_m == 0.0 {
            format!(
                "the elongation is that of line {before} while the force changes; keep rows farther apart than the elongation is resolved"
            )
        } else if elongation_m < 0.0 {
            backwards("elongation", before)
        } else {
            continue;
        };
        return Err(faulty(row.line, None, problem));
    }
    Ok(())
}
