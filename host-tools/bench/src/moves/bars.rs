//! What a move may do.

use super::{DrawnMove, Moved};

/// The most that a move may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MoveBars {
    off_mm: f64,
    swing_mm: f64,
    settled_s: f64,
    rest_mm: f64,
}

/// A leg that leans less shows nothing of its payload before it moves, degrees.
const HIDDEN_DEG: f64 = 2.0;

/// A move from where the payload shows.
const SHOWN: MoveBars = MoveBars {
    off_mm: 0.25,
    swing_mm: 0.1,
    settled_s: 0.4,
    rest_mm: 0.02,
};

/// A move from straight down with a payload that nothing has shown yet: it is found on the way.
const HIDDEN: MoveBars = MoveBars {
    off_mm: 0.4,
    swing_mm: 0.2,
    settled_s: 0.8,
    rest_mm: 0.02,
};

/// A move from straight down with nothing: the leg does not know that either before it moves. It has nothing to swing with.
const NOTHING: MoveBars = MoveBars {
    off_mm: HIDDEN.off_mm,
    ..SHOWN
};

impl MoveBars {
    pub fn new(drawn: &DrawnMove) -> Self {
        if drawn.begin_deg[1] >= HIDDEN_DEG {
            SHOWN
        } else if drawn.payload_kg > 0.0 {
            HIDDEN
        } else {
            NOTHING
        }
    }

    /// What is beyond, as words.
    pub fn failures(&self, moved: &Moved) -> Vec<String> {
        let beyond = [
            ("off", moved.off_mm, self.off_mm, "mm"),
            ("swing", moved.swing_mm, self.swing_mm, "mm"),
            ("settled after", moved.settled_s, self.settled_s, "s"),
            ("at rest off by", moved.rest_mm, self.rest_mm, "mm"),
        ];
        let mut failures: Vec<_> = beyond
            .into_iter()
            .filter(|(_, value, bar, _)| value > bar)
            .map(|(what, value, bar, unit)| {
                format!("{what} {value:.2} {unit}, more than {bar} {unit}")
            })
            .collect();
        let (took_s, longest_s) = (moved.took_s, moved.drawn.longest_s());
        if took_s > longest_s {
            failures.push(format!("took {took_s:.4} s, more than {longest_s:.4} s"));
        }
        failures
    }
}
