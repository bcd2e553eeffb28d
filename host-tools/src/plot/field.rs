//! Maps of a quantity over the workspace, flat or seen from above, with its scale beside them.

mod bands;
mod flat;
mod isolines;
mod polar;
mod runs;

use super::canvas::{self, Area, Drawn, LABEL_PX, MARGIN_PX, PlotError, TITLE_PX, WIDTH_PX, range};
use crate::atomic_file;
use bands::Bands;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::{Path, PathBuf};

/// Pose without a value.
const NOTHING: RGBColor = RGBColor(200, 200, 200);
const SCALE_WIDTH_PX: u32 = 270;

/// A quantity over azimuth and tilt.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Above the map.
    pub title: String,
    /// Beside the scale, with its unit.
    pub quantity: String,
    /// What a pose without a value is.
    pub nothing: String,
    /// Azimuths of the columns: evenly from 0°, the full turn not repeated.
    pub azimuths: usize,
    /// Tilts of the rows, degrees: evenly from 0.
    pub tilts_deg: Vec<f64>,
    /// A value for each pose, row by row; none where there is none.
    pub values: Vec<Option<f64>>,
}

/// How a [`Field`] is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Azimuth across, tilt upwards.
    Flat,
    /// From above: azimuth round, tilt outwards.
    Polar,
}

/// Draws the map as an SVG file.
///
/// # Errors
/// [`PlotError::Empty`] if no pose has a value or the rows do not fit; a file that cannot be written.
pub fn save_svg(field: &Field, layout: Layout, path: &Path) -> Result<(), PlotError> {
    let bands = field.bands()?;
    canvas::svg(path, |root| paint(field, &bands, layout, root))
}

/// Draws the map as a PNG file of 1280 × 800 pixels; the path has to end in `.png`.
///
/// # Errors
/// As [`save_svg`].
pub fn save_png(field: &Field, layout: Layout, path: &Path) -> Result<(), PlotError> {
    let bands = field.bands()?;
    canvas::png(path, |root| paint(field, &bands, layout, root))
}

/// Draws the map as `stem.svg` and `stem.png`, each whole or not at all, and names the first.
///
/// # Errors
/// As [`save_svg`].
pub fn save_both(field: &Field, layout: Layout, stem: &Path) -> Result<PathBuf, PlotError> {
    let (svg, png) = (stem.with_extension("svg"), stem.with_extension("png"));
    atomic_file::replace(&svg, |new| save_svg(field, layout, new))?;
    atomic_file::replace(&png, |new| save_png(field, layout, new))?;
    Ok(svg)
}

impl Field {
    fn bands(&self) -> Result<Bands, PlotError> {
        let fits = self.azimuths > 1
            && self.tilts_deg.len() > 1
            && self.values.len() == self.azimuths * self.tilts_deg.len();
        let values = self.values.iter().flatten().copied();
        match range(values) {
            Some((low, high)) if fits && low.is_finite() && high.is_finite() => {
                Ok(Bands::new(low, high))
            }
            _ => Err(PlotError::Empty),
        }
    }

    /// The greatest tilt, degrees.
    fn tilt_max_deg(&self) -> f64 {
        self.tilts_deg.last().copied().unwrap_or_default()
    }

    /// The value at a place between the poses: azimuth in columns, tilt in rows. None beside a pose without a value.
    fn at(&self, column: f64, row: f64) -> Option<f64> {
        let last = self.tilts_deg.len() - 1;
        let (left, below) = (column.floor(), row.floor().min(last as f64 - 1.0));
        let (x, y) = (column - left, row - below);
        let value = |dx: f64, dy: f64| {
            let column = (left + dx) as usize % self.azimuths;
            self.values[(below + dy) as usize * self.azimuths + column]
        };
        let low = value(0.0, 0.0)? * (1.0 - x) + value(1.0, 0.0)? * x;
        let high = value(0.0, 1.0)? * (1.0 - x) + value(1.0, 1.0)? * x;
        Some(low * (1.0 - y) + high * y)
    }
}

fn paint<B: DrawingBackend>(
    field: &Field,
    bands: &Bands,
    layout: Layout,
    root: &Area<B>,
) -> Drawn<B> {
    root.fill(&WHITE)?;
    let body = root
        .margin(MARGIN_PX, MARGIN_PX, MARGIN_PX, 0)
        .titled(&field.title, ("sans-serif", TITLE_PX))?;
    let (map, scale) = body.split_horizontally(WIDTH_PX - SCALE_WIDTH_PX - MARGIN_PX);
    match layout {
        Layout::Flat => flat::paint(field, bands, &map)?,
        Layout::Polar => polar::paint(field, bands, &map)?,
    }
    paint_scale(field, bands, &scale)
}

/// The bands' colours with the levels between them: those of the lines on the map.
fn paint_scale<B: DrawingBackend>(field: &Field, bands: &Bands, area: &Area<B>) -> Drawn<B> {
    const LEFT_PX: i32 = 30;
    const BAR_PX: i32 = 36;
    const TOP_PX: i32 = 60;
    let text = ("sans-serif", LABEL_PX)
        .into_text_style(area)
        .pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(
        field.quantity.as_str(),
        (LEFT_PX, TOP_PX - 32),
        text.clone(),
    ))?;
    let (_, height) = area.dim_in_pixel();
    let step = (height as i32 - TOP_PX - 110) / bands.count() as i32;
    let bottom = TOP_PX + step * bands.count() as i32;
    for band in 0..bands.count() {
        let y = bottom - step * band as i32;
        let corners = [(LEFT_PX, y - step), (LEFT_PX + BAR_PX, y)];
        area.draw(&Rectangle::new(corners, bands.colour(band).filled()))?;
        area.draw(&Rectangle::new(corners, BLACK.stroke_width(1)))?;
    }
    for (level, label) in bands.labels().iter().enumerate() {
        let y = bottom - step * level as i32;
        area.draw(&Text::new(
            label.as_str(),
            (LEFT_PX + BAR_PX + 10, y),
            text.clone(),
        ))?;
    }
    if field.values.iter().any(Option::is_none) {
        let y = bottom + 50;
        let corners = [(LEFT_PX, y - 12), (LEFT_PX + BAR_PX, y + 12)];
        area.draw(&Rectangle::new(corners, NOTHING.filled()))?;
        area.draw(&Text::new(
            field.nothing.as_str(),
            (LEFT_PX + BAR_PX + 10, y),
            text,
        ))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
