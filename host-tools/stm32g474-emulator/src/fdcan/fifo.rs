//! The indices of a FIFO of three elements.

/// Elements in a FIFO: RM0440, FDCAN message RAM; embassy-stm32 has the same.
pub const DEPTH: u32 = 3;

/// Where a FIFO is read and written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fifo {
    /// The oldest element.
    pub get: u32,
    /// Elements that wait.
    pub fill: u32,
}

impl Fifo {
    /// The element that is written next.
    #[must_use]
    pub const fn put(self) -> u32 {
        (self.get + self.fill) % DEPTH
    }

    /// Whether every element waits.
    #[must_use]
    pub const fn is_full(self) -> bool {
        self.fill == DEPTH
    }

    /// The place of a new element; none where the FIFO is full and keeps what it has.
    pub fn push(&mut self, overwrite: bool) -> Option<u32> {
        if self.is_full() {
            if !overwrite {
                return None;
            }
            self.get = (self.get + 1) % DEPTH;
            self.fill -= 1;
        }
        let place = self.put();
        self.fill += 1;
        Some(place)
    }

    /// Lets go of the elements up to one; false where that one does not wait.
    pub fn acknowledge(&mut self, index: u32) -> bool {
        let count = (index + DEPTH - self.get % DEPTH) % DEPTH + 1;
        if index >= DEPTH || count > self.fill {
            return false;
        }
        self.get = (index + 1) % DEPTH;
        self.fill -= count;
        true
    }
}
