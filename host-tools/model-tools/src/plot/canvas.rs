//! What every picture shares: its size, and a font of our own, for a bare machine has none.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::path::Path;

pub(super) const WIDTH_PX: u32 = 1280;
pub(super) const HEIGHT_PX: u32 = 800;
pub(super) const MARGIN_PX: u32 = 18;
pub(super) const TITLE_PX: u32 = 30;
pub(super) const AXIS_TITLE_PX: u32 = 24;
pub(super) const LABEL_PX: u32 = 22;
pub(super) const GRID: RGBColor = RGBColor(225, 225, 225);

pub(super) type Area<B> = DrawingArea<B, Shift>;
pub(super) type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// Why a chart was not drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// There is nothing to draw.
    #[error("the chart has no points: give at least two that differ in x")]
    Empty,
    /// The bundled font is damaged.
    #[error("the bundled font cannot be read: build the tool anew")]
    Font,
    /// The file could not be put in its place.
    #[error(
        "the chart cannot be written ({0}): see that the directory is writable and the disk not full"
    )]
    Write(#[from] std::io::Error),
    /// The drawing could not be made.
    #[error(
        "the chart cannot be drawn ({0}): see that the directory is writable and the disk not full"
    )]
    Draw(String),
}

/// Paints an SVG file.
pub(super) fn svg<'a>(
    path: &'a Path,
    paint: impl FnOnce(&Area<SVGBackend<'a>>) -> Drawn<SVGBackend<'a>>,
) -> Result<(), PlotError> {
    draw(SVGBackend::new(path, (WIDTH_PX, HEIGHT_PX)), paint)
}

/// Paints a PNG file; the path has to end in `.png`.
pub(super) fn png<'a>(
    path: &'a Path,
    paint: impl FnOnce(&Area<BitMapBackend<'a>>) -> Drawn<BitMapBackend<'a>>,
) -> Result<(), PlotError> {
    draw(BitMapBackend::new(path, (WIDTH_PX, HEIGHT_PX)), paint)
}

fn draw<B: DrawingBackend>(
    backend: B,
    paint: impl FnOnce(&Area<B>) -> Drawn<B>,
) -> Result<(), PlotError> {
    register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular())
        .map_err(|_| PlotError::Font)?;
    let root = backend.into_drawing_area();
    paint(&root)
        .and_then(|()| root.present())
        .map_err(|error| PlotError::Draw(error.to_string()))
}

/// The smallest and the largest value.
pub(super) fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, value| {
        let (low, high) = range.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}
