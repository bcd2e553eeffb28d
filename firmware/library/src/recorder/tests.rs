#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{
    HOST_TICKS, READ_MAX, RecordedFault, Recorder, RecorderReply, RecorderReport, RecorderRequest,
    RecorderSetup, RecorderState, TRIPLES_MAX, Triple,
};
use crate::leg::Leg;
use crate::sensors::{Sensors, TICK_HZ};
use crate::settings::{RECORDED_SIGNALS, RecordedSignal, Settings, SignalSet};
use crate::supervisor::{Fault, FaultSet};

/// A leg at rest whose first encoder a test moves, and the recorder of its ticks.
struct Bench {
    leg: Leg<f32>,
    recorder: Recorder,
    sensors: Sensors,
}

/// Ticks in which a leg boots.
const BOOT_TICKS: u32 = 40;

impl Bench {
    fn new(signals: SignalSet) -> Self {
        let mut settings = Settings::table_1().unwrap();
        settings.recorded = signals;
        let mut bench = Self {
            leg: Leg::new(&settings).unwrap(),
            recorder: Recorder::new(),
            sensors: Sensors::resting(&settings),
        };
        bench.recorder.begin(&RecorderSetup::new(&settings));
        bench
    }

    fn tick(&mut self) {
        // Load cells that show the same code for long are stuck; each is looked at every few ticks.
        for code in &mut self.sensors.cell_codes {
            *code = 5240 + (self.leg.ticks() / 4 % 2) as u16;
        }
        let drive = self.leg.tick(&self.sensors);
        self.recorder.record(&self.leg, &drive);
    }

    fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    fn ask(&mut self, request: RecorderRequest) -> RecorderReport {
        match self.recorder.answer(request) {
            Some(RecorderReply::Report(report)) => report,
            other => panic!("{other:?}"),
        }
    }

    fn state(&mut self) -> RecorderState {
        self.ask(RecorderRequest::Report).state
    }

    fn read(&mut self) -> Vec<Triple> {
        let mut all = Vec::new();
        loop {
            match self
                .recorder
                .answer(RecorderRequest::Read(all.len() as u16))
            {
                Some(RecorderReply::Triples(triples)) if triples.is_empty() => return all,
                Some(RecorderReply::Triples(triples)) => {
                    assert!(triples.len() <= READ_MAX);
                    all.extend(triples);
                }
                other => panic!("{other:?}"),
            }
        }
    }
}

/// What it reports of an emergency stop.
fn stopped_in(tick: u32) -> Option<RecordedFault> {
    let faults = FaultSet::single(Fault::EmergencyStop);
    Some(RecordedFault { tick, faults })
}

fn only(signal: RecordedSignal) -> SignalSet {
    SignalSet::new(&[signal])
}

#[test]
fn a_set_has_what_was_put_into_it() {
    assert!(SignalSet::NONE.is_empty());
    for (index, signal) in RECORDED_SIGNALS.into_iter().enumerate() {
        assert_eq!(signal as usize, index);
        let set = only(signal);
        assert_eq!(set.len(), 1);
        assert!(
            RECORDED_SIGNALS
                .iter()
                .all(|other| set.has(*other) == (*other == signal))
        );
    }
    assert_eq!(
        SignalSet::new(&RECORDED_SIGNALS).len(),
        RECORDED_SIGNALS.len()
    );
    let default = SignalSet::default();
    assert_eq!(TRIPLES_MAX / default.len(), 1600, "0.2 s at 8 kHz");
}

#[test]
fn three_signals_are_kept_for_a_fifth_of_a_second_and_more_for_less() {
    for width in 1..=RECORDED_SIGNALS.len() {
        let mut bench = Bench::new(SignalSet::new(&RECORDED_SIGNALS[..width]));
        bench.run(TRIPLES_MAX as u32 / width as u32 + 10);
        let rows = usize::from(bench.ask(RecorderRequest::Stop).rows);
        assert_eq!(rows, TRIPLES_MAX / width);
        assert_eq!(rows >= TICK_HZ as usize / 5, width <= 3);
    }
}

#[test]
fn rows_come_in_their_order_round_the_end_and_the_newest_in_full() {
    let mut bench = Bench::new(only(RecordedSignal::Pulled));
    let rows = TRIPLES_MAX as u32;
    let ticks = rows + rows / 3;
    for _ in 0..ticks {
        bench.sensors.encoder_counts[0] = bench.sensors.encoder_counts[0].wrapping_add(30);
        bench.tick();
    }
    let report = bench.ask(RecorderRequest::Stop);
    assert_eq!(report.state, RecorderState::Stopped);
    assert_eq!(u32::from(report.rows), rows);
    assert_eq!(report.tick, ticks);
    let read = bench.read();
    assert_eq!(read.len(), TRIPLES_MAX);
    // More counts than 16 bits have. The first reading is that from which the leg counts.
    let [newest, ..] = report.newest[RecordedSignal::Pulled as usize];
    assert_eq!(newest.unsigned_abs(), 30 * (ticks - 1));
    assert_eq!(read.last().unwrap()[0], newest as u16);
    for pair in read.windows(2) {
        let change = pair[1][0].wrapping_sub(pair[0][0]) as i16;
        assert_eq!(change.unsigned_abs(), 30);
    }
}

#[test]
fn every_signal_has_its_place_in_a_row() {
    let mut bench = Bench::new(SignalSet::new(&RECORDED_SIGNALS));
    bench.run(BOOT_TICKS);
    let report = bench.ask(RecorderRequest::Stop);
    let read = bench.read();
    assert_eq!(read.len(), RECORDED_SIGNALS.len() * BOOT_TICKS as usize);
    let newest = &read[read.len() - RECORDED_SIGNALS.len()..];
    let settings = Settings::table_1().unwrap();
    for ((signal, triple), full) in RECORDED_SIGNALS.into_iter().zip(newest).zip(report.newest) {
        assert_eq!(full.map(|steps| steps as u16), *triple);
        let [first, second, third] = signal.steps(&settings);
        let [a, b, c] = [
            full[0] as f32 * first,
            full[1] as f32 * second,
            full[2] as f32 * third,
        ];
        match signal {
            RecordedSignal::Board => {
                assert!(
                    (a - 24.0).abs() < 0.01 && (b - 25.0).abs() < 0.01,
                    "{a} {b}"
                );
                assert_eq!(c, f32::from(bench.leg.state() as u8));
            }
            // No cell is tared.
            RecordedSignal::Tensions => assert!([a, b, c].iter().all(|n| n.abs() < 0.02)),
            RecordedSignal::Currents => assert!([a, b, c].iter().all(|amps| amps.abs() < 1e-3)),
            RecordedSignal::Pose => assert!(a.abs() < 1e-3 && b.abs() < 1e-3),
            _ => assert_eq!([a, b, c], [0.0; 3], "{signal:?}"),
        }
    }
}

#[test]
fn a_fault_ends_it_after_a_quarter_and_a_cleared_one_begins_it_anew() {
    let mut bench = Bench::new(SignalSet::default());
    bench.run(2000);
    bench.sensors.emergency_stop = true;
    bench.tick();
    let report = bench.ask(RecorderRequest::Stop);
    assert_eq!(
        report.state,
        RecorderState::Triggered,
        "a host does not end it"
    );
    assert_eq!(bench.recorder.answer(RecorderRequest::Read(0)), None);
    bench.run(398);
    assert_eq!(bench.state(), RecorderState::Triggered);
    bench.run(1);
    let report = bench.ask(RecorderRequest::Report);
    assert_eq!(report.state, RecorderState::Faulted);
    assert_eq!((report.fault, report.tick), (stopped_in(2001), 2400));
    let kept = bench.read();
    assert_eq!(kept.len(), TRIPLES_MAX);
    bench.run(HOST_TICKS + 1);
    assert_eq!(
        bench.ask(RecorderRequest::Restart).state,
        RecorderState::Faulted
    );
    assert_eq!(bench.read(), kept);
    bench.sensors.emergency_stop = false;
    bench.run(BOOT_TICKS);
    assert!(bench.leg.command(1, crate::command::Command::Clear));
    bench.run(8);
    let report = bench.ask(RecorderRequest::Report);
    assert_eq!(
        (report.state, report.fault),
        (RecorderState::Recording, None)
    );
    assert!(report.rows <= 8);
}

#[test]
fn a_host_that_has_gone_does_not_keep_it_from_recording() {
    let mut bench = Bench::new(SignalSet::default());
    bench.run(BOOT_TICKS);
    bench.ask(RecorderRequest::Stop);
    bench.run(HOST_TICKS - 1);
    let _ = bench.read();
    bench.run(HOST_TICKS - 1);
    assert_eq!(
        bench.state(),
        RecorderState::Stopped,
        "it was read meanwhile"
    );
    bench.run(1);
    assert_eq!(bench.state(), RecorderState::Recording);
    bench.ask(RecorderRequest::Stop);
    assert_eq!(
        bench.ask(RecorderRequest::Restart).state,
        RecorderState::Recording
    );
    assert_eq!(bench.ask(RecorderRequest::Report).rows, 0);
}

/// The rows before it are lost, but not those after it.
#[test]
fn a_fault_while_a_host_reads_is_recorded() {
    let mut bench = Bench::new(SignalSet::default());
    bench.run(BOOT_TICKS);
    bench.ask(RecorderRequest::Stop);
    bench.sensors.emergency_stop = true;
    bench.run(400);
    let report = bench.ask(RecorderRequest::Restart);
    assert_eq!(report.state, RecorderState::Faulted);
    assert_eq!(
        (report.fault, report.rows),
        (stopped_in(BOOT_TICKS + 1), 400)
    );
}

#[test]
fn nothing_is_recorded_where_nothing_is_chosen() {
    let mut bench = Bench::new(SignalSet::NONE);
    bench.run(BOOT_TICKS);
    let report = bench.ask(RecorderRequest::Stop);
    assert_eq!((report.state, report.rows), (RecorderState::Off, 0));
    assert!(bench.read().is_empty());
}
