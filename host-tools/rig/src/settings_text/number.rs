//! Numbers in the units of a file that give the bits of an f32 again.

/// The shortest text of an f32.
#[must_use]
pub fn number(value: f32) -> String {
    through(f64::from(value), value, |value| value)
}

/// Metres in millimetres.
pub(super) fn millimetres(metres: f32) -> String {
    through(f64::from(metres) * 1000.0, metres, |length_mm| {
        length_mm / 1000.0
    })
}

/// The shortest text of `value` from which `back` leads to the bits of `wanted`.
pub(super) fn through(value: f64, wanted: f32, back: impl Fn(f64) -> f64) -> String {
    let bits = wanted.to_bits();
    let leads_back = |text: &String| {
        text.parse()
            .is_ok_and(|read: f64| (back(read) as f32).to_bits() == bits)
    };
    // Seventeen digits tell every f64 from its neighbours.
    let shortest = (0..17)
        .map(|digits| format!("{value:.digits$e}"))
        .find(leads_back)
        .unwrap_or_else(|| format!("{value:e}"));
    plain(shortest)
}

/// Without an exponent where that is as easy to read.
fn plain(text: String) -> String {
    match text.parse::<f64>() {
        Ok(value) if value == 0.0 || (1e-3..1e6).contains(&value.abs()) => format!("{value}"),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::{millimetres, number, through};

    #[test]
    fn numbers_are_short() {
        assert_eq!(number(0.1), "0.1");
        assert_eq!(number(-40.0), "-40");
        assert_eq!(number(2e-7), "2e-7");
        assert_eq!(millimetres(0.029), "29");
        assert_eq!(
            through(30.000_000_000_000_004, 0.5, |tilt| tilt.to_radians().sin()),
            "30"
        );
    }
}
