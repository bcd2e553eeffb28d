//! Which tendon is reeled in.

/// The tendon that is reeled in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TendonNumber {
    First,
    Second,
    Third,
}

impl TendonNumber {
    /// Counted from 0.
    pub const fn index(self) -> usize {
        match self {
            Self::First => 0,
            Self::Second => 1,
            Self::Third => 2,
        }
    }

    /// Counted from 1.
    pub const fn number(self) -> u8 {
        match self {
            Self::First => 1,
            Self::Second => 2,
            Self::Third => 3,
        }
    }

    /// The one after it.
    pub const fn next(self) -> Option<Self> {
        match self {
            Self::First => Some(Self::Second),
            Self::Second => Some(Self::Third),
            Self::Third => None,
        }
    }
}
