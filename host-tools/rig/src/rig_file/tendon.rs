//! The section `[tendon]`: how the tendons stretch.

use crate::toml_problem::{Fault, Problem};
use crate::toml_section::Section;
use leg_model::{CURVE_POINTS_MAX, CurvePoint, Error, Reason, StiffnessAt, Tendon};
use std::ops::Range;
use toml::Spanned;

/// The keys of the section.
pub(super) const KEYS: [&str; 10] = [
    "stiffness_n_per_m",
    "curve",
    "curve_1",
    "curve_2",
    "curve_3",
    "test_piece",
    "stiffness_at",
    "f_min_n",
    "f_max_n",
    "pretension_n",
];

const COLUMNS: [&str; 3] = ["tension_n", "elongation_mm", "stiffness_n_per_m"];
const SIZES: [&str; 4] = [
    "length_mm",
    "diameter_mm",
    "tendon_length_mm",
    "tendon_diameter_mm",
];

/// The three tendons: of one constant stiffness, with one curve, or with a curve each.
pub(super) fn read(section: &Section<'_>) -> Result<[Tendon<f64>; 3], Fault> {
    let curve_key = ["curve", "curve_1"]
        .into_iter()
        .find(|key| section.has(key));
    match curve_key {
        Some(key) if section.has("stiffness_n_per_m") => Err(Fault {
            span: section.span(),
            problem: Problem::Both("stiffness_n_per_m", key),
        }),
        Some("curve_1") => Ok([
            curve(section, "curve_1")?,
            curve(section, "curve_2")?,
            curve(section, "curve_3")?,
        ]),
        Some(_) => Ok([curve(section, "curve")?; 3]),
        None => Ok([constant(section)?; 3]),
    }
}

/// `stiffness_at`: at which tension a curve's stiffness is read. A constant one is the same at all.
pub(super) fn read_stiffness_at(section: &Section<'_>) -> Result<StiffnessAt, Fault> {
    if section.has("stiffness_n_per_m") {
        return match section.span_of_key("stiffness_at") {
            None => Ok(StiffnessAt::Pretension),
            Some(span) => Err(Fault {
                span,
                problem: Problem::Both("stiffness_n_per_m", "stiffness_at"),
            }),
        };
    }
    let word = section.word("stiffness_at")?;
    match *word.get_ref() {
        "pretension" => Ok(StiffnessAt::Pretension),
        "tension" => Ok(StiffnessAt::Tension),
        _ => Err(Fault {
            span: word.span(),
            problem: Problem::Choice {
                key: "stiffness_at",
                found: (*word.get_ref()).into(),
                choices: "\"pretension\" or \"tension\"",
            },
        }),
    }
}

fn constant(section: &Section<'_>) -> Result<Tendon<f64>, Fault> {
    let stiffness = section.spanned_number("stiffness_n_per_m")?;
    let refused = |error| Fault {
        span: stiffness.span(),
        problem: Problem::Refused {
            key: "stiffness_n_per_m",
            reason: reason(error),
        },
    };
    Tendon::constant(*stiffness.get_ref()).map_err(refused)
}

fn curve(section: &Section<'_>, key: &'static str) -> Result<Tendon<f64>, Fault> {
    let table = section.section(key, &COLUMNS)?;
    let [tensions, elongations, stiffnesses] = COLUMNS.map(|column| table.numbers(column));
    let (tensions, elongations, stiffnesses) = (tensions?, elongations?, stiffnesses?);
    for (column, other) in [(COLUMNS[1], &elongations), (COLUMNS[2], &stiffnesses)] {
        same_count(&tensions, column, other)?;
    }
    let rows = tensions
        .get_ref()
        .iter()
        .zip(elongations.get_ref())
        .zip(stiffnesses.get_ref());
    let points: Vec<(Range<usize>, CurvePoint<f64>)> = rows
        .map(|((tension, elongation), stiffness)| {
            let point = CurvePoint {
                tension_n: *tension.get_ref(),
                elongation_m: elongation.get_ref() / 1000.0,
                stiffness_n_per_m: *stiffness.get_ref(),
            };
            (tension.span(), point)
        })
        .collect();
    check(&points)?;
    let scaled = scaled(section, &points)?;
    Tendon::curve(&scaled).map_err(|error| Fault {
        span: tensions.span(),
        problem: Problem::Refused {
            key,
            reason: reason(error),
        },
    })
}

fn same_count(
    tensions: &Spanned<Vec<Spanned<f64>>>,
    key: &'static str,
    other: &Spanned<Vec<Spanned<f64>>>,
) -> Result<(), Fault> {
    let (wanted, found) = (tensions.get_ref().len(), other.get_ref().len());
    if wanted == found {
        return Ok(());
    }
    Err(Fault {
        span: other.span(),
        problem: Problem::Count {
            key,
            found,
            other: COLUMNS[0],
            wanted,
        },
    })
}

/// The first point that the model refuses, with its place.
fn check(points: &[(Range<usize>, CurvePoint<f64>)]) -> Result<(), Fault> {
    let mut before = None;
    for (index, (span, point)) in points.iter().enumerate().take(CURVE_POINTS_MAX) {
        let checked = match before {
            None => point.check_first(),
            Some(before) => point.check_after(before),
        };
        checked.map_err(|error| Fault {
            span: span.clone(),
            problem: Problem::Curve {
                point: index + 1,
                reason: reason(error),
            },
        })?;
        before = Some(point);
    }
    Ok(())
}

/// The points, scaled from the test piece to the tendon where the file gives their sizes.
fn scaled(
    section: &Section<'_>,
    points: &[(Range<usize>, CurvePoint<f64>)],
) -> Result<Vec<CurvePoint<f64>>, Fault> {
    let points = points.iter().map(|(_, point)| *point);
    if !section.has("test_piece") {
        return Ok(points.collect());
    }
    let sizes = section.section("test_piece", &SIZES)?;
    let [length, diameter, tendon_length, tendon_diameter] = SIZES.map(|key| sizes.positive(key));
    let (length, diameter) = (tendon_length? / length?, tendon_diameter? / diameter?);
    Ok(points
        .map(|point| point.scaled(length, diameter * diameter))
        .collect())
}

fn reason(error: Error) -> Reason {
    match error {
        Error::Refused { reason, .. } => reason,
        _ => Reason::OutOfRange,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::RigFile;
    use leg_model::Elasticity;

    /// The paper's rig with other lines in the place of its curve's section.
    fn with(tendon: impl Fn(&str) -> String) -> RigFile {
        let text = READY_RIGS[0].text;
        let start = text.find("[tendon.curve]").unwrap();
        let end = text.find("[workspace]").unwrap();
        let replaced = [&text[..start], &tendon(&text[start..end]), &text[end..]].concat();
        RigFile::parse("test", &replaced).unwrap()
    }

    #[test]
    fn each_tendon_may_have_its_own_curve() {
        let file = with(|curve| {
            let named = |name: &str| curve.replace("[tendon.curve]", name);
            let longer = named("[tendon.curve_2]").replace("200]", "250]");
            [named("[tendon.curve_1]"), longer, named("[tendon.curve_3]")].concat()
        });
        let [first, second, third] = file.tendons;
        assert_eq!(first, third);
        assert!(first.elongation(220.0).is_err() && second.elongation(220.0).is_ok());
    }

    /// Twice as long is twice as soft, half the section as well: 0.6 mm × 120 mm to 0.8 mm × 100 mm is 32/15.
    #[test]
    fn a_test_piece_is_scaled_to_the_tendon() {
        let sizes = "[tendon.test_piece]\nlength_mm = 120\ndiameter_mm = 0.6\ntendon_length_mm = 100\n\
                     tendon_diameter_mm = 0.8\n";
        let (plain, scaled) = (with(str::to_owned), with(|curve| [curve, sizes].concat()));
        for tension in [5.0, 70.0, 150.0] {
            let [a, b] = [plain, scaled].map(|file| file.tendons[0].stiffness(tension).unwrap());
            assert!((b / a - 32.0 / 15.0).abs() < 1e-12, "{tension} N: {a} {b}");
        }
    }
}
