//! The temperature of the drivers.

/// How fast it rises in overheating, and falls after it, K/s.
const RISE_K_PER_S: f64 = 20.0;

/// One temperature for all drivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Temperature {
    pub now_c: f64,
    ambient_c: f64,
}

impl Temperature {
    pub fn new(ambient_c: f64) -> Self {
        Self {
            now_c: ambient_c,
            ambient_c,
        }
    }

    /// Goes on for `span_s`.
    pub fn advance(&mut self, span_s: f64, heating: bool) {
        let change = RISE_K_PER_S * span_s;
        self.now_c = if heating {
            self.now_c + change
        } else {
            (self.now_c - change).max(self.ambient_c)
        };
    }
}
