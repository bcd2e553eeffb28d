//! The worst of each loop and amplitude.

use super::{DrawnState, Feedback, GAIN_DB, PHASE_DEG, Swept};
use serde::Serialize;

/// One of the two margins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Margin {
    /// Of the gain, dB.
    Gain,
    /// Of the phase, degrees.
    Phase,
}

impl Margin {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Gain, Self::Phase];

    /// The least that is allowed.
    #[must_use]
    pub const fn bar(self) -> f64 {
        match self {
            Self::Gain => GAIN_DB,
            Self::Phase => PHASE_DEG,
        }
    }

    /// Its unit.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Gain => "dB",
            Self::Phase => "°",
        }
    }

    /// Its value and its frequency, Hz, in a measurement.
    #[must_use]
    pub fn value_and_hz(self, swept: &Swept) -> Option<[f64; 2]> {
        let margins = &swept.margins;
        let (value, hz) = match self {
            Self::Gain => (margins.gain_db, margins.gain_hz),
            Self::Phase => (margins.phase_deg, margins.phase_hz),
        };
        Some([value?, hz?])
    }
}

/// The worst margin of a loop at an amplitude.
#[derive(Clone, Debug, Serialize)]
pub struct MarginRow {
    /// The loop.
    pub feedback: Feedback,
    /// Of what is added, V or N.
    pub amplitude: f64,
    /// Whether it is the smaller of two amplitudes.
    pub smaller: bool,
    /// Of the gain or of the phase.
    pub margin: Margin,
    /// The worst; none where the loop has none in any state.
    pub worst: Option<WorstMargin>,
    /// How many measurements there are.
    pub measured: usize,
    /// How many of them were below the bar.
    pub low: usize,
    /// How many did not come to their end.
    pub ended: usize,
}

impl MarginRow {
    /// Whether every measurement came to its end and is above the bar.
    #[must_use]
    pub const fn passes(&self) -> bool {
        self.low == 0 && self.ended == 0
    }
}

/// A margin and where it was found.
#[derive(Clone, Debug, Serialize)]
pub struct WorstMargin {
    /// dB or degrees.
    pub value: f64,
    /// Hz.
    pub hz: f64,
    /// Motor or tilt.
    pub place: &'static str,
    /// Pose, payload and pretension.
    pub state: DrawnState,
    /// Which of the measurements it is.
    #[serde(skip)]
    pub index: usize,
}

/// A row for each loop, amplitude and margin.
#[must_use]
pub fn rows(swept: &[Swept]) -> Vec<MarginRow> {
    let mut rows = Vec::new();
    for feedback in Feedback::ALL {
        for smaller in [false, true] {
            let all = || {
                let numbered = swept.iter().enumerate();
                numbered.filter(|(_, one)| one.feedback == feedback && one.smaller == smaller)
            };
            if let Some((_, first)) = all().next() {
                rows.extend(Margin::ALL.map(|margin| row(margin, first, all())));
            }
        }
    }
    rows
}

fn row<'a>(
    margin: Margin,
    first: &Swept,
    all: impl Iterator<Item = (usize, &'a Swept)>,
) -> MarginRow {
    let mut row = MarginRow {
        feedback: first.feedback,
        amplitude: first.amplitude,
        smaller: first.smaller,
        margin,
        worst: None,
        measured: 0,
        low: 0,
        ended: 0,
    };
    for (index, swept) in all {
        row.measured += 1;
        row.amplitude = row.amplitude.max(swept.amplitude);
        let found = margin.value_and_hz(swept);
        row.low += usize::from(found.is_some_and(|[value, _]| value < margin.bar()));
        row.ended += usize::from(swept.failure.is_some());
        if let Some([value, hz]) = found
            && row.worst.as_ref().is_none_or(|worst| value < worst.value)
        {
            row.worst = Some(WorstMargin {
                value,
                hz,
                place: swept.place,
                state: swept.state.clone(),
                index,
            });
        }
    }
    row
}
