//! Loading and unloading, and the slack that is taken up before.

use super::{Row, TensileError, TensileTest};

/// The two branches of a test.
pub(super) struct Branches {
    /// Taut rows up to the largest force.
    pub loading: Vec<Row>,
    /// Taut rows after it, if the test has any.
    pub unloading: Vec<Row>,
}

/// Splits a test at its largest force. Rows below `taut_n` are the slack that is taken up.
pub(super) fn split(test: &TensileTest, taut_n: f64) -> Result<Branches, TensileError> {
    let forces = test.rows.iter().map(|row| row.force_n).enumerate();
    let top = forces
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(index, _)| index);
    let (loading, unloading) = test.rows.split_at((top + 1).min(test.rows.len()));
    // What comes before the last slack row is taking up, whatever its force.
    let start = loading
        .iter()
        .rposition(|row| row.force_n < taut_n)
        .map_or(0, |last| last + 1);
    let loading = loading[start..].to_vec();
    let unloading: Vec<Row> = unloading
        .iter()
        .copied()
        .filter(|row| row.force_n >= taut_n)
        .collect();
    check(&loading, 1.0, "loaded")?;
    check(&unloading, -1.0, "unloaded")?;
    if loading.len() < 3 {
        return Err(TensileError::TooFewRows {
            found: loading.len(),
        });
    }
    Ok(Branches { loading, unloading })
}

/// Force and elongation change one way (`sign`) from row to row.
fn check(rows: &[Row], sign: f64, branch: &'static str) -> Result<(), TensileError> {
    for pair in rows.windows(2) {
        let [before, row] = pair else { continue };
        let (line, before_line) = (row.line, before.line);
        if row.force_n == before.force_n {
            return Err(TensileError::SameForce {
                line,
                before: before_line,
            });
        }
        let backwards = |quantity| TensileError::Backwards {
            line,
            before: before_line,
            quantity,
            branch,
        };
        if (row.force_n - before.force_n) * sign < 0.0 {
            return Err(backwards("force"));
        }
        if row.elongation_m == before.elongation_m {
            return Err(TensileError::Standing {
                line,
                before: before_line,
            });
        }
        if (row.elongation_m - before.elongation_m) * sign < 0.0 {
            return Err(backwards("elongation"));
        }
    }
    Ok(())
}
