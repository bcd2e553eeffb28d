//! Each fault of sensors and axes: what is just allowed raises none, a little more raises it alone, after its time and no sooner.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod board;
mod cells;
mod motors;

use super::{Excess, MonitorInput, Monitors};
use crate::control::{AxisView, CYCLE_TICKS, Measured, ticks};
use crate::sensors::Sensors;
use crate::settings::{Limits, Settings};
use crate::supervisor::{Fault, FaultSet};

/// The axis that something is done to.
const AXIS: usize = 1;

/// All that the monitors look at in a cycle.
#[derive(Clone, Copy)]
struct Seen {
    sensors: Sensors,
    measured: Measured<f64>,
    view: AxisView<f64>,
    /// Counts that the encoder goes on by in every cycle.
    counts_a_cycle: i16,
    /// Whether the cell's code changes from cycle to cycle.
    lives: bool,
    /// Whether the current output of the axis is silent.
    silent: bool,
    driven: bool,
    led: bool,
    tensioned: bool,
    trusted: bool,
    /// What too much tension is of a leg whose cells are trusted.
    excess: Excess,
    contradicted: bool,
    residual_m: f64,
}

impl Seen {
    /// A leg that stands, with nothing wrong.
    fn sound() -> Self {
        Self {
            sensors: Sensors {
                cell_codes: [20_000; 3],
                cell_fresh: [true; 3],
                ..Sensors::default()
            },
            measured: Measured {
                pulled_m: [0.0; 3],
                tensions_n: [70.0; 3],
                steady_tensions_n: [70.0; 3],
                currents_a: [0.0; 3],
                supply_v: 24.0,
                temperature_c: 30.0,
            },
            view: AxisView {
                speed_m_per_s: 0.0,
                following_m: 0.0,
                driving_v: 0.0,
                voltage_v: 0.0,
                mean_voltage_v: 0.0,
            },
            counts_a_cycle: 0,
            lives: true,
            silent: false,
            driven: true,
            led: true,
            tensioned: true,
            trusted: true,
            excess: Excess::Trusted,
            contradicted: false,
            residual_m: 0.0,
        }
    }

    fn input<'a>(&'a self, sensors: &'a Sensors) -> MonitorInput<'a, f64> {
        MonitorInput {
            sensors,
            measured: &self.measured,
            driven: self.driven,
            led: self.led,
            tensioned: self.tensioned,
            residual_m: Some(self.residual_m),
            cells_trusted: self.trusted,
        }
    }
}

struct Watched {
    settings: Settings,
    monitors: Monitors<f64>,
    cycle: u16,
    count: i16,
}

impl Watched {
    fn new() -> Self {
        let settings = Settings::table_1().unwrap();
        let mut watched = Self {
            monitors: Monitors::new(&settings),
            settings,
            cycle: 0,
            count: 0,
        };
        for _ in 0..11 {
            assert_eq!(watched.cycle(&Seen::sound()), FaultSet::NONE);
        }
        watched
    }

    fn limits(&self) -> Limits {
        self.settings.limits
    }

    /// One cycle: every axis has its turn.
    fn cycle(&mut self, seen: &Seen) -> FaultSet {
        self.cycle += 1;
        let mut sensors = seen.sensors;
        self.count = self.count.wrapping_add(seen.counts_a_cycle);
        sensors.encoder_counts[AXIS] = self.count.cast_unsigned();
        for (i, code) in sensors.cell_codes.iter_mut().enumerate() {
            let changes = seen.lives || i != AXIS;
            *code ^= u16::from(changes && self.cycle.is_multiple_of(2));
        }
        let input = seen.input(&sensors);
        let excess = match (seen.trusted, seen.led) {
            (true, _) => seen.excess,
            (false, true) => Excess::Doubted,
            (false, false) => Excess::Open,
        };
        self.monitors.watch_cells(&input, seen.contradicted, excess);
        for axis in 0..3 {
            let view = if axis == AXIS {
                seen.view
            } else {
                Seen::sound().view
            };
            if axis == AXIS && seen.silent {
                self.monitors.watch_silent_motor(axis, &input, &view);
            } else {
                self.monitors.watch_motor(axis, &input, &view);
            }
        }
        let mut faults = FaultSet::NONE;
        for _ in 0..CYCLE_TICKS {
            faults = faults.union(self.monitors.watch(&input));
        }
        faults.union(self.monitors.axis_faults())
    }

    /// The first faults, and after how many cycles they come; none within 500.
    fn faults_after(mut self, seen: &Seen) -> Option<(FaultSet, u16)> {
        let begun = self.cycle;
        (0..500).find_map(|_| {
            let faults = self.cycle(seen);
            faults.any().then_some((faults, self.cycle - begun))
        })
    }
}

fn cycles(time_s: f32) -> u16 {
    ticks(time_s).div_ceil(CYCLE_TICKS.into()) as u16
}

fn is_no_fault(why: &str, change: impl Fn(&Limits, &mut Seen)) {
    let watched = Watched::new();
    let mut seen = Seen::sound();
    change(&watched.limits(), &mut seen);
    let found = watched.faults_after(&seen);
    assert_eq!(found, None, "{why}");
}

/// Asserts that it comes, alone, in the last of so many cycles.
fn is_fault(fault: Fault, cycles: u16, change: impl Fn(&Limits, &mut Seen)) {
    let watched = Watched::new();
    let mut seen = Seen::sound();
    change(&watched.limits(), &mut seen);
    let found = watched.faults_after(&seen);
    assert_eq!(found, Some((FaultSet::single(fault), cycles)), "{fault:?}");
}

fn limits() -> Limits {
    Settings::table_1().unwrap().limits
}
