//! Lines of charts: no more points than a screen has, and grids at round numbers.

use crate::history::{Column, History};
use egui_plot::{GridInput, GridMark};
use leg_base::rounding::rounded;

/// Points of a line: more than a screen has.
const POINTS_MAX: usize = 1200;

/// The least height of a chart, as a part of its largest value.
const RANGE_MIN: f64 = 0.01;

/// About as many lines a grid has.
const GRID_LINES: f64 = 4.0;

/// What half a label of the time takes of a chart's width.
pub(super) const LABEL_PART: f64 = 0.06;

/// Each number of a signal between two times, s.
pub(super) fn lines(
    history: &History,
    column: Column,
    [from_s, until_s]: [f64; 2],
) -> Vec<Vec<[f64; 2]>> {
    let line = |number| {
        let points = history.line(column, number, from_s);
        points
            .take_while(|[time_s, _]| *time_s <= until_s)
            .collect()
    };
    (0..column.width).map(line).collect()
}

/// What a chart shows at least, so that it does not show rounding errors alone; none without points.
pub(super) fn least_range(lines: &[Vec<[f64; 2]>]) -> Option<[f64; 2]> {
    let values = || lines.iter().flatten().map(|[_, value]| *value);
    let low = values().min_by(f64::total_cmp)?;
    let high = values().max_by(f64::total_cmp)?;
    let half = 0.5 * RANGE_MIN * low.abs().max(high.abs());
    let middle = 0.5 * (low + high);
    Some([middle - half, middle + half])
}

/// Some lines of a grid at round numbers; none in the last part, where a label would have no room.
pub(super) fn grid(input: &GridInput, last_part: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let step_size = round_step((high - low) / GRID_LINES);
    let first = (low / step_size).ceil();
    // A plot of no height has no lines.
    let count = ((high - low) / step_size).min(100.0) as u32;
    let mark = |line: u32| GridMark {
        value: (first + f64::from(line)) * step_size,
        step_size,
    };
    let end = high - last_part * (high - low);
    (0..=count)
        .map(mark)
        .filter(|mark| mark.value <= end)
        .collect()
}

/// The next larger of 1, 2 and 5 with any power of ten.
fn round_step(step: f64) -> f64 {
    let unit = 10_f64.powf(step.max(1e-9).log10().floor());
    let part = step / unit;
    let round = [1.0, 2.0, 5.0].into_iter().find(|round| part <= *round);
    unit * round.unwrap_or(10.0)
}

/// A number without what its rounding leaves.
pub(super) fn short(value: f64) -> String {
    rounded(value, 6).to_string()
}

/// The same with a unit, if there is one.
pub(super) fn labelled(value: f64, unit: &str) -> String {
    let short = short(value);
    if unit.is_empty() {
        short
    } else {
        format!("{short} {unit}")
    }
}

/// What such labels take at least, points: nothing moves when numbers become longer.
pub(super) fn label_width(unit: &str) -> f32 {
    const NUMBER: f32 = 44.0;
    const LETTER: f32 = 8.0;
    NUMBER + LETTER * unit.chars().count() as f32
}

/// The lowest and the highest point of each of so many parts: no peak is lost.
pub(super) fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if points.len() <= POINTS_MAX {
        return points.to_vec();
    }
    let size = points.len().div_ceil(POINTS_MAX / 2);
    let mut kept = Vec::with_capacity(POINTS_MAX);
    for part in points.chunks(size) {
        let lowest = part.iter().min_by(|a, b| a[1].total_cmp(&b[1]));
        let highest = part.iter().max_by(|a, b| a[1].total_cmp(&b[1]));
        let (Some(a), Some(b)) = (lowest, highest) else {
            continue;
        };
        let [first, second] = if a[0] <= b[0] { [*a, *b] } else { [*b, *a] };
        kept.push(first);
        kept.push(second);
    }
    kept
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{POINTS_MAX, grid, labelled, least_range, round_step, short, thinned};
    use egui_plot::GridInput;

    #[test]
    fn lines_of_a_grid_are_at_round_numbers() {
        for (step, round) in [
            (1.0, 1.0),
            (1.1, 2.0),
            (0.03, 0.05),
            (37.0, 50.0),
            (60.0, 100.0),
        ] {
            assert!((round_step(step) / round - 1.0).abs() < 1e-12, "{step}");
        }
        assert!(round_step(0.0) > 0.0);
        assert_eq!(
            [0.1 + 0.2, -0.0, 1.0 / 3.0].map(short),
            ["0.3", "0", "0.333333"]
        );
        assert_eq!([labelled(20.0, "mm"), labelled(1.0, "")], ["20 mm", "1"]);
    }

    #[test]
    fn no_label_is_beyond_the_edge() {
        let values = |last_part| -> Vec<f64> {
            let input = GridInput {
                bounds: (0.0, 10.0),
                base_step_size: 1.0,
            };
            let marks = grid(&input, last_part).into_iter();
            marks.map(|mark| mark.value).collect()
        };
        assert_eq!(values(0.0), [0.0, 5.0, 10.0]);
        assert_eq!(values(0.06), [0.0, 5.0]);
    }

    #[test]
    fn rounding_errors_do_not_fill_a_chart() {
        let line = vec![[0.0, 2.0], [1.0, 2.000_001]];
        let [low, high] = least_range(&[line, Vec::new()]).unwrap();
        assert!((high - low - 0.02).abs() < 1e-6 && (low - 1.99).abs() < 1e-5);
        assert_eq!(least_range(&[vec![[0.0, 0.0]]]), Some([0.0, 0.0]));
        assert_eq!(least_range(&[]), None);
    }

    #[test]
    fn no_peak_is_lost() {
        let mut points: Vec<[f64; 2]> = (0..20_000).map(|i| [f64::from(i), 0.0]).collect();
        points[7_777][1] = 5.0;
        points[13_131][1] = -3.0;
        let kept = thinned(&points);
        assert!(kept.len() <= POINTS_MAX);
        assert!(kept.contains(&[7_777.0, 5.0]) && kept.contains(&[13_131.0, -3.0]));
        assert!(kept.is_sorted_by(|a, b| a[0] <= b[0]));
        let few = vec![[0.0, 1.0], [1.0, 2.0]];
        assert_eq!(thinned(&few), few);
    }
}
