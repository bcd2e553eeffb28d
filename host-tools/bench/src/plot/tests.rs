//! Charts as files.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{COLOURS, Chart, ChartLine, PlotError, Span, save};
use resvg::tiny_skia::{Color, Pixmap, PremultipliedColorU8};

fn chart(points: Vec<(f64, f64)>) -> Chart {
    Chart {
        title: "Title".into(),
        x_title: "tilt / °".into(),
        y_title: "deviation / mm".into(),
        lines: vec![ChartLine {
            label: "payload 2 kg".into(),
            marks: points.last().copied().into_iter().collect(),
            points,
        }],
        marks_label: "published".into(),
        ..Chart::default()
    }
}

#[test]
fn the_svg_names_everything() {
    let directory = tempfile::tempdir().unwrap();
    let chart = chart(vec![(-30.0, 8.0), (0.0, 0.0), (30.0, 8.0)]);
    let path = save(&chart, &directory.path().join("chart")).unwrap();
    let svg = std::fs::read_to_string(path).unwrap();
    for text in [
        "Title",
        "tilt / °",
        "deviation / mm",
        "payload 2 kg",
        "published",
        "-30",
    ] {
        assert!(svg.contains(text), "{text}");
    }
}

/// One page as wide as a page's text, with its words as text: a reader finds them.
#[test]
fn the_pdf_is_a_page_with_text() {
    let directory = tempfile::tempdir().unwrap();
    let pdf = |title: &str| {
        let chart = Chart {
            title: title.into(),
            ..chart(vec![(0.0, 0.0), (1.0, 1.0)])
        };
        let svg = save(&chart, &directory.path().join("chart")).unwrap();
        std::fs::read(svg.with_extension("pdf")).unwrap()
    };
    let page = pdf("A title");
    let text = String::from_utf8_lossy(&page);
    assert!(text.starts_with("%PDF-") && text.trim_end().ends_with("%%EOF"));
    for part in [
        "/MediaBox [0 0 576 360]",
        "DejaVuSans",
        "/ToUnicode",
        "/Count 1",
    ] {
        assert!(text.contains(part), "{part}");
    }
    assert_eq!(page, pdf("A title"), "alike to the byte");
    assert_ne!(page, pdf("Another title"));
}

/// A bare machine has no font.
#[test]
fn the_png_shows_its_text_and_a_flat_line_has_room() {
    let directory = tempfile::tempdir().unwrap();
    let png = |title: &str| {
        let flat = Chart {
            title: title.into(),
            ..chart(vec![(0.0, 0.0), (1.0, 0.0)])
        };
        let svg = save(&flat, &directory.path().join("chart")).unwrap();
        std::fs::read(svg.with_extension("png")).unwrap()
    };
    let (empty, titled) = (png(""), png("A title"));
    assert!(empty.starts_with(b"\x89PNG"));
    assert_ne!(empty, titled);
}

#[test]
fn nothing_to_draw_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let stem = directory.path().join("never");
    for points in [vec![], vec![(1.0, 1.0)]] {
        assert!(matches!(save(&chart(points), &stem), Err(PlotError::Empty)));
    }
    assert!(!stem.with_extension("svg").exists());
}

/// A joint at a spike reaches no farther than the points: at the top as at the bottom.
#[test]
fn a_spike_shows_no_value_that_is_not_there() {
    let directory = tempfile::tempdir().unwrap();
    let lowest_row = |spike: f64| {
        let points = vec![
            (0.0, 0.0),
            (4.0, 0.0),
            (4.01, spike),
            (4.02, 0.2 * spike),
            (4.1, 0.0),
            (10.0, 0.0),
        ];
        let mut chart = chart(points);
        chart.lines[0].marks = vec![(10.0, 1.0)];
        let svg = save(&chart, &directory.path().join("chart")).unwrap();
        let pixels = Pixmap::load_png(svg.with_extension("png")).unwrap();
        let [line, ..] = COLOURS;
        let line = Color::from_rgba8(line.0, line.1, line.2, 255)
            .premultiply()
            .to_color_u8();
        let rows = pixels.pixels().chunks(pixels.width() as usize);
        let shown = |row: &[PremultipliedColorU8]| row.contains(&line);
        rows.enumerate()
            .filter(|(_, row)| shown(row))
            .map(|(number, _)| number)
            .max()
    };
    let (spike, flat) = (lowest_row(1.0), lowest_row(0.0));
    assert!(spike <= flat, "{spike:?} {flat:?}");
}

/// Between the title of the vertical axis and its widest label there are white columns, however many digits that has.
#[test]
fn the_title_of_an_axis_touches_no_label() {
    let directory = tempfile::tempdir().unwrap();
    for highest in [1.0, 0.5, 0.05, 0.0005, 0.00005, 20_000.0, 3e6] {
        let mut chart = chart(vec![(0.0, 0.0), (1.0, highest)]);
        chart.marks_label = String::new();
        chart.lines[0].marks = vec![];
        let svg = save(&chart, &directory.path().join("chart")).unwrap();
        let pixels = Pixmap::load_png(svg.with_extension("png")).unwrap();
        let width = pixels.width() as usize;
        let inked = |x: &usize| {
            let mut column = pixels.pixels().iter().skip(*x).step_by(width);
            column.any(|pixel| pixel.red() < 200)
        };
        let begins = (0..width).find(inked).unwrap();
        let title_ends = (begins..width).find(|x| !inked(x)).unwrap();
        let labels_begin = (title_ends..width).find(inked).unwrap();
        let gap = labels_begin - title_ends;
        assert!(
            title_ends - begins < 30,
            "{highest}: {begins} to {title_ends}"
        );
        assert!(gap >= 4, "{highest}: {gap} pixels");
    }
}

/// Spans with one label have one shade, a span without room for its label has none, and the axis takes them in.
#[test]
fn spans_are_shaded_and_labelled() {
    let directory = tempfile::tempdir().unwrap();
    let span = |label: &str, shade, x| Span {
        label: label.into(),
        shade,
        x,
    };
    let chart = Chart {
        subtitle: "Subtitle".into(),
        spans: vec![
            span("homing", 2, 0.0..4.0),
            span("short", 1, 4.0..4.01),
            span("homing", 2, 4.01..8.0),
            span("active", 4, 8.0..20.0),
        ],
        ..chart(vec![(5.0, 1.0), (9.0, 2.0)])
    };
    let path = save(&chart, &directory.path().join("chart")).unwrap();
    let svg = std::fs::read_to_string(&path).unwrap();
    let page = std::fs::read(path.with_extension("pdf")).unwrap();
    save(&chart, &directory.path().join("chart")).unwrap();
    let again = std::fs::read(path.with_extension("pdf")).unwrap();
    assert!(page == again, "alike to the byte");
    let count = |text: &str| svg.matches(text).count();
    assert_eq!(
        ["homing", "short", "active", "Subtitle"].map(count),
        [3, 0, 2, 1],
        "each that is seen once in the legend, too"
    );
    let shades = [(230, 245, 239), (253, 243, 224), (250, 233, 226)];
    let fills = shades.map(|(r, g, b)| count(&format!("#{r:02X}{g:02X}{b:02X}")));
    assert_eq!(fills, [3, 1, 2]);
    assert!(
        svg.lines().any(|line| line.trim() == "20"),
        "the axis ends with the spans"
    );
}
