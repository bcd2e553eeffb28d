//! The levels of a map: round numbers, and a colour between each two.

use plotters::style::RGBColor;
use plotters::style::colors::colormaps::{ColorMap, ViridisRGB};

/// About so many bands.
const BANDS: f64 = 9.0;

/// Levels that enclose all values, evenly spaced.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bands {
    levels: Vec<f64>,
    decimals: usize,
}

impl Bands {
    /// Levels at round numbers, from at most `low` to at least `high`.
    pub(super) fn new(low: f64, high: f64) -> Self {
        // A field that is flat but for rounding has one band.
        let spread = (high - low).max(1e-6 * high.abs()).max(1e-12);
        let rough = spread / BANDS;
        let magnitude = 10.0_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|factor| factor * magnitude)
            .find(|step| *step >= rough)
            .unwrap_or(rough);
        let first = (low / step + 1e-9).floor();
        let last = (high / step - 1e-9).ceil().max(first + 1.0);
        let count = (last - first) as usize;
        Self {
            levels: (0..=count).map(|i| (first + i as f64) * step).collect(),
            decimals: (-step.log10().floor()).max(0.0) as usize,
        }
    }

    /// No levels: there is no value.
    pub(super) const fn none() -> Self {
        Self {
            levels: Vec::new(),
            decimals: 0,
        }
    }

    /// How many bands there are.
    pub(super) fn count(&self) -> usize {
        self.levels.len().saturating_sub(1)
    }

    /// The band of a value.
    #[cfg(test)]
    pub(super) fn band(&self, value: f64) -> usize {
        let inner = self.inner().iter();
        inner.filter(|level| value >= **level).count()
    }

    pub(super) fn colour(&self, band: usize) -> RGBColor {
        let last = self.count().saturating_sub(1).max(1) as f64;
        ViridisRGB.get_color(band as f64 / last)
    }

    /// The levels between the bands.
    pub(super) fn inner(&self) -> &[f64] {
        self.levels.get(1..self.count()).unwrap_or_default()
    }

    /// All levels in words.
    pub(super) fn labels(&self) -> Vec<String> {
        let label = |level: &f64| format!("{:.*}", self.decimals, level + 0.0);
        self.levels.iter().map(label).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Bands;

    #[test]
    fn levels_are_round_and_enclose_all_values() {
        let bands = Bands::new(0.0, 5.37);
        assert_eq!(bands.labels(), ["0", "1", "2", "3", "4", "5", "6"]);
        assert_eq!(bands.band(0.0), 0);
        assert_eq!(bands.band(2.0), 2);
        assert_eq!(bands.band(5.37), 5);
    }

    #[test]
    fn a_flat_field_has_a_band() {
        assert_eq!(Bands::new(0.0, 0.0).band(0.0), 0);
        assert!(Bands::new(3.0, 3.0).count() >= 1);
    }

    #[test]
    fn small_steps_keep_their_decimals() {
        assert_eq!(Bands::new(-0.04, 0.05).labels()[0], "-0.04");
    }
}
