//! What a tendon keeps back when it is unloaded.

use super::TestRow;
use leg_model::{Elasticity, Error, TendonCurve};
use serde::Serialize;

/// The difference of the unloading branch from the curve of loading.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hysteresis {
    /// Largest difference of the elongations at equal force, m.
    pub elongation_m: f64,
    /// The area between the branches, over the forces of the unloading rows, as a part of the energy of loading there.
    pub lost: f64,
}

impl Hysteresis {
    /// None without unloading rows. The unloading branch begins where the loading branch ends.
    ///
    /// # Errors
    /// A force beyond the curve.
    pub(super) fn new(
        curve: &TendonCurve<f64>,
        unloading: &[TestRow],
    ) -> Result<Option<Self>, Error> {
        let Some(lowest) = unloading.last() else {
            return Ok(None);
        };
        let mut before = (curve.tension_max_n(), 0.0);
        let (mut largest, mut area) = (0.0_f64, 0.0);
        for row in unloading {
            let lag = row.elongation_m - curve.elongation(row.force_n)?;
            largest = largest.max(lag.abs());
            area += 0.5 * (lag + before.1) * (before.0 - row.force_n);
            before = (row.force_n, lag);
        }
        let energy = |force: f64| curve.energy(curve.elongation(force)?);
        let stored = energy(curve.tension_max_n())? - energy(lowest.force_n)?;
        Ok(Some(Self {
            elongation_m: largest,
            lost: area / stored,
        }))
    }
}
