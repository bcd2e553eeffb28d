//! Numbers as text: short for people, or exact for a file that gives the bits of an f32 again.

/// The number that is written like an f32: 0.05 for 0.05, not 0.05000000074505806.
#[must_use]
pub fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value.into())
}

/// Digits that suffice to distinguish values.
const SHORT: usize = 9;

/// A number for people: as short as it can be, else with six digits.
#[must_use]
pub fn plain(value: f64) -> String {
    let exact = written(value, 1e5);
    if exact.len() <= SHORT {
        return exact;
    }
    written(significant(value, 6), 1e5)
}

/// The nearest number of so many significant digits.
#[must_use]
pub fn significant(value: f64, digits: usize) -> f64 {
    let decimals = digits.saturating_sub(1);
    format!("{value:.decimals$e}").parse().unwrap_or(value)
}

/// With an exponent where that is easier to read.
fn written(value: f64, large: f64) -> String {
    if value == 0.0 || (1e-3..large).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// The shortest text of an f32.
#[must_use]
pub fn exact(value: f32) -> String {
    exact_through(f64::from(value), value, |value| value)
}

/// Metres in millimetres.
pub(crate) fn exact_mm(metres: f32) -> String {
    exact_through(f64::from(metres) * 1000.0, metres, |mm| mm / 1000.0)
}

/// The shortest text of `value` from which `back` leads to the bits of `wanted`.
pub(crate) fn exact_through(value: f64, wanted: f32, back: impl Fn(f64) -> f64) -> String {
    let leads_back = |text: &String| {
        let read = text.parse().map(&back);
        read.is_ok_and(|read| (read as f32).to_bits() == wanted.to_bits())
    };
    // Seventeen digits distinguish every f64 from its neighbours.
    let shortest = (0..17)
        .map(|digits| format!("{value:.digits$e}"))
        .find(leads_back)
        .unwrap_or_else(|| format!("{value:e}"));
    shortest
        .parse()
        .map_or(shortest, |value| written(value, 1e6))
}

#[cfg(test)]
mod tests {
    use super::{decimal, exact, exact_mm, exact_through, plain, significant};

    #[test]
    fn numbers_are_written_short() {
        let written = [0.0, 0.3, -20.0, 1e5, 2e-7, 0.1 + 0.2, 1.0 / 3e5].map(plain);
        let short = ["0", "0.3", "-20", "1e5", "2e-7", "0.3", "3.33333e-6"];
        assert_eq!(written, short);
        assert_eq!(decimal(0.05), 0.05);
        let rounded = [(0.12345, 2), (-98_765.0, 3), (0.1 + 0.2, 6), (0.0, 4)];
        let rounded = rounded.map(|(value, digits)| significant(value, digits));
        assert_eq!(rounded, [0.12, -98_800.0, 0.3, 0.0]);
        let tilt_deg = exact_through(30.000_000_000_000_004, 0.5, |tilt| tilt.to_radians().sin());
        let exact = [
            exact(0.1),
            exact(-40.0),
            exact(2e-7),
            exact_mm(0.029),
            tilt_deg,
        ];
        assert_eq!(exact, ["0.1", "-40", "2e-7", "29", "30"]);
    }
}
