//! An SVG as bitmap and as page: one drawing, three files.

use super::error::PlotError;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{Options, Tree};
use std::sync::Arc;
use svg2pdf::{ConversionOptions, PageOptions};

/// Pixels of a picture in an inch of a page: eight inches wide.
const PIXELS_PER_INCH: f32 = 160.0;

/// A drawing that was read, with the font of its texts.
pub(super) struct Picture(Tree);

impl Picture {
    /// Reads an SVG.
    pub fn new(svg: &str) -> Result<Self, PlotError> {
        let mut fonts = Database::new();
        // A bare machine has none.
        fonts.load_font_source(Source::Binary(Arc::new(dejavu::sans::regular())));
        let family = fonts.faces().find_map(|face| face.families.first());
        let (family, _) = family.ok_or(PlotError::Font)?.clone();
        fonts.set_sans_serif_family(family);
        let options = Options {
            fontdb: Arc::new(fonts),
            ..Options::default()
        };
        Ok(Self(Tree::from_str(svg, &options)?))
    }

    /// As a PNG file, a pixel for each of the drawing.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        let size = self.0.size().to_int_size();
        let pixels = Pixmap::new(size.width(), size.height());
        let mut pixels = pixels.ok_or(PlotError::Empty)?;
        resvg::render(&self.0, Transform::identity(), &mut pixels.as_mut());
        Ok(pixels.encode_png()?)
    }

    /// As a PDF file of one page, whose texts are text.
    pub fn pdf(&self) -> Result<Vec<u8>, PlotError> {
        let page = PageOptions {
            dpi: PIXELS_PER_INCH,
        };
        svg2pdf::to_pdf(&self.0, ConversionOptions::default(), page)
            .map_err(|error| PlotError::Pdf(error.to_string()))
    }
}
