//! The rows of a board's recorder in SI units.

use leg_firmware::recorder::{RecordedFault, RecorderReport, Triple};
use leg_firmware::settings::Settings;
use leg_firmware::settings::{RECORDED_SIGNALS, RecordedSignal};
use leg_firmware::supervisor::State;

/// A tick as the recorder kept it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecorderRow {
    /// The tick.
    pub tick: u32,
    /// The fault that ended the recording; none if a host did.
    pub fault: Option<RecordedFault>,
    /// By signal: what [`RecordedSignal`] says; none of what was not recorded.
    values: [Option<[f64; 3]>; RECORDED_SIGNALS.len()],
}

impl RecorderRow {
    /// A signal's three numbers; none if it was not recorded.
    #[must_use]
    pub fn get(&self, signal: RecordedSignal) -> Option<[f64; 3]> {
        let mut all = RECORDED_SIGNALS.into_iter().zip(self.values);
        all.find_map(|(each, values)| values.filter(|_| each == signal))
    }

    /// The same, as another program may have written it.
    #[must_use]
    pub fn new(
        tick: u32,
        fault: Option<RecordedFault>,
        get: impl Fn(RecordedSignal) -> Option<[f64; 3]>,
    ) -> Self {
        Self {
            tick,
            fault,
            values: RECORDED_SIGNALS.map(get),
        }
    }

    /// Ticks since the fault; none if a host ended the recording.
    #[must_use]
    pub fn ticks_since_fault(&self) -> Option<i32> {
        self.fault
            .map(|fault| self.tick.wrapping_sub(fault.tick) as i32)
    }

    /// The leg's state, if that was recorded.
    #[must_use]
    pub fn state(&self) -> Option<State> {
        let [_, _, number] = self.get(RecordedSignal::Board)?;
        State::ALL.get(number as usize).copied()
    }
}

/// The rows of a report, the oldest first, by all triples that belong to it: each number is unwrapped from that of the row after
/// it, back from the newest, which the report has in full.
#[must_use]
pub fn rows(report: &RecorderReport, triples: &[Triple], settings: &Settings) -> Vec<RecorderRow> {
    let recorded: Vec<_> = (0..)
        .zip(RECORDED_SIGNALS)
        .filter(|(_, signal)| report.signals.has(*signal))
        .collect();
    let mut steps = report.newest;
    let mut rows: Vec<_> = triples
        .chunks_exact(recorded.len().max(1))
        .rev()
        .zip(0..)
        .map(|(row, age)| {
            let mut values = [None; RECORDED_SIGNALS.len()];
            for (triple, &(index, signal)) in row.iter().zip(&recorded) {
                let after: &mut [i32; 3] = &mut steps[index];
                for (after, &now) in after.iter_mut().zip(triple) {
                    let change = now.wrapping_sub(*after as u16) as i16;
                    *after = after.wrapping_add(change.into());
                }
                let units = signal.steps(settings);
                values[index] = Some([0, 1, 2].map(|i| f64::from(after[i]) * f64::from(units[i])));
            }
            RecorderRow {
                tick: report.tick.wrapping_sub(age),
                fault: report.fault,
                values,
            }
        })
        .collect();
    rows.reverse();
    rows
}
