//! Rows of the recorder from what a board sends.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::recorder_rows::rows;
use leg_firmware::recorder::{RecordedFault, RecorderReport, RecorderState};
use leg_firmware::settings::Settings;
use leg_firmware::settings::{RecordedSignal, SignalSet};
use leg_firmware::supervisor::{Fault, FaultSet};

/// A travel over more than 16 bits comes back to the count, and so does a negative one.
#[test]
fn numbers_are_unwrapped_from_the_newest_row() {
    let settings = Settings::table_1().unwrap();
    let counts: Vec<i32> = (0..300)
        .map(|row| 70_000 - 30_000 * (row % 2) - 500 * row)
        .collect();
    let triples: Vec<_> = counts
        .iter()
        .flat_map(|&count| [[0; 3], [count as u16, 7, 0]])
        .collect();
    let mut newest = [[0; 3]; 8];
    newest[RecordedSignal::Pulled as usize] = [*counts.last().unwrap(), 7, -65_536];
    let report = RecorderReport {
        state: RecorderState::Faulted,
        signals: SignalSet::new(&[RecordedSignal::Tensions, RecordedSignal::Pulled]),
        rows: 300,
        tick: 9,
        fault: Some(RecordedFault {
            tick: 5,
            faults: FaultSet::single(Fault::Slack),
        }),
        newest,
    };
    let rows = rows(&report, &triples, &settings);
    assert_eq!(rows.len(), counts.len());
    let m_per_count = settings.axes.map(|axis| f64::from(axis.m_per_count.abs()));
    for (row, count) in rows.iter().zip(counts) {
        let [first, second, third] = row.get(RecordedSignal::Pulled).unwrap();
        assert_eq!(first, f64::from(count) * m_per_count[0]);
        assert_eq!(
            [second, third],
            [7.0 * m_per_count[1], -65_536.0 * m_per_count[2]]
        );
        assert_eq!((row.get(RecordedSignal::Duties), row.state()), (None, None));
    }
    assert_eq!((rows[299].tick, rows[289].tick), (9, u32::MAX));
    assert_eq!(
        [rows[299].ticks_since_fault(), rows[289].ticks_since_fault()],
        [Some(4), Some(-6)]
    );
}
