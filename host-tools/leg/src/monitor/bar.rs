//! A tension as a bar between its bounds.

use ratatui::style::{Color, Style};
use ratatui::text::Span;

/// How far beyond the maximum tension a bar reaches, as a part of it.
const BAR_REACH: f32 = 1.1;

/// Distance from a bound at which a bar warns, as a part of the maximum tension.
const WARNING_PART: f32 = 0.03;

/// A bar of `width` places: full up to the value, with a mark at either bound.
pub(super) fn bar(value: f32, [f_min_n, f_max_n]: [f32; 2], width: usize) -> Span<'static> {
    let place = |at: f32| (at / (f_max_n * BAR_REACH) * width as f32).round() as usize;
    let (full, marks) = (place(value), [place(f_min_n), place(f_max_n)]);
    let text: String = (0..width)
        .map(|at| match (marks.contains(&at), at < full) {
            (true, true) => '┃',
            (true, false) => '│',
            (false, true) => '█',
            (false, false) => '·',
        })
        .collect();
    Span::styled(text, Style::new().fg(colour(value, [f_min_n, f_max_n])))
}

fn colour(value: f32, [f_min_n, f_max_n]: [f32; 2]) -> Color {
    let near = WARNING_PART * f_max_n;
    if value < f_min_n || value > f_max_n {
        Color::Red
    } else if value < f_min_n + near || value > f_max_n - near {
        Color::Yellow
    } else {
        Color::Green
    }
}

#[cfg(test)]
mod tests {
    use super::bar;
    use ratatui::style::Color;

    #[test]
    fn the_bounds_are_marked() {
        let shown = |value| bar(value, [8.0, 150.0], 33);
        assert_eq!(shown(0.0).content, "··│···························│··");
        assert_eq!(
            shown(75.0).content,
            "██┃████████████·· ·············│··".replace(' ', "")
        );
        let colours = [0.0, 9.0, 75.0, 160.0].map(|value| shown(value).style.fg);
        let expected = [Color::Red, Color::Yellow, Color::Green, Color::Red];
        assert_eq!(colours, expected.map(Some));
    }
}
