//! What every picture shares: its size, its files, its font.

use leg_base::atomic_file;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::io;
use std::path::{Path, PathBuf};

pub(super) const WIDTH_PX: u32 = 1280;
pub(super) const HEIGHT_PX: u32 = 800;
pub(super) const MARGIN_PX: u32 = 18;
const TITLE_PX: u32 = 30;
pub(super) const AXIS_TITLE_PX: u32 = 24;
pub(super) const LABEL_PX: u32 = 22;
/// Red, green and blue: what a [`BitMapBackend`] paints into a buffer.
const BYTES_PER_PIXEL: usize = 3;
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
    /// A file could not be written.
    #[error(
        "{file} cannot be written ({error}): see that the directory is writable and the disk not full"
    )]
    Write {
        /// Its name, in the directory that was asked for.
        file: String,
        /// The system's.
        error: io::Error,
    },
    /// The drawing could not be made.
    #[error("the chart cannot be drawn ({0})")]
    Draw(String),
    /// The bitmap could not be made.
    #[error("the chart has no bitmap ({0})")]
    Png(#[from] png::EncodingError),
}

/// A picture whose parts are known.
pub(super) trait Painter {
    /// Paints it from its background up.
    fn paint<B: DrawingBackend>(&self, root: &Area<B>) -> Drawn<B>;
}

/// Paints `stem.svg` and `stem.png`, each whole or not at all, and names the first.
pub(super) fn save_both(painter: &impl Painter, stem: &Path) -> Result<PathBuf, PlotError> {
    let size = (WIDTH_PX, HEIGHT_PX);
    let mut vectors = String::new();
    draw(SVGBackend::with_string(&mut vectors, size), painter)?;
    let svg = write(stem.with_extension("svg"), vectors.as_bytes())?;
    let mut pixels = vec![0; (WIDTH_PX * HEIGHT_PX) as usize * BYTES_PER_PIXEL];
    draw(BitMapBackend::with_buffer(&mut pixels, size), painter)?;
    write(stem.with_extension("png"), &png(&pixels)?)?;
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

fn png(pixels: &[u8]) -> Result<Vec<u8>, PlotError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, WIDTH_PX, HEIGHT_PX);
    encoder.set_color(png::ColorType::Rgb);
    let mut image = encoder.write_header()?;
    image.write_image_data(pixels)?;
    image.finish()?;
    Ok(bytes)
}

fn draw<B: DrawingBackend>(backend: B, painter: &impl Painter) -> Result<(), PlotError> {
    provide_font()?;
    let root = backend.into_drawing_area();
    painter
        .paint(&root)
        .and_then(|()| root.present())
        .map_err(|error| PlotError::Draw(error.to_string()))
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
    root.margin(MARGIN_PX, MARGIN_PX, MARGIN_PX, 0)
        .titled(title, ("sans-serif", TITLE_PX))
}

/// The smallest and the largest value.
pub(super) fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, value| {
        let (low, high) = range.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}
