//! Each fault of sensors and axes: what is just allowed raises none, a little more raises it alone, after its time and no sooner.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{MonitorInput, Monitors};
use crate::control::{AxisView, CYCLE_S, CYCLE_TICKS, Measured, ticks};
use crate::sensors::{CODE_MAX, Sensors};
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
    driven: bool,
    led: bool,
    tensioned: bool,
    trusted: bool,
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
            driven: true,
            led: true,
            tensioned: true,
            trusted: true,
            residual_m: 0.0,
        }
    }
}

struct Watched {
    settings: Settings,
    monitors: Monitors<f64>,
    cycle: u16,
}

impl Watched {
    fn new() -> Self {
        let settings = Settings::for_table_1().unwrap();
        let mut watched = Self {
            monitors: Monitors::new(&settings),
            settings,
            cycle: 0,
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
        let counts = i32::from(self.cycle) * i32::from(seen.counts_a_cycle);
        sensors.encoder_counts[AXIS] = counts.rem_euclid(1 << 16) as u16;
        for (i, code) in sensors.cell_codes.iter_mut().enumerate() {
            let changes = seen.lives || i != AXIS;
            *code ^= u16::from(changes && self.cycle.is_multiple_of(2));
        }
        let input = MonitorInput {
            sensors: &sensors,
            measured: &seen.measured,
            driven: seen.driven,
            led: seen.led,
            tensioned: seen.tensioned,
            residual_m: Some(seen.residual_m),
            cells_trusted: seen.trusted,
        };
        for axis in 0..3 {
            self.monitors.watch_cell(axis, &input);
            let view = if axis == AXIS {
                seen.view
            } else {
                Seen::sound().view
            };
            self.monitors.watch_motor(axis, &input, &view);
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
    Settings::for_table_1().unwrap().limits
}

#[test]
fn a_cell_is_saturated_stale_or_stuck() {
    for (allowed, code) in [(64, 62), (CODE_MAX - 66, CODE_MAX - 62)] {
        is_no_fault("a code in range", |_, s| {
            s.sensors.cell_codes[AXIS] = allowed
        });
        is_fault(Fault::CellSaturated, 1, |_, s| {
            s.sensors.cell_codes[AXIS] = code;
        });
    }
    // Whether the leg is driven or not: a cell that is not there is known before it is armed.
    for driven in [true, false] {
        let unfresh = |s: &mut Seen| {
            (s.driven, s.sensors.cell_fresh[AXIS]) = (driven, false);
        };
        is_fault(Fault::CellStale, cycles(limits().stale_time_s), |_, s| {
            unfresh(s);
        });
        is_fault(Fault::CellStale, cycles(limits().stale_time_s), |_, s| {
            unfresh(s);
            s.lives = false;
        });
        is_fault(Fault::CellStuck, cycles(limits().stuck_time_s), |_, s| {
            (s.driven, s.lives) = (driven, false);
        });
    }
}

#[test]
fn a_tension_is_slack_or_too_high() {
    let slack = |n: f32| {
        move |limits: &Limits, s: &mut Seen| {
            s.measured.tensions_n[AXIS] = f64::from(limits.slack_n + n);
        }
    };
    // The way there is a jump, unless the drivers are off.
    is_no_fault("tension enough", |l, s| {
        slack(0.01)(l, s);
        s.driven = false;
    });
    is_fault(Fault::Slack, cycles(limits().slack_time_s), |l, s| {
        slack(-0.01)(l, s);
        s.driven = false;
    });
    is_no_fault("may be slack", |l, s| {
        slack(-0.01)(l, s);
        s.driven = false;
        s.tensioned = false;
    });
    is_no_fault("the drivers are off", |_, s| {
        (s.driven, s.measured.tensions_n[AXIS]) = (false, 1e3);
    });
}

/// A tension that has come there slowly.
fn too_much(more_n: f64, change: impl Fn(&mut Seen)) -> Option<(FaultSet, u16)> {
    let mut watched = Watched::new();
    let (f_max_n, limits) = (watched.settings.f_max_n, watched.limits());
    let mut seen = Seen::sound();
    let highest_n = f64::from(f_max_n) * (1.0 + f64::from(limits.over_tension_part));
    while seen.measured.tensions_n[AXIS] < highest_n - 5.0 {
        seen.measured.tensions_n[AXIS] += 4.0;
        assert_eq!(watched.cycle(&seen), FaultSet::NONE);
    }
    seen.measured.tensions_n[AXIS] = highest_n + more_n;
    change(&mut seen);
    watched.faults_after(&seen)
}

/// By a cell that the others contradict nothing is called too much tension: what it shows is a residual while the motors are
/// led by it.
#[test]
fn too_much_tension_is_that_of_a_trusted_cell() {
    let after = |fault| Some((FaultSet::single(fault), 4));
    assert_eq!(too_much(-0.01, |_| ()), None);
    assert_eq!(too_much(0.01, |_| ()), after(Fault::OverTension));
    assert_eq!(too_much(0.01, |s| s.driven = false), None);
    let residual = too_much(0.01, |s| s.trusted = false);
    assert_eq!(residual, after(Fault::Residual));
    let not_led = too_much(0.01, |s| (s.trusted, s.led) = (false, false));
    assert_eq!(not_led, None);
}

/// A change is counted over a millisecond: two cycles.
#[test]
fn a_tension_that_jumps_up_or_down_is_a_fault() {
    let jump_n = f64::from(limits().jump_n);
    for sign in [1.0, -1.0] {
        let to =
            |change_n: f64| move |_: &Limits, s: &mut Seen| s.measured.tensions_n[AXIS] += change_n;
        is_no_fault("a change", to(sign * (jump_n - 0.01)));
        is_fault(Fault::TensionJump, 1, to(sign * (jump_n + 0.01)));
    }
    let mut watched = Watched::new();
    let mut seen = Seen::sound();
    seen.measured.tensions_n[AXIS] += 0.6 * jump_n;
    assert_eq!(watched.cycle(&seen), FaultSet::NONE);
    seen.measured.tensions_n[AXIS] += 0.6 * jump_n;
    let jump = FaultSet::single(Fault::TensionJump);
    assert_eq!(watched.cycle(&seen), jump);
    assert_eq!(watched.cycle(&seen), FaultSet::NONE);
}

/// Asserts that current and voltage disagree; the filter of 5 ms comes there later than the time says.
fn disagrees(change: impl Fn(&Limits, &mut Seen)) {
    let mut seen = Seen::sound();
    change(&limits(), &mut seen);
    let (faults, after) = Watched::new().faults_after(&seen).unwrap();
    assert_eq!(faults, FaultSet::single(Fault::CurrentDisagrees));
    let time = cycles(limits().disagreement_time_s);
    assert!((time..2 * time).contains(&after), "{after} cycles");
}

/// Whichever way the motor turns.
#[test]
fn a_current_is_too_much_or_not_what_the_tension_asks_for() {
    let settings = Settings::for_table_1().unwrap();
    let servo = settings.servo;
    for sign in [1.0, -1.0] {
        let flows = |a: f64| move |_: &Limits, s: &mut Seen| s.measured.currents_a[AXIS] = sign * a;
        let explained =
            f64::from(limits().disagreement_a + servo.friction_a + servo.pull_a_per_n * 70.0);
        is_no_fault("explained", flows(explained - 0.01));
        disagrees(flows(explained + 0.1));
        let greatest = f64::from(limits().current_a);
        is_fault(Fault::OverCurrent, 4, flows(greatest + 0.01));
        is_no_fault("off", |l, s| {
            flows(2.0 * greatest)(l, s);
            s.driven = false;
        });
    }
}

/// A motor at a voltage draws at least what that drives less twice its friction.
#[test]
fn a_current_that_is_missing_is_a_fault() {
    let servo = Settings::for_table_1().unwrap().servo;
    let (ohm, friction) = (f64::from(servo.resistance_ohm), f64::from(servo.friction_a));
    for sign in [1.0, -1.0] {
        let drives = |a: f64| {
            move |_: &Limits, s: &mut Seen| {
                let volt = sign * a * ohm;
                (s.view.voltage_v, s.view.mean_voltage_v, s.view.driving_v) = (volt, volt, volt);
            }
        };
        is_no_fault("friction", drives(2.0 * friction - 0.001));
        disagrees(drives(2.0 * friction + 0.05));
    }
}

/// What the speed induces drives no current, and is known to a tenth.
#[test]
fn the_voltage_that_a_speed_induces_needs_no_current() {
    let servo = Settings::for_table_1().unwrap().servo;
    let (ohm, friction) = (f64::from(servo.resistance_ohm), f64::from(servo.friction_a));
    let allowed_a = |induced_v: f64| 2.0 * friction + 0.1 * induced_v / ohm;
    for sign in [1.0, -1.0] {
        let turns = |induced_v: f64, driving_a: f64| {
            move |_: &Limits, s: &mut Seen| {
                let driving_v = driving_a * ohm;
                (s.view.voltage_v, s.view.mean_voltage_v) = (
                    sign * (induced_v + driving_v),
                    sign * (induced_v + driving_v),
                );
                s.view.driving_v = sign * driving_v;
            }
        };
        for induced_v in [3.0, 10.0] {
            let most_a = allowed_a(induced_v);
            is_no_fault("induced", turns(induced_v, 0.0));
            is_no_fault("induced, and friction", turns(induced_v, most_a - 0.001));
            disagrees(turns(induced_v, most_a + 0.05));
        }
    }
}

#[test]
fn a_motor_that_is_driven_turns_and_the_way_it_is_driven() {
    let servo = Settings::for_table_1().unwrap().servo;
    let hard_v = f64::from(limits().driven_part * servo.current_a * servo.resistance_ohm);
    let current_a = f64::from(limits().driven_part * servo.current_a);
    let drives = |volt: f64, counts: i16| {
        move |_: &Limits, s: &mut Seen| {
            (s.view.voltage_v, s.view.mean_voltage_v, s.view.driving_v) = (volt, volt, volt);
            s.measured.currents_a[AXIS] = volt.signum() * current_a;
            s.counts_a_cycle = counts;
        }
    };
    for sign in [1.0, -1.0] {
        let forward = sign as i16;
        is_no_fault("not hard", drives(sign * (hard_v - 0.01), 0));
        is_no_fault("not hard", drives(sign * (hard_v - 0.01), -forward));
        is_no_fault("turns", drives(sign * (hard_v + 0.01), forward));
        let still = cycles(limits().still_time_s);
        is_fault(
            Fault::EncoderStill,
            still,
            drives(sign * (hard_v + 0.01), 0),
        );
        let reversed = cycles(limits().reversed_time_s);
        let back = drives(sign * (hard_v + 0.01), -forward);
        is_fault(Fault::EncoderReversed, reversed, back);
    }
}

#[test]
fn a_motor_that_is_not_where_it_is_led_is_a_fault() {
    for sign in [1.0, -1.0] {
        let off = |part: f64, speed: f64| {
            move |limits: &Limits, s: &mut Seen| {
                s.view.following_m = sign * part * f64::from(limits.following_m);
                s.view.speed_m_per_s = sign * speed;
            }
        };
        is_no_fault("behind", off(0.99, 0.0));
        is_no_fault("behind, and coming", off(0.99, 0.001));
        is_no_fault("going away, near", off(0.59, -0.001));
        is_fault(Fault::Following, 1, off(1.01, 0.0));
        is_fault(Fault::RunsAway, 1, off(0.61, -0.001));
        is_no_fault("not led", |l, s| {
            off(1.01, 0.0)(l, s);
            s.led = false;
        });
        is_no_fault("off", |l, s| {
            off(0.61, -0.001)(l, s);
            s.driven = false;
        });
    }
}

/// A third more than the fastest motor goes in a tick, beside what goes on at its speed.
#[test]
fn a_counter_that_goes_too_far_has_jumped() {
    let settings = Settings::for_table_1().unwrap();
    let m_per_count = f64::from(settings.axes[AXIS].m_per_count.abs());
    let tick_m = f64::from(settings.servo.speed_m_per_s) / 8000.0;
    let counts = |speed: f64, more: f64| {
        let step_m = speed.abs() * f64::from(CYCLE_S) + more * 1.33 * tick_m;
        (speed.signum() * step_m / m_per_count).trunc() as i16
    };
    for speed in [0.01, -0.01] {
        let jumped = |more: f64| {
            let mut watched = Watched::new();
            let mut seen = Seen::sound();
            seen.view.speed_m_per_s = speed;
            let step = counts(speed, more);
            seen.sensors.encoder_counts[AXIS] = 0;
            // Once: from where the counter stands.
            seen.counts_a_cycle = 0;
            watched.cycle(&seen);
            watched.jump(&seen, step)
        };
        assert_eq!(jumped(0.9), FaultSet::NONE);
        assert_eq!(jumped(1.1), FaultSet::single(Fault::EncoderJump));
    }
}

impl Watched {
    /// The motor's turn after a step of its counter.
    fn jump(&mut self, seen: &Seen, step: i16) -> FaultSet {
        let mut sensors = seen.sensors;
        sensors.encoder_counts[AXIS] = step.cast_unsigned();
        let input = MonitorInput {
            sensors: &sensors,
            measured: &seen.measured,
            driven: seen.driven,
            led: seen.led,
            tensioned: seen.tensioned,
            residual_m: None,
            cells_trusted: seen.trusted,
        };
        self.monitors.watch_motor(AXIS, &input, &seen.view);
        self.monitors.axis_faults()
    }
}

#[test]
fn what_all_axes_share_is_watched_in_every_tick() {
    is_no_fault("low", |l, s| {
        s.measured.supply_v = f64::from(l.supply_min_v)
    });
    is_no_fault("high", |l, s| {
        s.measured.supply_v = f64::from(l.supply_max_v)
    });
    is_fault(Fault::SupplyLow, 1, |l, s| {
        s.measured.supply_v = f64::from(l.supply_min_v) - 0.01;
    });
    is_no_fault("off", |_, s| (s.driven, s.measured.supply_v) = (false, 0.0));
    for driven in [true, false] {
        is_fault(Fault::SupplyHigh, 1, |l, s| {
            s.driven = driven;
            s.measured.supply_v = f64::from(l.supply_max_v) + 0.01;
        });
        is_fault(Fault::OverTemperature, 1, |l, s| {
            s.driven = driven;
            s.measured.temperature_c = f64::from(l.temperature_c) + 0.01;
        });
        is_fault(Fault::DriverFault, 1, |_, s| {
            (s.driven, s.sensors.driver_fault[AXIS]) = (driven, true);
        });
        is_fault(Fault::LateTick, 1, |_, s| {
            (s.driven, s.sensors.late) = (driven, true);
        });
        is_fault(Fault::EmergencyStop, 1, |_, s| {
            (s.driven, s.sensors.emergency_stop) = (driven, true);
        });
        is_fault(Fault::SettingsCorrupt, 1, |_, s| {
            (s.driven, s.sensors.settings_corrupt) = (driven, true);
        });
    }
    is_no_fault("warm", |l, s| {
        s.measured.temperature_c = f64::from(l.temperature_c);
    });
    is_no_fault("left over", |l, s| s.residual_m = f64::from(l.residual_m));
    // Its filter counts ticks.
    let time = (ticks(limits().residual_time_s) / u32::from(CYCLE_TICKS)) as u16;
    for residual_m in [f64::from(limits().residual_m) * 1.01, f64::NAN] {
        is_fault(Fault::Residual, time, |_, s| s.residual_m = residual_m);
    }
}
