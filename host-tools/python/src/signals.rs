//! What can be read of a simulated leg and recorded: the signals of reports and of simulated legs that have numbers.

use leg_firmware::drive::Drive;
use leg_host::signals::{
    LegConstants, REPORT_SIGNALS, Report, SIMULATED_SIGNALS, Signal, Simulated,
};
use leg_sim::hosted_leg::{Comparison, HostedLeg};

/// The time, which every recording has by itself.
const TIME: &str = "time_s";

/// The leg after a tick.
pub struct Snapshot {
    /// What it reports.
    pub report: Report,
    /// How it is.
    pub simulated: Simulated,
}

impl Snapshot {
    /// Of a leg; none before its first tick. `on_path` is whether a path is followed, and the leg is on it.
    pub fn new(
        leg: &HostedLeg,
        constants: &LegConstants,
        motors: &Drive<f32>,
        on_path: bool,
    ) -> Option<Self> {
        let comparison = leg.comparison();
        let path_error_mm = on_path.then(|| comparison.commanded_error_mm());
        Some(Self {
            report: Report::new(leg.telemetry()?, constants).compared(&comparison),
            simulated: Simulated {
                truth: *leg.truth(),
                motors: *motors,
                comparison: Comparison {
                    path_error_mm,
                    ..comparison
                },
            },
        })
    }
}

/// A signal that has numbers.
#[derive(Clone, Copy)]
pub enum NumericSignal {
    /// Of what the leg reports.
    Reported(&'static Signal<Report>),
    /// Of the simulated leg as it is.
    Simulated(&'static Signal<Simulated>),
}

impl NumericSignal {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        let reported = REPORT_SIGNALS.iter().map(Self::Reported);
        let all = reported.chain(SIMULATED_SIGNALS.iter().map(Self::Simulated));
        all.filter(|signal| signal.has_numbers() && signal.name() != TIME)
    }

    /// That of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|signal| signal.name() == name)
    }

    /// Its name, which ends with its unit.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reported(signal) => signal.name,
            Self::Simulated(signal) => signal.name,
        }
    }

    /// What it is and means.
    pub fn meaning(self) -> String {
        let (origin, meaning) = match self {
            Self::Reported(signal) => (signal.origin, signal.meaning),
            Self::Simulated(signal) => (signal.origin, signal.meaning),
        };
        format!("{}: {meaning}", origin.words())
    }

    fn has_numbers(self) -> bool {
        self.width() > 0
    }

    /// How many numbers.
    pub fn width(self) -> usize {
        let width = match self {
            Self::Reported(signal) => signal.width(),
            Self::Simulated(signal) => signal.width(),
        };
        width.unwrap_or(0)
    }

    /// Writes its numbers.
    pub fn read(self, snapshot: &Snapshot, out: &mut Vec<f64>) {
        match self {
            Self::Reported(signal) => signal.numbers(&snapshot.report, out),
            Self::Simulated(signal) => signal.numbers(&snapshot.simulated, out),
        }
    }
}
