//! A tendon that is not of the size of its test piece.

use super::Args;
use leg_base::failure::Failure;
use leg_model::CurvePoint;

/// From the test piece to the tendon.
pub(super) struct Scale {
    length_ratio: f64,
    section_ratio: f64,
}

impl Scale {
    pub(super) fn apply(&self, point: &CurvePoint<f64>) -> CurvePoint<f64> {
        point.scaled(self.length_ratio, self.section_ratio)
    }
}

/// What the sizes give; nothing is scaled without them.
pub(super) fn of(args: &Args) -> Result<Scale, Failure> {
    let sizes = [
        ("--length-mm", args.length_mm),
        ("--diameter-mm", args.diameter_mm),
        ("--tendon-length-mm", args.tendon_length_mm),
        ("--tendon-diameter-mm", args.tendon_diameter_mm),
    ];
    for (name, size) in sizes {
        if size.is_some_and(|size| !(size.is_finite() && size > 0.0)) {
            let sentence = format!("{name} has to be greater than zero");
            return Err(Failure::refused(sentence, "give the size in millimetres"));
        }
    }
    let ratio =
        |tendon: Option<f64>, piece: Option<f64>| tendon.unwrap_or(1.0) / piece.unwrap_or(1.0);
    let diameter_ratio = ratio(args.tendon_diameter_mm, args.diameter_mm);
    Ok(Scale {
        length_ratio: ratio(args.tendon_length_mm, args.length_mm),
        section_ratio: diameter_ratio * diameter_ratio,
    })
}
