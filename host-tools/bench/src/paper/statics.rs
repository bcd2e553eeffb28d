//! Table 3: the forces that balance 100 N·mm.

use super::kinematics::{CONFIGURATIONS, PrintedPose};
use super::row::{PaperRow, Topic};
use leg_model::Error;
use nalgebra::Matrix3;

/// The moment of Table 3, N·m.
const MOMENT_NM: f64 = 0.1;

/// Moment about y, support force and tensions, for both configurations.
pub(super) fn rows() -> Result<Vec<PaperRow>, Error> {
    let both: Result<Vec<_>, Error> = CONFIGURATIONS
        .iter()
        .map(|configuration| {
            let (pulls, moment_map) = configuration.model()?;
            Ok(configuration_rows(configuration, &pulls, &moment_map))
        })
        .collect();
    Ok(both?.concat())
}

fn configuration_rows(
    configuration: &PrintedPose,
    pulls: &Matrix3<f64>,
    moment_map: &Matrix3<f64>,
) -> Vec<PaperRow> {
    let row = |what: String, numbers, unit, why| {
        let what = format!("Table 3 with {}: {what}", configuration.name);
        PaperRow::new(Topic::Statics, what, numbers, (unit, 2), why)
    };
    let moment_nmm = (moment_map * configuration.tensions_n).y * 1e3;
    let why = "the tensions are printed to three digits; the unit can only be N·mm, not N·m";
    let what = "moment of the printed tensions about y".to_owned();
    let mut rows = vec![row(what, (100.0, moment_nmm), "N·mm", why).bounded(0.1)];
    let force = pulls * configuration.tensions_n;
    let why = "+Σ n f of the printed tensions, to two decimals; Eq. (23) as it stands would give the opposite sign";
    rows.extend((0..3).map(|i| {
        let what = format!("support force along {}", ["x", "y", "z"][i]);
        let numbers = (configuration.support_force_n[i], force[i]);
        row(what, numbers, "N", why).bounded(0.0051)
    }));
    // The smallest tensions that balance the moment.
    let lever = moment_map.row(1).transpose();
    let smallest = lever * (MOMENT_NM / lever.norm_squared());
    let why = "a moment leaves the pretension open, and the paper does not state its own; ours are the smallest that balance it";
    rows.extend((0..3).map(|i| {
        let numbers = (configuration.tensions_n[i], smallest[i]);
        row(format!("tension {}", i + 1), numbers, "N", why).unrepeatable()
    }));
    rows
}
