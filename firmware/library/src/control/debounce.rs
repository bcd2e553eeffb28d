//! How long something has lasted without a break.

/// Counts ticks.
#[derive(Clone, Copy, Debug)]
pub struct Debounce {
    count: u32,
    limit: u32,
}

impl Debounce {
    /// Over after so many ticks.
    pub const fn new(limit: u32) -> Self {
        Self { count: 0, limit }
    }

    /// One tick: whether the condition has held for the limit.
    #[inline(always)]
    pub fn update(&mut self, condition: bool) -> bool {
        self.count = if condition {
            self.count.saturating_add(1)
        } else {
            0
        };
        self.count >= self.limit
    }
}
