//! Cells of equal colour side by side, as one piece: a picture of a thousand pieces, not of a hundred thousand.

use super::bands::Bands;
use super::{PlotField, PoseSample};
use plotters::style::RGBColor;

/// None of the colours of the bands, and none of the greys.
pub(super) const BORDER: RGBColor = RGBColor(236, 200, 196);
pub(super) const EXTERIOR: RGBColor = RGBColor(205, 205, 205);
pub(super) const NO_RESULT: RGBColor = RGBColor(120, 120, 120);

/// Finer rows and columns than the poses, with values between them: the edges of the bands look smooth.
const FINER: usize = 6;

/// A row of cells of one colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Run {
    /// First and last azimuth, degrees.
    pub azimuths_deg: (f64, f64),
    /// Lowest and highest tilt, degrees.
    pub tilts_deg: (f64, f64),
    /// What it shows.
    pub shade: Shade,
}

/// What a place of a map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shade {
    /// A value in a band.
    Band(usize),
    /// Outside the region, but inside the wider one.
    Border,
    /// Outside both.
    Exterior,
    /// Beside a pose of which nothing is known, or inside the region, but without a value.
    NoResult,
}

impl Shade {
    fn new(sample: Option<PoseSample>, bands: &Bands) -> Self {
        let Some(sample) = sample else {
            return Self::NoResult;
        };
        match sample.shown() {
            Some(value) => Self::Band(bands.band(value)),
            None if sample.is_border() => Self::Border,
            None if sample.is_exterior() => Self::Exterior,
            None => Self::NoResult,
        }
    }

    pub fn colour(self, bands: &Bands) -> RGBColor {
        match self {
            Self::Band(band) => bands.colour(band),
            Self::Border => BORDER,
            Self::Exterior => EXTERIOR,
            Self::NoResult => NO_RESULT,
        }
    }
}

/// The values that the runs show.
pub(super) fn values(field: &PlotField) -> impl Iterator<Item = f64> {
    let (rows, columns) = counts(field);
    let places = (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)));
    let samples = places.filter_map(|(column, row)| field.interpolate(middle(column), middle(row)));
    samples.filter_map(|sample| sample.shown())
}

/// How many fine rows and columns there are.
fn counts(field: &PlotField) -> (usize, usize) {
    let rows = (field.tilts_deg.len() - 1) * FINER;
    (rows, field.azimuths * FINER)
}

/// The middle of a fine row or column, in rows or columns of poses.
fn middle(index: usize) -> f64 {
    (index as f64 + 0.5) / FINER as f64
}

/// All runs of a field.
pub(super) fn runs(field: &PlotField, bands: &Bands) -> Vec<Run> {
    let (rows, _) = counts(field);
    let height = field.tilt_max_deg() / rows as f64;
    let row = |row| (row as f64 * height, (row + 1) as f64 * height);
    (0..rows)
        .flat_map(|index| row_of(field, bands, index, row(index)))
        .collect()
}

fn row_of(field: &PlotField, bands: &Bands, row: usize, tilts_deg: (f64, f64)) -> Vec<Run> {
    let (_, columns) = counts(field);
    let width = 360.0 / columns as f64;
    let mut runs: Vec<Run> = Vec::new();
    for column in 0..columns {
        let shade = Shade::new(field.interpolate(middle(column), middle(row)), bands);
        let end = (column + 1) as f64 * width;
        match runs.last_mut() {
            Some(run) if run.shade == shade => run.azimuths_deg.1 = end,
            _ => runs.push(Run {
                azimuths_deg: (column as f64 * width, end),
                tilts_deg,
                shade,
            }),
        }
    }
    runs
}
