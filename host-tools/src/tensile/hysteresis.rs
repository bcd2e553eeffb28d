//! What a tendon keeps back when it is unloaded.

use super::Row;
use serde::Serialize;

/// The difference of the two branches of a test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hysteresis {
    /// Largest difference of the elongations at equal force, m.
    pub elongation_m: f64,
    /// Energy that is not given back, as a part of that of loading.
    pub lost: f64,
}

impl Hysteresis {
    /// None without at least two unloading rows. The unloading branch begins where the loading branch ends.
    pub(super) fn between(loading: &[Row], unloading: &[Row]) -> Option<Self> {
        if unloading.len() < 2 {
            return None;
        }
        let top = loading.last().copied();
        let back: Vec<Row> = top.into_iter().chain(unloading.iter().copied()).collect();
        let differences = unloading.iter().filter_map(|row| {
            let loaded = elongation_at(loading, row.force_n)?;
            Some((row.elongation_m - loaded).abs())
        });
        let elongation_m = differences.fold(0.0, f64::max);
        let lowest = unloading
            .iter()
            .map(|row| row.force_n)
            .fold(f64::INFINITY, f64::min);
        let stored = energy(loading.iter().filter(|row| row.force_n >= lowest));
        let given_back = -energy(back.iter());
        Some(Self {
            elongation_m,
            lost: (stored - given_back) / stored,
        })
    }
}

/// Elongation of the loading branch at a force, in a straight line between its rows.
fn elongation_at(loading: &[Row], force_n: f64) -> Option<f64> {
    let pair = loading
        .windows(2)
        .find(|pair| pair[0].force_n <= force_n && force_n <= pair[1].force_n)?;
    let part = (force_n - pair[0].force_n) / (pair[1].force_n - pair[0].force_n);
    Some(pair[0].elongation_m + part * (pair[1].elongation_m - pair[0].elongation_m))
}

/// ∫F dδ along the rows, J.
fn energy<'a>(rows: impl Iterator<Item = &'a Row>) -> f64 {
    let rows: Vec<&Row> = rows.collect();
    let piece = |pair: &[&Row]| {
        0.5 * (pair[0].force_n + pair[1].force_n) * (pair[1].elongation_m - pair[0].elongation_m)
    };
    rows.windows(2).map(piece).sum()
}
