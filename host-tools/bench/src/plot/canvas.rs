//! What every picture shares: its size, its files, its font.

use super::error::PlotError;
use super::picture::Picture;
use leg_base::atomic_file;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::path::{Path, PathBuf};

/// Size of a picture, pixels.
const SIZE_PX: [u32; 2] = [1280, 800];
/// Units of a drawing in a pixel of its picture. Plotters rounds to whole ones: in pixels a flat curve would be a staircase.
const UNITS: u32 = 4;

/// So many pixels in units of the drawing.
pub(super) const fn px(pixels: u32) -> u32 {
    pixels * UNITS
}

/// The same, of an offset.
pub(super) const fn offset_px(pixels: i32) -> i32 {
    pixels * UNITS as i32
}

pub(super) const WIDTH: u32 = px(SIZE_PX[0]);
pub(super) const MARGIN: u32 = px(18);
const TITLE: u32 = px(30);
pub(super) const AXIS_TITLE: u32 = px(24);
pub(super) const LABEL: u32 = px(22);
pub(super) const TICK: u32 = px(5);
/// The thinnest line.
pub(super) const THIN: u32 = px(1);
pub(super) const GRID: RGBColor = RGBColor(225, 225, 225);

pub(super) type Area<B> = DrawingArea<B, Shift>;
pub(super) type DrawResult<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// A picture whose parts are known.
pub(super) trait Painter {
    /// Paints it from its background up.
    fn paint<B: DrawingBackend>(&self, root: &Area<B>) -> DrawResult<B>;
}

/// Paints `stem.svg`, and from it `stem.png` and `stem.pdf`, each whole or not at all, and names the first.
pub(super) fn save(painter: &impl Painter, stem: &Path) -> Result<PathBuf, PlotError> {
    let drawing = draw(painter)?;
    let picture = Picture::new(&drawing)?;
    let svg = write(stem.with_extension("svg"), drawing.as_bytes())?;
    write(stem.with_extension("png"), &picture.png()?)?;
    write(stem.with_extension("pdf"), &picture.pdf()?)?;
    Ok(svg)
}

fn write(file: PathBuf, bytes: &[u8]) -> Result<PathBuf, PlotError> {
    match atomic_file::replace(&file, |new| std::fs::write(new, bytes)) {
        Ok(()) => Ok(file),
        Err(error) => {
            let name = file.file_name().unwrap_or_default();
            let file = name.to_string_lossy().into_owned();
            Err(PlotError::Write { file, error })
        }
    }
}

/// The picture as SVG.
fn draw(painter: &impl Painter) -> Result<String, PlotError> {
    provide_font()?;
    let [width, height] = SIZE_PX.map(px);
    let mut drawing = String::new();
    let root = SVGBackend::with_string(&mut drawing, (width, height)).into_drawing_area();
    painter
        .paint(&root)
        .and_then(|()| root.present())
        .map_err(|error| PlotError::Draw(error.to_string()))?;
    drop(root);
    Ok(sized(&drawing))
}

/// The same in its size. Its lines turn round: a mitre reaches beyond the points of a spike, and shows a value that is not there.
fn sized(drawing: &str) -> String {
    let [width, height] = SIZE_PX.map(px);
    let [shown_width, shown_height] = SIZE_PX;
    drawing.replacen(
        &format!(r#"width="{width}" height="{height}""#),
        &format!(r#"width="{shown_width}" height="{shown_height}" stroke-linejoin="round""#),
        1,
    )
}

/// A font of our own: a bare machine has none.
pub(super) fn provide_font() -> Result<(), PlotError> {
    register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular())
        .map_err(|_| PlotError::Font)
}

/// What is left of a picture under its title, on white.
pub(super) fn titled<B: DrawingBackend>(
    root: &Area<B>,
    title: &str,
) -> Result<Area<B>, DrawingAreaErrorKind<B::ErrorType>> {
    root.fill(&WHITE)?;
    let body = root.margin(MARGIN, MARGIN, MARGIN, 0);
    let body = body.titled(title, ("sans-serif", TITLE))?;
    Ok(body.margin(px(8), 0, 0, 0))
}

/// The smallest and the largest value.
pub(super) fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, value| {
        let (low, high) = range.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}
