//! Where the signals of the charts are from, and what is shown of them.

use crate::history::{History, KEPT_S};
use crate::shown_leg::ShownLeg;

/// Where the signals are from.
pub struct SignalSource<'a> {
    /// They.
    pub history: &'a History,
    /// From when to when there are some, s.
    pub since_s: f64,
    /// s.
    pub now_s: f64,
    /// The time at which a recording is, s; none of a leg that goes on.
    pub moment_s: Option<f64>,
}

impl<'a> SignalSource<'a> {
    /// Of a leg that goes on.
    #[must_use]
    pub fn new(leg: &'a ShownLeg) -> Self {
        let now_s = leg.time_s();
        Self {
            history: leg.history(),
            since_s: (now_s - KEPT_S).max(0.0),
            now_s,
            moment_s: None,
        }
    }
}

/// What the charts show of it.
#[derive(Clone, Copy)]
pub(super) struct ShownSignals<'a> {
    pub history: &'a History,
    /// From when to when there are signals, s.
    pub whole_s: [f64; 2],
    /// From when to when they are drawn, s.
    pub drawn_s: [f64; 2],
    /// The time at which a recording is, s.
    pub moment_s: Option<f64>,
    /// Whether it stands still, and may be dragged and zoomed.
    pub still: bool,
}
