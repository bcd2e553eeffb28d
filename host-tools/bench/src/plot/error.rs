//! Why a picture was not made.

use std::io;

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
    /// The drawing could not be read again.
    #[error("the chart's drawing cannot be read ({0})")]
    Svg(#[from] resvg::usvg::Error),
    /// The bitmap could not be made.
    #[error("the chart has no bitmap ({0})")]
    Png(#[from] png::EncodingError),
    /// The page could not be made.
    #[error("the chart has no page ({0})")]
    Pdf(String),
}
