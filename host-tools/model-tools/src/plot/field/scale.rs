//! The colours of a map with the levels between them: those of its lines.

use super::bands::Bands;
use super::runs::{BETWEEN, NO_RESULT, OUTSIDE};
use super::{Field, Sample};
use crate::plot::canvas::{Area, Drawn, LABEL_PX};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub(super) const SCALE_WIDTH_PX: u32 = 310;
const LEFT_PX: i32 = 30;
const BAR_PX: i32 = 36;
const TOP_PX: i32 = 80;
/// Below the bar, for what has no colour.
const LEGEND_PX: i32 = 130;
const LINE_PX: i32 = 32;

pub(super) fn paint<B: DrawingBackend>(field: &Field, bands: &Bands, area: &Area<B>) -> Drawn<B> {
    let heading = [(&field.quantity, 1), (&field.unit, 0)];
    for (words, lines_above) in heading {
        let y = TOP_PX - 26 - LINE_PX * lines_above;
        area.draw(&Text::new(words.as_str(), (LEFT_PX, y), text(area)))?;
    }
    let (_, height) = area.dim_in_pixel();
    let step = (height as i32 - TOP_PX - LEGEND_PX) / bands.count().max(1) as i32;
    let bottom = TOP_PX + step * bands.count() as i32;
    for band in 0..bands.count() {
        let y = bottom - step * band as i32;
        let corners = [(LEFT_PX, y - step), (LEFT_PX + BAR_PX, y)];
        area.draw(&Rectangle::new(corners, bands.colour(band).filled()))?;
        area.draw(&Rectangle::new(corners, BLACK.stroke_width(1)))?;
    }
    for (level, label) in bands.labels().iter().enumerate() {
        label_at(area, label, bottom - step * level as i32)?;
    }
    paint_legend(field, area, bottom)
}

/// What has no colour, if there is any of it.
fn paint_legend<B: DrawingBackend>(field: &Field, area: &Area<B>, bottom: i32) -> Drawn<B> {
    let any = |is: fn(&Sample) -> bool| field.samples.iter().flatten().any(is);
    let no_value = |sample: &Sample| sample.room >= 0.0 && sample.value.is_none();
    let no_result = any(no_value) || field.samples.iter().any(Option::is_none);
    let entries = [
        (any(Sample::between), BETWEEN, field.between.as_str()),
        (any(Sample::outside), OUTSIDE, field.outside.as_str()),
        (no_result, NO_RESULT, "no result"),
    ];
    let shown = entries.into_iter().filter(|(shown, ..)| *shown);
    for ((_, colour, words), line) in shown.zip(0..) {
        let y = bottom + 45 + (LINE_PX + 4) * line;
        let corners = [(LEFT_PX, y - 12), (LEFT_PX + BAR_PX, y + 12)];
        area.draw(&Rectangle::new(corners, colour.filled()))?;
        label_at(area, words, y)?;
    }
    Ok(())
}

fn label_at<B: DrawingBackend>(area: &Area<B>, words: &str, y: i32) -> Drawn<B> {
    area.draw(&Text::new(words, (LEFT_PX + BAR_PX + 10, y), text(area)))
}

fn text<B: DrawingBackend>(area: &Area<B>) -> TextStyle<'static> {
    ("sans-serif", LABEL_PX)
        .into_text_style(area)
        .pos(Pos::new(HPos::Left, VPos::Center))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{BAR_PX, LEFT_PX, SCALE_WIDTH_PX, text};
    use crate::plot::canvas;
    use crate::workspace_map::{Quantity, SHADES};

    #[test]
    fn heading_and_legend_of_every_map_fit_beside_it() {
        let directory = tempfile::tempdir().unwrap();
        canvas::svg(&directory.path().join("scale.svg"), |area| {
            let room = SCALE_WIDTH_PX as i32 - LEFT_PX;
            for quantity in Quantity::ALL {
                let (width, _) = area.estimate_text_size(quantity.words(), &text(area))?;
                assert!((width as i32) < room, "{quantity:?}: {width} of {room} px");
            }
            for words in SHADES {
                let (width, _) = area.estimate_text_size(words, &text(area))?;
                let room = room - BAR_PX - 10;
                assert!((width as i32) < room, "{words}: {width} of {room} px");
            }
            Ok(())
        })
        .unwrap();
    }
}
