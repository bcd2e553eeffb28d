//! A leg that was recorded: what it was at any time of its recording.

use crate::charts::SignalSource;
use crate::files::FileKind;
use crate::history::History;
use crate::seen_leg::{SeenLeg, leg_axis};
use leg_base::failure::Failure;
use leg_firmware::supervisor::{FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_recording::{About, RecordedSignals, read_signals};
use leg_rig::rig_file::{RigFile, RigText};
use nalgebra::Vector3;

/// It.
pub struct RecordedLeg {
    /// The file.
    pub name: String,
    /// What it is of.
    pub about: About,
    /// Whether it came to its end.
    pub finished: bool,
    rig: RigFile,
    /// Whether a simulated leg was recorded, and what is true of it.
    is_true: bool,
    /// Its time, s, and what it reported, in the order of time; at least one.
    reports: Vec<(f64, Telemetry<f32>)>,
    /// Every signal that has numbers.
    pub history: History,
}

impl RecordedLeg {
    /// Opens a recording.
    ///
    /// # Errors
    /// What is none of a leg, with the place where that is known.
    pub fn open(name: &str, bytes: &[u8]) -> Result<Self, Failure> {
        if let Some(failure) = FileKind::Recording.too_large(name, bytes.len() as f64) {
            return Err(failure);
        }
        Self::new(name, read_signals(name, bytes)?)
    }

    /// That of the signals of a recording.
    ///
    /// # Errors
    /// Signals of a leg that is not known.
    pub fn new(name: &str, signals: RecordedSignals) -> Result<Self, Failure> {
        let reports = signals.rows.iter().map(|row| (row.time_s, row.telemetry));
        let reports = reports.collect();
        let rows = signals.rows.into_iter();
        let rows = rows.map(|row| (row.time_s, row.numbers));
        Ok(Self {
            name: name.into(),
            rig: rig(name, signals.rig)?,
            about: signals.about,
            finished: signals.finished,
            is_true: signals.simulated,
            history: History::recorded(signals.simulated, rows),
            reports,
        })
    }

    /// From when to when it goes, s.
    #[must_use]
    pub fn span_s(&self) -> [f64; 2] {
        let ends = [self.reports.first(), self.reports.last()];
        ends.map(|end| end.map_or(0.0, |(time_s, _)| *time_s))
    }

    /// Its signals, for charts, at a time, s.
    #[must_use]
    pub fn signals(&self, moment_s: f64) -> SignalSource<'_> {
        let [since_s, now_s] = self.span_s();
        SignalSource {
            history: &self.history,
            since_s,
            now_s,
            moment_s: Some(moment_s),
        }
    }

    /// What it had reported last at a time, s.
    #[must_use]
    pub fn telemetry(&self, at_s: f64) -> Option<&Telemetry<f32>> {
        let after = self.reports.partition_point(|(time_s, _)| *time_s <= at_s);
        let report = self.reports.get(after.saturating_sub(1))?;
        Some(&report.1)
    }

    /// What it might do then.
    #[must_use]
    pub fn state(&self, at_s: f64) -> State {
        self.telemetry(at_s)
            .map_or(State::Boot, |telemetry| telemetry.state)
    }

    /// What was wrong with it then.
    #[must_use]
    pub fn faults(&self, at_s: f64) -> FaultSet {
        self.telemetry(at_s)
            .map_or(FaultSet::NONE, |telemetry| telemetry.faults)
    }

    /// The numbers of a signal then; not a number where there is none.
    fn signal<const N: usize>(&self, name: &str, at_s: f64) -> [f64; N] {
        let column = self.history.named(name);
        let numbers = column.map_or(&[][..], |column| self.history.numbers_at(column, at_s));
        std::array::from_fn(|i| numbers.get(i).map_or(f64::NAN, |number| f64::from(*number)))
    }

    /// The settings with which it was recorded.
    #[must_use]
    pub const fn rig(&self) -> &RigFile {
        &self.rig
    }

    /// The leg as it is drawn: as it truly was, or as its sensors had it.
    #[must_use]
    pub fn seen(&self, at_s: f64) -> SeenLeg<'_> {
        let telemetry = self.telemetry(at_s).copied();
        let reported = |part: fn(&Telemetry<f32>) -> [f32; 2]| {
            telemetry.as_ref().map_or([0.0; 2], part).map(f64::from)
        };
        let measured =
            || telemetry.map_or([0.0; 3], |telemetry| telemetry.tensions_n.map(f64::from));
        let tensions_n = if self.is_true {
            self.signal("tensions_true_n", at_s)
        } else {
            measured()
        };
        let target = reported(|telemetry| telemetry.commanded);
        let mut seen = SeenLeg {
            rig: &self.rig,
            telemetry,
            is_true: self.is_true,
            is_heard: true,
            leg_axis: self.leg_axis(at_s, reported(|telemetry| telemetry.pose)),
            reference: leg_axis(reported(|telemetry| telemetry.target)),
            target,
            torsion_rad: 0.0,
            tensions_n,
            hung_kg: None,
            // Nobody says it: a tendon that was cut has no tension.
            cut: [false; 3],
            push: None,
            error_mm: 0.0,
        };
        if self.is_true {
            let [torsion_deg] = self.signal("torsion_true_deg", at_s);
            seen.torsion_rad = torsion_deg.to_radians();
            let [payload_kg] = self.signal("payload_true_kg", at_s);
            seen.hung_kg = Some(payload_kg);
            [seen.error_mm] = self.signal("tip_error_mm", at_s);
        } else {
            let off_m = seen.leg_axis * seen.tip_length_m() - seen.commanded_m();
            seen.error_mm = 1000.0 * off_m.norm();
        }
        seen
    }

    fn leg_axis(&self, at_s: f64, pose: [f64; 2]) -> Vector3<f64> {
        if !self.is_true {
            return leg_axis(pose);
        }
        Vector3::from(self.signal("tip_true_mm", at_s)).normalize()
    }
}

/// The settings with which it was recorded.
fn rig(name: &str, text: Option<String>) -> Result<RigFile, Failure> {
    let without = || {
        Failure::refused(
            format!("{name} does not say of which rig it is"),
            "record anew: earlier versions did not write it",
        )
    };
    let source = RigText {
        name: format!("the settings in {name}"),
        text: text.ok_or_else(without)?,
    };
    Ok(source.read()?.0)
}
