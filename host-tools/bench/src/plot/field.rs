//! Maps of a quantity over the workspace, flat or seen from above, with its scale beside them.

mod bands;
mod contours;
mod flat;
mod layers;
mod polar;
mod scale;
mod workspace;

use super::canvas::{self, Area, DrawResult, MARGIN, Painter, WIDTH, px, range};
use super::error::PlotError;
use bands::Bands;
use plotters::prelude::*;
use scale::SCALE_WIDTH;
use std::path::{Path, PathBuf};

/// Width of the lines of equal value.
const LINE: u32 = px(2);

/// So many places between two poses tell what values are between them.
const FINER: usize = 6;

/// A quantity over azimuth and tilt.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotField {
    /// Above the map.
    pub title: String,
    /// Above the scale.
    pub quantity: String,
    /// Below that; empty for a ratio.
    pub unit: String,
    /// The name of poses outside the region, but inside the wider one.
    pub border_label: String,
    /// The name of poses outside both.
    pub exterior_label: String,
    /// Azimuths of the columns: evenly from 0°, the full turn not repeated.
    pub azimuths: usize,
    /// Tilts of the rows, degrees: evenly from 0.
    pub tilts_deg: Vec<f64>,
    /// What is known of each pose, row by row; none where there is no result.
    pub samples: Vec<Option<PoseSample>>,
}

/// What is known of a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseSample {
    /// The quantity, if it is known.
    pub value: Option<f64>,
    /// How far the pose is inside the region that is shown; negative outside. Its border is where this is zero.
    pub room: f64,
    /// The same of a wider region around it.
    pub wider_room: f64,
}

impl PoseSample {
    /// The sample at a part of the way to another.
    fn blend(self, other: Self, part: f64) -> Self {
        let mean = |start: f64, end: f64| start * (1.0 - part) + end * part;
        Self {
            value: self.value.zip(other.value).map(|(a, b)| mean(a, b)),
            room: mean(self.room, other.room),
            wider_room: mean(self.wider_room, other.wider_room),
        }
    }

    /// The value, if it is to be shown.
    fn shown(&self) -> Option<f64> {
        self.value.filter(|_| self.room >= 0.0)
    }

    /// Outside the region, but inside the wider one.
    fn is_border(&self) -> bool {
        self.room < 0.0 && self.wider_room >= 0.0
    }

    fn is_exterior(&self) -> bool {
        self.room < 0.0 && self.wider_room < 0.0
    }
}

/// How a [`PlotField`] is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Azimuth across, tilt upwards.
    Flat,
    /// From above: azimuth round, tilt outwards.
    Polar,
}

/// Draws the map as `stem.svg`, `stem.png` (1280 × 800 pixels) and `stem.pdf`, each whole or not at all, and names the first.
///
/// # Errors
/// [`PlotError::Empty`] if nothing is known of any pose or the rows do not fit; a file that cannot be written.
pub fn save(field: &PlotField, layout: Layout, stem: &Path) -> Result<PathBuf, PlotError> {
    let bands = field.bands()?;
    let painter = FieldPainter {
        field,
        bands,
        layout,
    };
    canvas::save(&painter, stem)
}

/// A field whose bands are known.
struct FieldPainter<'a> {
    field: &'a PlotField,
    bands: Bands,
    layout: Layout,
}

impl Painter for FieldPainter<'_> {
    fn paint<B: DrawingBackend>(&self, root: &Area<B>) -> DrawResult<B> {
        let Self { field, bands, .. } = self;
        let body = canvas::titled(root, &field.title)?;
        let (map, scale) = body.split_horizontally(WIDTH - SCALE_WIDTH - MARGIN);
        match self.layout {
            Layout::Flat => flat::paint(field, bands, &map)?,
            Layout::Polar => polar::paint(field, bands, &map)?,
        }
        scale::paint(field, bands, &scale)
    }
}

impl PlotField {
    fn bands(&self) -> Result<Bands, PlotError> {
        let fits = self.azimuths > 1
            && self.tilts_deg.len() > 1
            && self.samples.len() == self.azimuths * self.tilts_deg.len();
        if !fits {
            return Err(PlotError::Empty);
        }
        let poses = self.samples.iter().flatten().filter_map(PoseSample::shown);
        match range(poses.chain(self.values_between())) {
            Some((low, high)) if low.is_finite() && high.is_finite() => Ok(Bands::new(low, high)),
            // Where the values would be says something, too.
            None if self.samples.iter().any(Option::is_some) => Ok(Bands::none()),
            _ => Err(PlotError::Empty),
        }
    }

    /// Values that are shown between the poses: towards the border they go beyond those of the poses.
    fn values_between(&self) -> impl Iterator<Item = f64> {
        let [columns, rows] = [self.azimuths, self.tilts_deg.len() - 1].map(|count| count * FINER);
        let middle = |index: usize| (index as f64 + 0.5) / FINER as f64;
        let places = (0..rows).flat_map(move |row| (0..columns).map(move |column| [column, row]));
        let samples = places.filter_map(move |place| {
            let [column, row] = place.map(middle);
            self.interpolate(column, row)
        });
        samples.filter_map(|sample| sample.shown())
    }

    /// The greatest tilt, degrees.
    fn tilt_max_deg(&self) -> f64 {
        self.tilts_deg.last().copied().unwrap_or_default()
    }

    /// Width and height of the square between four poses, degrees.
    fn square_deg(&self) -> (f64, f64) {
        let rows = self.tilts_deg.len() - 1;
        (
            360.0 / self.azimuths as f64,
            self.tilt_max_deg() / rows as f64,
        )
    }

    /// What is known of a place between the poses: azimuth in columns, tilt in rows. None beside a pose without a
    /// result.
    fn interpolate(&self, column: f64, row: f64) -> Option<PoseSample> {
        let last = self.tilts_deg.len() - 1;
        let (left, below) = (column.floor(), row.floor().min(last as f64 - 1.0));
        let (x, y) = (column - left, row - below);
        let sample = |dx: f64, dy: f64| {
            let column = (left + dx) as usize % self.azimuths;
            self.samples[(below + dy) as usize * self.azimuths + column]
        };
        let low = sample(0.0, 0.0)?.blend(sample(1.0, 0.0)?, x);
        let high = sample(0.0, 1.0)?.blend(sample(1.0, 1.0)?, x);
        Some(low.blend(high, y))
    }
}

#[cfg(test)]
mod tests;
