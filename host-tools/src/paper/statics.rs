//! Table 3: the forces that balance 100 N·mm.

use super::kinematics::CONFIGURATIONS;
use super::row::{Meaning, Row, Topic, Verdict};
use leg_model::Error;

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
        rows.push(Row {
            topic: Topic::Statics,
            what: format!(
                "Table 3 with {}: support force, largest difference from +Σ n f",
                configuration.name
            ),
            published: 0.0,
            meaning: Meaning::Value,
            ours: (force - configuration.support_force_n).amax(),
            unit: "N",
            decimals: 4,
            bound: 0.0051,
            expected: Verdict::Agrees,
            why: "printed to two decimals; Eq. (23) as it stands would give the opposite sign",
        });
    }
    Ok(rows)
}
