//! What a strike did.

use super::OTHER_TICKS;
use super::activity::Activity;
use super::bars::StrikeBars;
use super::case::{Case, UNSTRUCK};
use super::cut_off::CutOff;
use super::preparation::PreparedLeg;
use crate::stand::Stand;
use leg_sim::plant::Defect;
use serde::Serialize;

/// What strikes.
#[derive(Clone, Debug)]
pub(super) struct Strike {
    pub index: u64,
    pub defect: Option<Defect>,
    pub name: &'static str,
    /// Counted from 0.
    pub tendon: usize,
}

/// A strike and what it did.
#[derive(Clone, Debug, Serialize)]
pub struct Struck {
    /// Its number: the seed and it repeat it.
    pub index: u64,
    /// The fault, by its name in scenarios; `none` for none.
    pub fault: &'static str,
    /// Its tendon, from 1.
    pub tendon: usize,
    /// What the leg did.
    pub state: Activity,
    /// The leg as a sentence.
    pub case: String,
    /// Highest true tension, N.
    pub tension_n: f64,
    /// Highest true tension while the leg homed, and after a fault that ended that, N.
    pub homing_n: f64,
    /// How far the tip was from rest or off the way, mm.
    pub tip_mm: f64,
    /// The first fault that the leg named.
    pub named: Option<&'static str>,
    /// How long after the strike, s; of a cell that wanders, how long it was off so far by then that it has to be named.
    pub named_s: Option<f64>,
    /// How long after the leg had stopped a motor was driven last, s; zero if none was 0.1 s after it.
    pub driven_s: f64,
    /// Whether the control law in f64 on the same sensors came to another state, or had other faults, for more than 0.1 s.
    pub left_shadow: bool,
    /// What it may do at most; none where the leg was not brought to where it should be struck.
    pub bars: Option<StrikeBars>,
    /// What was beyond its bar, as sentences.
    pub failures: Vec<String>,
}

impl Struck {
    pub(super) fn new(case: &Case, strike: &Strike) -> Self {
        Self {
            index: strike.index,
            fault: strike.name,
            tendon: strike.tendon + 1,
            state: case.activity,
            case: case.to_string(),
            tension_n: 0.0,
            homing_n: 0.0,
            tip_mm: 0.0,
            named: None,
            named_s: None,
            driven_s: 0.0,
            left_shadow: false,
            bars: None,
            failures: Vec::new(),
        }
    }

    /// A leg that was not brought to where it should be struck.
    pub(super) fn not_prepared(case: &Case, index: u64, reason: String) -> Self {
        let strike = Strike {
            index,
            defect: None,
            name: UNSTRUCK,
            tendon: 0,
        };
        Self {
            failures: vec![reason],
            ..Self::new(case, &strike)
        }
    }

    /// Whether everything was within its bar.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.failures.is_empty()
    }

    /// A sound leg keeps to its shadow. A fault comes to a limit at which what is rounded otherwise passes it a little sooner; once one of the two has
    /// stopped, the other may never pass it.
    pub(super) fn compare_shadow(&mut self, stand: &Stand) {
        let Err(error) = stand.require_shadow(OTHER_TICKS) else {
            return;
        };
        self.left_shadow = true;
        if self.fault == UNSTRUCK {
            self.failures.push(error);
        }
    }

    /// The bars of one that is beyond them, where no firmware could have braked it.
    pub(super) fn bars_by_cut_off(
        &mut self,
        prepared: &PreparedLeg,
        defect: Option<Defect>,
        bars: StrikeBars,
        f_max_n: f64,
    ) -> StrikeBars {
        let within = self.tension_n <= bars.tension_n && self.tip_mm <= bars.tip_mm;
        let Some(defect) = defect.filter(|_| bars.cut_off && !within) else {
            return bars;
        };
        match CutOff::new(prepared, defect, self.named_s) {
            Ok(cut_off) => cut_off.widened(bars, f_max_n),
            Err(error) => {
                self.failures.push(error);
                bars
            }
        }
    }

    pub(super) fn judge(&mut self, bars: &StrikeBars, fault: bool) {
        let mut failures = Vec::new();
        if self.tension_n > bars.tension_n {
            failures.push(format!("{:.1} N", self.tension_n));
        }
        if self.homing_n > bars.homing_n {
            failures.push(format!("{:.1} N while homing", self.homing_n));
        }
        if self.tip_mm > bars.tip_mm {
            failures.push(format!("tip {:.2} mm", self.tip_mm));
        }
        match (bars.named_s, self.named_s) {
            (Some(_), None) => failures.push("no fault".into()),
            (Some(bar), Some(found)) if found > bar => {
                failures.push(format!("fault after {found:.2} s"))
            }
            (_, Some(_)) if !fault => {
                failures.push(format!("false alarm: {}", self.named.unwrap_or_default()))
            }
            _ => {}
        }
        if self.driven_s > 0.0 {
            failures.push(format!("driven {:.2} s after the stop", self.driven_s));
        }
        self.failures.extend(failures);
        self.bars = Some(*bars);
    }
}
