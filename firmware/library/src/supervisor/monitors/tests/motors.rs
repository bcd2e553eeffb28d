//! What currents, voltages and counters show.

use super::*;
use crate::control::CYCLE_S;

/// Asserts that current and voltage disagree; the filter of 5 ms comes there later than the time says.
fn disagrees(change: impl Fn(&Limits, &mut Seen)) {
    assert_disagrees(change, limits().disagreement_time_s, 2);
}

/// Asserts that current and voltage disagree as soon as the filter of 5 ms and the time for a motor that stands allow.
fn disagrees_soon(change: impl Fn(&Limits, &mut Seen)) {
    assert_disagrees(change, limits().still_time_s, 5);
}

fn assert_disagrees(change: impl Fn(&Limits, &mut Seen), time_s: f32, times_max: u16) {
    let mut seen = Seen::sound();
    change(&limits(), &mut seen);
    let (faults, after) = Watched::new().faults_after(&seen).unwrap();
    assert_eq!(faults, FaultSet::single(Fault::CurrentDisagrees));
    let time = cycles(time_s);
    assert!((time..times_max * time).contains(&after), "{after} cycles");
}

/// Whichever way the motor turns.
#[test]
fn a_current_is_too_much_or_not_what_the_tension_asks_for() {
    let settings = Settings::table_1().unwrap();
    let servo = settings.servos[0];
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

/// A voltage that drives so much, A, at a motor that draws nothing.
fn drives(a: f64, counts: i16) -> impl Fn(&Limits, &mut Seen) {
    move |_, s| {
        let volt = a * f64::from(Settings::table_1().unwrap().servos[0].resistance_ohm);
        (s.view.voltage_v, s.view.mean_voltage_v, s.view.driving_v) = (volt, volt, volt);
        s.counts_a_cycle = counts;
    }
}

/// A motor at a voltage draws at least what that drives less twice its friction.
#[test]
fn a_current_that_is_missing_is_a_fault() {
    let friction_a = 2.0 * f64::from(Settings::table_1().unwrap().servos[0].friction_a);
    for sign in [1.0, -1.0] {
        let forward = sign as i16;
        for counts in [0, forward] {
            is_no_fault("friction", drives(sign * (friction_a - 0.001), counts));
        }
        disagrees(drives(sign * (friction_a + 0.05), forward));
    }
}

/// What it draws may be 1.3 times less than what its voltage drives by the settings, for it may be warm.
#[test]
fn a_warm_winding_draws_less() {
    let servo = Settings::table_1().unwrap().servos[0];
    let friction_a = 2.0 * f64::from(servo.friction_a);
    let draws = |drawn_a: f64, lacking_a: f64| {
        move |limits: &Limits, seen: &mut Seen| {
            drives(1.3 * drawn_a + lacking_a, 1)(limits, seen);
            seen.measured.currents_a[AXIS] = drawn_a;
        }
    };
    is_no_fault("warm", draws(1.0, friction_a - 0.001));
    disagrees(draws(1.0, friction_a + 0.05));
}

/// What it lacks shows that it turns: then it has to be counted. What it lacks by far shows that it is not connected.
#[test]
fn a_motor_that_turns_uncounted_or_is_not_driven_at_all_is_found_soon() {
    let servo = Settings::table_1().unwrap().servos[0];
    let friction_a = 2.0 * f64::from(servo.friction_a);
    let open_a = friction_a + 0.25 * f64::from(servo.current_a);
    for sign in [1.0, -1.0] {
        let forward = sign as i16;
        disagrees_soon(drives(sign * (friction_a + 0.05), 0));
        disagrees(drives(sign * (open_a - 0.05), forward));
        disagrees_soon(drives(sign * (open_a + 0.1), forward));
        // While the tendons are paid out it is switched off as soon as it is driven hard.
        disagrees(|limits, s| {
            drives(sign * (open_a + 0.05), 0)(limits, s);
            s.led = false;
        });
    }
}

/// A counter whose encoder has lost one of its two tracks goes to and fro by a count: its motor turns, and draws too little for one that stands.
#[test]
fn a_motor_whose_counter_goes_to_and_fro_is_found() {
    let friction_a = 2.0 * f64::from(Settings::table_1().unwrap().servos[0].friction_a);
    let most = 2 * cycles(limits().disagreement_time_s);
    for sign in [1.0, -1.0] {
        for count in [1, -1] {
            let mut watched = Watched::new();
            let found = (1..=most).find_map(|cycle| {
                let mut seen = Seen::sound();
                let to_and_fro = if cycle % 2 == 0 { count } else { -count };
                drives(sign * (friction_a + 0.05), to_and_fro)(&watched.limits(), &mut seen);
                let faults = watched.cycle(&seen);
                faults.any().then_some(faults)
            });
            assert_eq!(found, Some(FaultSet::single(Fault::CurrentDisagrees)));
        }
    }
}

/// What the speed induces drives no current, and is known to a tenth.
#[test]
fn the_voltage_that_a_speed_induces_needs_no_current() {
    let servo = Settings::table_1().unwrap().servos[0];
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
                s.counts_a_cycle = sign as i16;
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
    let servo = Settings::table_1().unwrap().servos[0];
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
        let uncounted = |led: bool| {
            move |limits: &Limits, s: &mut Seen| {
                drives(sign * (hard_v + 0.01), 0)(limits, s);
                s.measured.currents_a[AXIS] = 0.0;
                s.led = led;
            }
        };
        disagrees_soon(uncounted(true));
        is_fault(Fault::EncoderStill, still, uncounted(false));
        let reversed = cycles(limits().reversed_time_s);
        let back = drives(sign * (hard_v + 0.01), -forward);
        is_fault(Fault::EncoderReversed, reversed, back);
    }
}

/// The servo brakes a motor with its highest voltage for less than reversed_time_s. One brake after another is none that lasts.
#[test]
fn a_motor_that_is_braked_both_ways_in_turn_does_not_turn_the_wrong_way() {
    let mut watched = Watched::new();
    let limits = watched.limits();
    let hard_v = f64::from(limits.driven_part)
        * f64::from(
            watched.settings.servos[0].current_a * watched.settings.servos[0].resistance_ohm,
        );
    for sign in [1.0, -1.0, 1.0, -1.0] {
        let mut seen = Seen::sound();
        seen.view.voltage_v = sign * (hard_v + 0.01);
        seen.counts_a_cycle = -sign as i16;
        for _ in 0..cycles(limits.reversed_time_s) - 1 {
            assert!(!watched.cycle(&seen).has(Fault::EncoderReversed));
        }
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
        // Where it should be farther in, it goes away as it pays out.
        let away = if sign > 0.0 { 0.9 } else { 0.75 };
        is_no_fault("going away, near", off(away - 0.01, -0.001));
        is_fault(Fault::Following, 1, off(1.01, 0.0));
        is_fault(Fault::RunsAway, 1, off(away + 0.01, -0.001));
        is_no_fault("not led", |l, s| {
            off(1.01, 0.0)(l, s);
            s.led = false;
        });
        is_no_fault("off", |l, s| {
            off(away + 0.01, -0.001)(l, s);
            s.driven = false;
        });
    }
}

/// Nine tenths of what the fastest motor goes in a tick, beside what goes on at its speed.
#[test]
fn a_counter_that_goes_too_far_has_jumped() {
    let settings = Settings::table_1().unwrap();
    let m_per_count = f64::from(settings.axes[AXIS].m_per_count.abs());
    let tick_m = f64::from(settings.servos[0].speed_m_per_s) / 8000.0;
    let counts = |speed: f64, more: f64| {
        let step_m = speed.abs() * f64::from(CYCLE_S) + more * 0.9 * tick_m;
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
        self.monitors
            .watch_motor(AXIS, &seen.input(&sensors), &seen.view);
        self.monitors.axis_faults()
    }
}

/// Whether current and tension disagree within half a second: the voltage is one and another by turns, and the motor draws
/// `part` of what the driver's pulses drive.
fn turning_about_disagrees(voltages_v: [f64; 2], part: f64) -> bool {
    let mut watched = Watched::new();
    let mut seen = Seen::sound();
    let resistance_ohm = f64::from(watched.settings.servos[0].resistance_ohm);
    let mut found = FaultSet::NONE;
    for [before_v, voltage_v] in [voltages_v, [voltages_v[1], voltages_v[0]]].repeat(500) {
        let missed = if before_v * voltage_v < 0.0 { 1.0 } else { 0.0 };
        let given_v = voltage_v * (1.0 - missed / f64::from(CYCLE_TICKS));
        seen.measured.currents_a[AXIS] = part * given_v / resistance_ohm;
        let view = &mut seen.view;
        (view.voltage_v, view.mean_voltage_v, view.driving_v) = (voltage_v, voltage_v, voltage_v);
        seen.counts_a_cycle = 1;
        found = found.union(watched.cycle(&seen));
    }
    found.has(Fault::CurrentDisagrees)
}

/// A driver gives no pulse in the tick in which it turns about, which a motor at low tension does in every other cycle.
#[test]
fn a_motor_that_turns_about_all_the_time_draws_what_its_pulses_drive() {
    assert!(!turning_about_disagrees([0.5, -6.6], 1.0));
    assert!(!turning_about_disagrees([2.0, 2.0], 1.0));
    assert!(turning_about_disagrees([2.0, 2.0], 0.0), "an open wire");
    assert!(turning_about_disagrees([0.5, -6.6], 0.0), "an open wire");
}

/// From an output that is silent nothing is concluded but what it reads all the same.
#[test]
fn an_output_that_is_silent_lacks_nothing() {
    let silent = |drawn_a: f64| {
        move |limits: &Limits, seen: &mut Seen| {
            drives(0.3, 1)(limits, seen);
            seen.measured.currents_a[AXIS] = drawn_a;
            seen.silent = true;
        }
    };
    is_no_fault("silent", silent(0.0));
    is_fault(
        Fault::OverCurrent,
        4,
        silent(f64::from(limits().current_a) + 0.01),
    );
    disagrees(|limits, seen| {
        silent(0.0)(limits, seen);
        seen.silent = false;
    });
}
