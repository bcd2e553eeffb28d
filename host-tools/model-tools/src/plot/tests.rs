//! Charts as files.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::canvas::WIDTH_PX;
use super::{COLOURS, Chart, ChartLine, PlotError, Span, save_both};

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
    let path = save_both(&chart, &directory.path().join("chart")).unwrap();
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

/// A bare machine has no font.
#[test]
fn the_png_shows_its_text_and_a_flat_line_has_room() {
    let directory = tempfile::tempdir().unwrap();
    let png = |title: &str| {
        let flat = Chart {
            title: title.into(),
            ..chart(vec![(0.0, 0.0), (1.0, 0.0)])
        };
        let svg = save_both(&flat, &directory.path().join("chart")).unwrap();
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
        assert!(matches!(
            save_both(&chart(points), &stem),
            Err(PlotError::Empty)
        ));
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
        let svg = save_both(&chart, &directory.path().join("chart")).unwrap();
        let file = std::fs::File::open(svg.with_extension("png")).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let rows = pixels.chunks(3 * WIDTH_PX as usize);
        let [line, ..] = COLOURS;
        let shown = |row: &[u8]| row.as_chunks::<3>().0.contains(&[line.0, line.1, line.2]);
        rows.enumerate()
            .filter(|(_, row)| shown(row))
            .map(|(number, _)| number)
            .max()
    };
    let (spike, flat) = (lowest_row(1.0), lowest_row(0.0));
    assert!(spike <= flat, "{spike:?} {flat:?}");
}

/// Spans with one label have one shade, a span without room for its label has none, and the axis takes them in.
#[test]
fn spans_are_shaded_and_labelled() {
    let directory = tempfile::tempdir().unwrap();
    let span = |label: &str, x| Span {
        label: label.into(),
        x,
    };
    let chart = Chart {
        subtitle: "Subtitle".into(),
        spans: vec![
            span("homing", 0.0..4.0),
            span("short", 4.0..4.01),
            span("homing", 4.01..8.0),
            span("active", 8.0..20.0),
        ],
        ..chart(vec![(5.0, 1.0), (9.0, 2.0)])
    };
    let path = save_both(&chart, &directory.path().join("chart")).unwrap();
    let svg = std::fs::read_to_string(path).unwrap();
    let count = |text: &str| svg.matches(text).count();
    assert_eq!(
        ["homing", "short", "active", "Subtitle"].map(count),
        [2, 0, 1, 1]
    );
    let shades = [(242, 242, 242), (253, 243, 224), (230, 245, 239)];
    let fills = shades.map(|(r, g, b)| count(&format!("#{r:02X}{g:02X}{b:02X}")));
    assert_eq!(fills, [2, 1, 1]);
    assert!(
        svg.lines().any(|line| line.trim() == "20"),
        "the axis ends with the spans"
    );
}
