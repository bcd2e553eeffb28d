//! A tendon's curve as the section of a rig file.

use leg_model::CurvePoint;

/// `[tendon.curve]` under a comment: it replaces the section of that name, or `stiffness_n_per_m`. Rounded to a tenth of a nanometre and
/// a hundredth of a newton per metre.
#[must_use]
pub fn section(points: &[CurvePoint<f64>]) -> String {
    let column = |name: &str, unit: f64, of: &dyn Fn(&CurvePoint<f64>) -> f64| {
        let numbers: Vec<String> = points
            .iter()
            .map(|point| format!("{:.*}", decimals(unit), of(point)))
            .collect();
        let rows: String = numbers
            .chunks(4)
            .map(|row| format!("    {},\n", row.join(", ")))
            .collect();
        format!("{name} = [\n{rows}]\n")
    };
    [
        "# From a tensile test; in a rig file it stands in place of its [tendon.curve] or stiffness_n_per_m.\n".into(),
        "[tendon.curve]\n".into(),
        column("tension_n", 1e-6, &|point| point.tension_n),
        column("elongation_mm", 1e-7, &|point| point.elongation_m * 1e3),
        column("stiffness_n_per_m", 1e-2, &|point| point.stiffness_n_per_m),
    ]
    .concat()
}

fn decimals(unit: f64) -> usize {
    (-unit.log10()).round().max(0.0) as usize
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::section;
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::RigFile;
    use leg_model::{CurvePoint, Elasticity, Tendon};

    #[test]
    fn a_rig_file_takes_the_section() {
        let text = READY_RIGS[0].text;
        let (start, end) = (
            text.find("[tendon.curve]").unwrap(),
            text.find("[workspace]").unwrap(),
        );
        let points = CurvePoint::<f64>::PAPER.map(|point| point.scaled(2.0, 1.0));
        let replaced = [&text[..start], &section(&points), &text[end..]].concat();
        let file = RigFile::parse("replaced", &replaced).unwrap();
        let softer = Tendon::curve(&points).unwrap();
        let found = file.tendons[0].elongation(70.0).unwrap();
        assert!((found / softer.elongation(70.0).unwrap() - 1.0).abs() < 1e-6);
    }
}
