//! Charts as files.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Chart, Line, PlotError, save_png, save_svg};

fn chart(points: Vec<(f64, f64)>) -> Chart {
    Chart {
        title: "Title".into(),
        x_title: "tilt / °".into(),
        y_title: "deviation / mm".into(),
        lines: vec![Line {
            label: "payload 2 kg".into(),
            marks: points.last().copied().into_iter().collect(),
            points,
        }],
        marks_label: "published".into(),
    }
}

#[test]
fn the_svg_names_everything() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("chart.svg");
    save_svg(&chart(vec![(-30.0, 8.0), (0.0, 0.0), (30.0, 8.0)]), &path).unwrap();
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

#[test]
fn the_png_shows_its_text_without_a_font_on_the_machine() {
    let directory = tempfile::tempdir().unwrap();
    let size = |name: &str, title: &str| {
        let path = directory.path().join(name);
        let chart = Chart {
            title: title.into(),
            ..chart(vec![(0.0, 0.0), (1.0, 1.0)])
        };
        save_png(&chart, &path).unwrap();
        std::fs::read(path).unwrap()
    };
    let (empty, titled) = (size("a.png", ""), size("b.png", "A title"));
    assert!(empty.starts_with(b"\x89PNG"));
    assert_ne!(empty, titled);
}

#[test]
fn nothing_to_draw_is_refused() {
    let path = std::path::Path::new("never.svg");
    for points in [vec![], vec![(1.0, 1.0)]] {
        assert!(matches!(
            save_svg(&chart(points), path),
            Err(PlotError::Empty)
        ));
    }
    assert!(!path.exists());
}

#[test]
fn a_flat_line_has_room() {
    let directory = tempfile::tempdir().unwrap();
    save_svg(
        &chart(vec![(0.0, 0.0), (1.0, 0.0)]),
        &directory.path().join("flat.svg"),
    )
    .unwrap();
}
