//! Two cursors in the charts, with their times, values and differences.

use crate::history::{Column, History};

/// Their names.
pub(super) const NAMES: [&str; 2] = ["A", "B"];

/// They.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cursors {
    /// s.
    pub at_s: [f64; 2],
    /// The one that is dragged.
    held: Option<usize>,
}

impl Cursors {
    /// In the thirds of what is shown, s.
    pub fn new([since_s, until_s]: [f64; 2]) -> Self {
        let third_s = (until_s - since_s) / 3.0;
        Self {
            at_s: [since_s + third_s, until_s - third_s],
            held: None,
        }
    }

    /// Draws the nearer one to a time, s, and keeps it until it is let go.
    pub fn draw(&mut self, to_s: f64) {
        let [a, b] = self.at_s.map(|at_s| (at_s - to_s).abs());
        let held = *self.held.get_or_insert(usize::from(b < a));
        if let Some(at_s) = self.at_s.get_mut(held) {
            *at_s = to_s;
        }
    }

    /// Lets go what is dragged.
    pub const fn let_go(&mut self) {
        self.held = None;
    }

    /// Their times in words of one length.
    pub fn words(&self) -> String {
        let [a_s, b_s] = self.at_s;
        let between_s = b_s - a_s;
        let rate = if between_s == 0.0 {
            format!("{:>10}", "")
        } else {
            format!("{:7.2} Hz", 1.0 / between_s.abs())
        };
        format!("A {a_s:9.3} s   B {b_s:9.3} s   B−A {between_s:8.3} s {rate}")
    }

    /// What a number of a signal is at each, and by how much it differs.
    pub fn values(&self, history: &History, column: Column, number: usize) -> [f64; 3] {
        let value = |at_s| {
            let numbers = history.numbers_at(column, at_s);
            numbers
                .get(number)
                .map_or(f64::NAN, |value| f64::from(*value))
        };
        let [a, b] = self.at_s.map(value);
        [a, b, b - a]
    }
}

/// Numbers of a signal at the cursors with their unit, in words of one length.
pub(super) fn values_words([a, b, difference]: [f64; 3], unit: &str) -> String {
    let word = |value: f64| {
        let digits = if value.abs() < 10.0 { 4 } else { 2 };
        if value.is_finite() {
            format!("{value:9.digits$}")
        } else {
            format!("{:>9}", "none")
        }
    };
    format!(
        "A {} B {} B−A {} {unit}",
        word(a),
        word(b),
        word(difference)
    )
}

#[cfg(test)]
mod tests {
    use super::{Cursors, values_words};
    use crate::history::History;

    #[test]
    fn the_nearer_one_is_drawn_and_stays_drawn() {
        let mut cursors = Cursors::new([0.0, 3.0]);
        assert_eq!(cursors.at_s, [1.0, 2.0]);
        for to_s in [1.8, 0.5, 0.2] {
            cursors.draw(to_s);
        }
        assert_eq!(cursors.at_s, [1.0, 0.2]);
        cursors.let_go();
        cursors.draw(1.2);
        assert_eq!(cursors.at_s, [1.2, 0.2]);
        assert!(
            cursors.words().contains("B−A   -1.000 s    1.00 Hz"),
            "{}",
            cursors.words()
        );
    }

    #[test]
    fn values_are_those_of_the_last_sample_until_then() {
        let columns = History::live();
        let width = columns
            .columns()
            .iter()
            .map(|column| column.width)
            .sum::<usize>();
        let samples = [1.0_f32, 2.0].map(|time| (f64::from(time), vec![10.0 * time; width].into()));
        let history = History::recorded(false, samples.into_iter());
        let column = columns.columns()[3];
        let cursors = Cursors {
            at_s: [1.5, 2.5],
            held: None,
        };
        assert_eq!(cursors.values(&history, column, 0), [10.0, 20.0, 10.0]);
        assert!(cursors.values(&history, column, 99)[0].is_nan());
    }

    #[test]
    fn words_keep_their_length() {
        let length = |values| values_words(values, "N").chars().count();
        let first = length([0.0; 3]);
        for values in [[9.99, -120.5, 1e4], [f64::NAN; 3], [-0.1234, 22.0, -99.0]] {
            assert_eq!(length(values), first);
        }
        let words = |at_s| Cursors { at_s, held: None }.words().chars().count();
        assert_eq!(words([0.0, 0.0]), words([12.0, 99.123]));
    }
}
