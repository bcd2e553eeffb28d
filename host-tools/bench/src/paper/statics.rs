//! Table 3: the forces that balance 100 N·mm.

use super::kinematics::{CONFIGURATIONS, Configuration};
use super::row::{Meaning, Row, Topic, Verdict};
use leg_model::Error;
use nalgebra::Matrix3;

/// The moment of Table 3, N·m.
const MOMENT_NM: f64 = 0.1;

/// Moment about y and support force, for both configurations.
pub(super) fn rows() -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for configuration in &CONFIGURATIONS {
        let (pulls, moment_map) = configuration.model()?;
        let moment_nmm = (moment_map * configuration.tensions_n).y * 1e3;
        rows.push(Row {
            topic: Topic::Statics,
            what: format!(
                "Table 3 with {}: moment of the printed tensions about y",
                configuration.name
            ),
            published: 100.0,
            meaning: Meaning::Value,
            ours: moment_nmm,
            unit: "N·mm",
            decimals: 2,
            bound: 0.1,
            expected: Verdict::Agrees,
            why: "the tensions are printed to three digits; the unit can only be N·mm, not N·m",
        });
        let force = pulls * configuration.tensions_n;
        for (axis, component) in ["x", "y", "z"].into_iter().zip(0..) {
            rows.push(Row {
                topic: Topic::Statics,
                what: format!("Table 3 with {}: support force along {axis}", configuration.name),
                published: configuration.support_force_n[component],
                meaning: Meaning::Value,
                ours: force[component],
                unit: "N",
                decimals: 2,
                bound: 0.0051,
                expected: Verdict::Agrees,
                why: "+Σ n f of the printed tensions, to two decimals; Eq. (23) as it stands would give the opposite sign",
            });
        }
        rows.extend(smallest_tensions(configuration, &moment_map));
    }
    Ok(rows)
}

/// The printed tensions beside the smallest that balance the printed moment.
fn smallest_tensions(configuration: &Configuration, moment_map: &Matrix3<f64>) -> Vec<Row> {
    let lever = moment_map.row(1).transpose();
    let smallest = lever * (MOMENT_NM / lever.norm_squared());
    (0..3)
        .map(|tendon| Row {
            topic: Topic::Statics,
            what: format!("Table 3 with {}: tension {}", configuration.name, tendon + 1),
            published: configuration.tensions_n[tendon],
            meaning: Meaning::Unrepeatable,
            ours: smallest[tendon],
            unit: "N",
            decimals: 2,
            bound: 0.0,
            expected: Verdict::NotComparable,
            why: "a moment leaves the pretension open, and the paper does not tell its own; ours are the smallest that balance it",
        })
        .collect()
}
