//! The section `[tendon]`: how the tendons stretch.

use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::Field;
use leg_model::{CURVE_POINTS_MAX, CurvePoint, Error, Reason, StiffnessAt, Tendon};
use std::ops::Range;

/// The keys of the section.
pub(super) const KEYS: [&str; 11] = [
    "stiffness_n_per_m",
    "curve",
    "curve_1",
    "curve_2",
    "curve_3",
    "test_piece",
    "measured",
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

/// The section of what a leg measured of its own tendons.
pub const MEASURED_TENDON: &str = "tendon.measured";

/// The tendons' elongation over what their curve or stiffness gives: of the leg as it is, knots and clamps with it.
pub const ELONGATION_FACTOR: Field<f64> = Field::new(
    "elongation_factor",
    "1",
    "Elongation of the leg's tendons over that by their curve or stiffness, measured by `leg tune`.",
    [0.5, 2.0],
    1.0,
);

/// What stands in [`MEASURED_TENDON`].
pub(super) fn read_elongation_factor(section: &Section<'_>) -> Result<f64, TomlError> {
    let measured = section.optional("measured", &[ELONGATION_FACTOR.name])?;
    let values = measured.map(|measured| measured.values([&ELONGATION_FACTOR]));
    let [factor] = values
        .transpose()?
        .flatten()
        .unwrap_or([ELONGATION_FACTOR.default]);
    Ok(factor)
}

/// The curves of three tendons that differ.
const CURVES: [&str; 3] = ["curve_1", "curve_2", "curve_3"];

/// What cannot stand beside each other: one of the two would not count.
const EXCLUSIVE: [(&str, &str); 8] = [
    ("stiffness_n_per_m", "curve"),
    ("stiffness_n_per_m", CURVES[0]),
    ("stiffness_n_per_m", CURVES[1]),
    ("stiffness_n_per_m", CURVES[2]),
    ("stiffness_n_per_m", "test_piece"),
    ("curve", CURVES[0]),
    ("curve", CURVES[1]),
    ("curve", CURVES[2]),
];

/// The three tendons: of one constant stiffness, with one curve, or with a curve each.
pub(super) fn read(
    section: &Section<'_>,
    elongation_factor: f64,
) -> Result<[Tendon<f64>; 3], TomlError> {
    for (first, second) in EXCLUSIVE {
        if section.has(first) && section.has(second) {
            let span = section.place(&[second]).unwrap_or(section.span());
            return Err(conflict(span, first, second));
        }
    }
    let one = |key| curve(section, key, elongation_factor);
    if section.has("curve") {
        Ok([one("curve")?; 3])
    } else if CURVES.iter().any(|key| section.has(key)) {
        let [first, second, third] = CURVES.map(one);
        Ok([first?, second?, third?])
    } else {
        Ok([constant(section, elongation_factor)?; 3])
    }
}

/// `stiffness_at`: at which tension a curve's stiffness is read. A constant one is the same at all.
pub(super) fn read_stiffness_at(section: &Section<'_>) -> Result<StiffnessAt, TomlError> {
    let key = "stiffness_at";
    if section.has("stiffness_n_per_m") {
        return match section.place(&[key]) {
            None => Ok(StiffnessAt::Pretension),
            Some(span) => Err(conflict(span, "stiffness_n_per_m", key)),
        };
    }
    let word = section.word(key)?;
    match *word.get_ref() {
        "pretension" => Ok(StiffnessAt::Pretension),
        "tension" => Ok(StiffnessAt::Tension),
        other => {
            let sentence = format!("`{key}` cannot be `{other}`");
            let help = "write \"pretension\" or \"tension\"";
            Err(TomlError::new(word.span(), sentence, help))
        }
    }
}

fn conflict(span: Range<usize>, first: &str, second: &str) -> TomlError {
    let sentence = format!("`{first}` and `{second}` cannot both be given");
    TomlError::new(
        span,
        sentence,
        format!("give either `{first}` or `{second}`"),
    )
}

fn constant(section: &Section<'_>, elongation_factor: f64) -> Result<Tendon<f64>, TomlError> {
    let key = "stiffness_n_per_m";
    let stiffness = section.number(key)?;
    let span = || section.place(&[key]).unwrap_or(section.span());
    Tendon::constant(stiffness / elongation_factor)
        .map_err(|error| TomlError::refused(span(), key, reason(error)))
}

fn curve(
    section: &Section<'_>,
    key: &str,
    elongation_factor: f64,
) -> Result<Tendon<f64>, TomlError> {
    let table = section.section(key, &COLUMNS)?;
    let [tensions, elongations, stiffnesses] = COLUMNS.map(|column| table.numbers(column));
    let (tensions, elongations, stiffnesses) = (tensions?, elongations?, stiffnesses?);
    let wanted = tensions.get_ref().len();
    for (column, other) in [(COLUMNS[1], &elongations), (COLUMNS[2], &stiffnesses)] {
        let found = other.get_ref().len();
        if found != wanted {
            let sentence = format!(
                "`{column}` has {found} entries, `{}` has {wanted}",
                COLUMNS[0]
            );
            let help = "give one entry for each point of the curve in each array";
            return Err(TomlError::new(other.span(), sentence, help));
        }
    }
    let rows = tensions.get_ref().iter().zip(elongations.get_ref());
    let rows = rows.zip(stiffnesses.get_ref());
    let points: Vec<CurvePoint<f64>> = rows
        .map(|((tension, elongation), stiffness)| CurvePoint {
            tension_n: *tension.get_ref(),
            elongation_m: elongation.get_ref() / 1000.0,
            stiffness_n_per_m: *stiffness.get_ref(),
        })
        .collect();
    check(&points, |index| tensions.get_ref()[index].span())?;
    let refused = |error| TomlError::refused(tensions.span(), key, reason(error));
    let points = scaled(section, points)?;
    let points: Vec<_> = points
        .iter()
        .map(|point| point.scaled(elongation_factor, 1.0))
        .collect();
    Tendon::curve(&points).map_err(refused)
}

/// Refuses the first point that the model refuses, at its place.
fn check(
    points: &[CurvePoint<f64>],
    place: impl Fn(usize) -> Range<usize>,
) -> Result<(), TomlError> {
    let mut before = None;
    for (index, point) in points.iter().enumerate().take(CURVE_POINTS_MAX) {
        let checked = match before {
            None => point.check_first(),
            Some(before) => point.check_after(before),
        };
        checked.map_err(|error| {
            let sentence = format!("point {} of the curve {}", index + 1, reason(error));
            let help = "correct the point; `leg curve` makes a curve from a tensile test";
            TomlError::new(place(index), sentence, help)
        })?;
        before = Some(point);
    }
    Ok(())
}

/// The points, scaled from the test piece to the tendon where the file gives their sizes.
fn scaled(
    section: &Section<'_>,
    mut points: Vec<CurvePoint<f64>>,
) -> Result<Vec<CurvePoint<f64>>, TomlError> {
    if !section.has("test_piece") {
        return Ok(points);
    }
    let sizes = section.section("test_piece", &SIZES)?;
    let [length, diameter, tendon_length, tendon_diameter] = SIZES.map(|key| sizes.positive(key));
    let (length, diameter) = (tendon_length? / length?, tendon_diameter? / diameter?);
    for point in &mut points {
        *point = point.scaled(length, diameter * diameter);
    }
    Ok(points)
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
    use super::{COLUMNS, ELONGATION_FACTOR, KEYS, SIZES};
    use crate::mechanism_keys;
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::RigFile;
    use leg_model::Elasticity;
    use std::collections::BTreeSet;

    #[test]
    fn the_keys_that_are_read_are_those_of_the_table() {
        let tables = [
            "curve",
            "curve_1",
            "curve_2",
            "curve_3",
            "measured",
            "test_piece",
        ];
        let numbers = KEYS.into_iter().filter(|key| !tables.contains(key));
        let measured = [ELONGATION_FACTOR.name];
        let read: BTreeSet<&str> = numbers
            .chain(COLUMNS)
            .chain(SIZES)
            .chain(measured)
            .collect();
        assert_eq!(read, mechanism_keys::names("tendon").into_iter().collect());
    }

    /// The paper's rig with other lines in the place of its curve's section.
    fn rig_with(tendon: impl Fn(&str) -> String) -> RigFile {
        let text = READY_RIGS[0].text;
        let start = text.find("[tendon.curve]").unwrap();
        let end = text.find("[workspace]").unwrap();
        let replaced = [&text[..start], &tendon(&text[start..end]), &text[end..]].concat();
        RigFile::parse("test", &replaced).unwrap()
    }

    #[test]
    fn each_tendon_may_have_its_own_curve() {
        let file = rig_with(|curve| {
            let named = |name: &str| curve.replace("[tendon.curve]", name);
            let longer = named("[tendon.curve_2]").replace("200]", "250]");
            [named("[tendon.curve_1]"), longer, named("[tendon.curve_3]")].concat()
        });
        let [first, second, third] = file.tendons;
        assert_eq!(first, third);
        assert!(first.elongation(220.0).is_err() && second.elongation(220.0).is_ok());
    }

    /// One of two sections would not count, and its keys not be looked at.
    #[test]
    fn what_would_not_count_is_refused_by_name() {
        let text = READY_RIGS[0].text;
        let start = text.find("[tendon.curve]").unwrap();
        let end = text.find("[workspace]").unwrap();
        let constant = text[..start].replace("[tendon]\n", "[tendon]\nstiffness_n_per_m = 2e5\n");
        for (first, tendon) in [("curve", &text[..end]), ("stiffness_n_per_m", &constant)] {
            for second in ["curve_1", "curve_2", "curve_3", "test_piece"] {
                // A test piece is that of a curve.
                if (first, second) == ("curve", "test_piece") {
                    continue;
                }
                let extra = format!("[tendon.{second}]\nnonsense = 1\n");
                let both = [tendon, &extra, &text[end..]].concat();
                let refused = RigFile::parse("test", &both).unwrap_err().to_string();
                let expected = format!("`{first}` and `{second}` cannot both be given");
                assert!(refused.contains(&expected), "{refused}");
            }
        }
    }

    /// Twice as long is twice as soft, half the section as well: 0.6 mm × 120 mm to 0.8 mm × 100 mm is 32/15.
    #[test]
    fn a_test_piece_is_scaled_to_the_tendon() {
        let sizes = "[tendon.test_piece]\nlength_mm = 120\ndiameter_mm = 0.6\ntendon_length_mm = 100\n\
                     tendon_diameter_mm = 0.8\n";
        let (plain, scaled) = (
            rig_with(str::to_owned),
            rig_with(|curve| [curve, sizes].concat()),
        );
        for tension in [5.0, 70.0, 150.0] {
            let [a, b] = [plain, scaled].map(|file| file.tendons[0].stiffness(tension).unwrap());
            assert!((b / a - 32.0 / 15.0).abs() < 1e-12, "{tension} N: {a} {b}");
        }
    }

    /// What a leg measured of its tendons holds for a curve, for that of each tendon, and for a stiffness that is constant.
    #[test]
    fn a_factor_stretches_every_kind_of_tendon() {
        let measured = "[tendon.measured]\nelongation_factor = 1.25\n";
        let three = |curve: &str| {
            let named = |name: &str| curve.replace("[tendon.curve]", name);
            let names = ["[tendon.curve_1]", "[tendon.curve_2]", "[tendon.curve_3]"];
            names.map(named).concat()
        };
        for tendon in [&str::to_owned as &dyn Fn(&str) -> String, &three] {
            let plain = rig_with(tendon);
            let stretched = rig_with(|curve| [&tendon(curve), measured].concat());
            let factors = (plain.elongation_factor, stretched.elongation_factor);
            assert_eq!(factors, (1.0, 1.25));
            for (plain, stretched) in plain.tendons.into_iter().zip(stretched.tendons) {
                let both = [plain, stretched];
                let [a, b] = both.map(|tendon| tendon.elongation(70.0).unwrap());
                assert!((b / a - 1.25).abs() < 1e-12);
                let [a, b] = both.map(|tendon| tendon.stiffness(70.0).unwrap());
                assert!((b / a - 0.8).abs() < 1e-12);
            }
        }
        let text = READY_RIGS[0].text;
        let text = text.replace("stiffness_at = \"pretension\"", "stiffness_n_per_m = 1e5");
        let [start, end] = ["[tendon.curve]", "[workspace]"].map(|at| text.find(at).unwrap());
        let text = [&text[..start], measured, &text[end..]].concat();
        let constant = RigFile::parse("test", &text).unwrap();
        assert_eq!(constant.tendons[0].stiffness(70.0).unwrap(), 8e4);
    }

    #[test]
    fn a_factor_out_of_its_range_is_refused() {
        for (line, said) in [
            ("elongation_factor = 0.49", "elongation_factor"),
            ("elongation_factor = 2.01", "elongation_factor"),
            ("elongation = 1", "`elongation`"),
        ] {
            let text = [READY_RIGS[0].text, "[tendon.measured]\n", line].concat();
            let refused = RigFile::parse("test", &text).unwrap_err().to_string();
            assert!(refused.contains(said), "{refused}");
        }
    }
}
