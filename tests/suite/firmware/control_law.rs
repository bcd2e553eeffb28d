//! A leg on sensors that a test makes up: how it homes, obeys and relaxes.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::control::CYCLE_TICKS;
use leg_firmware::leg::{CommandOutcome, Leg};
use leg_firmware::sensors::{CODE_MAX, Sensors, TICK_HZ};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::{Fault, State};
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;

const TICK_S: f64 = 1.0 / TICK_HZ as f64;

fn settings(zero: Option<[f64; 3]>) -> Settings {
    let rig = RigFile::load(None).unwrap();
    let mut settings = control_settings::settings(&rig, &rig.gains, zero);
    // The motors of the bench draw nothing.
    settings.limits.disagreement_time_s = 10.0;
    settings.limits.still_time_s = 10.0;
    settings
}

/// The leg, and what its sensors read.
pub(super) struct Bench {
    pub leg: Leg<f64>,
    settings: Settings,
    pub sensors: Sensors,
    tick: u16,
}

impl Bench {
    pub fn new(zero: Option<[f64; 3]>) -> Self {
        let settings = settings(zero);
        let board = settings.board;
        let code = |value: f32| value as u16;
        let sensors = Sensors {
            current_codes: [CODE_MAX / 2; 3],
            supply_code: code(24.0 / board.supply_v_per_code),
            temperature_code: code(
                (30.0 - board.temperature_at_zero_c) / board.temperature_c_per_code,
            ),
            cell_fresh: [true; 3],
            ..Sensors::default()
        };
        let mut bench = Self {
            leg: Leg::new(&settings).unwrap(),
            settings,
            sensors,
            tick: 0,
        };
        bench.tensions([0.0; 3]);
        bench.run(20);
        assert_eq!(bench.leg.state(), State::Disarmed);
        bench
    }

    fn tensions(&mut self, tensions_n: [f32; 3]) {
        for (i, tension_n) in tensions_n.into_iter().enumerate() {
            self.tension(i, tension_n);
        }
    }

    fn tension(&mut self, i: usize, tension_n: f32) {
        let axis = &self.settings.axes[i];
        let code = tension_n / axis.cell_n_per_code + axis.cell_zero_code;
        self.sensors.cell_codes[i] = code as u16;
    }

    /// With a host that keeps alive.
    pub fn run(&mut self, ticks: u16) -> [f64; 3] {
        let mut duty = [0.0; 3];
        for _ in 0..ticks {
            if (self.tick + 1).is_multiple_of(800) {
                assert!(self.leg.command(0, Command::KeepAlive));
            }
            duty = self.run_silent(1);
        }
        duty
    }

    /// With a host that says nothing.
    fn run_silent(&mut self, ticks: u16) -> [f64; 3] {
        let mut duty = [0.0; 3];
        for _ in 0..ticks {
            self.tick += 1;
            if self.tick.is_multiple_of(CYCLE_TICKS.into()) {
                // A living cell is never quite still.
                for code in &mut self.sensors.cell_codes {
                    *code ^= 1;
                }
            }
            duty = self.leg.tick(&self.sensors).duty;
            self.turn();
        }
        duty
    }

    /// Motors that are at once where they are led.
    fn turn(&mut self) {
        let led_m = self.leg.telemetry().reference_m;
        for (i, led_m) in led_m.into_iter().enumerate() {
            let counts = led_m / f64::from(self.settings.axes[i].m_per_count);
            self.sensors.encoder_counts[i] = (counts.round() as i64).rem_euclid(1 << 16) as u16;
        }
    }

    pub fn obey(&mut self, command: Command) -> Result<(), CommandRefusal> {
        // Those of a host that keeps alive.
        while self.leg.outcome().is_some() {}
        assert!(self.leg.command(7, command));
        for _ in 0..2 * CYCLE_TICKS {
            self.run(1);
            if let Some(CommandOutcome { number: 7, result }) = self.leg.outcome() {
                return result;
            }
        }
        panic!("no outcome of {command:?}");
    }

    fn has(&self, fault: Fault) -> bool {
        self.leg.telemetry().faults.has(fault)
    }
}

/// As far as its travel and two steps of the release: a tendon may need all of it to become slack.
#[test]
fn homing_pays_out_as_far_as_its_settings_allow() {
    let mut bench = Bench::new(None);
    assert_eq!(bench.leg.telemetry().failed_tendon, 0);
    bench.tension(1, 100.0);
    bench.run(20);
    assert_eq!(bench.obey(Command::Home), Ok(()));
    let mut lowest_m = 0.0_f64;
    while bench.leg.state() == State::Homing {
        let telemetry = bench.leg.telemetry();
        // It stays taut: it loses 4 N with each step.
        bench.tension(1, 100.0 + 1e3 * telemetry.pulled_m[1] as f32);
        let before_m = telemetry.reference_m[1];
        let duty = bench.run(1);
        let led_m = bench.leg.telemetry().reference_m[1] - before_m;
        if led_m < -1e-7 {
            assert!(duty[1] < 0.0, "{duty:?} at {before_m} m");
        }
        lowest_m = lowest_m.min(before_m);
    }
    let telemetry = bench.leg.telemetry();
    assert!(bench.has(Fault::HomingFailed), "{telemetry:?}");
    assert_eq!(telemetry.failed_tendon, 2);
    let homing = bench.settings.homing;
    assert!(-lowest_m >= f64::from(homing.travel_m), "{lowest_m} m");
}

/// Whatever its load cell says, and whatever its motor draws with a slack tendon: half more than friction and the highest tension of
/// homing ask for is too much.
#[test]
fn homing_gives_up_above_its_current() {
    for sign in [1.0, -1.0] {
        for (part, fails) in [(0.9, false), (1.1, true)] {
            let mut bench = Bench::new(None);
            assert_eq!(bench.obey(Command::Home), Ok(()));
            // Let out, tared, and the first tendon reeled in for 0.1 s.
            bench.run(6000);
            let (servo, homing) = (bench.settings.servos[0], bench.settings.homing);
            let most_a = 1.5 * servo.friction_a + servo.pull_a_per_n * homing.f_max_n;
            let codes = sign * part * most_a / bench.settings.axes[0].current_a_per_code;
            bench.sensors.current_codes[0] = (f32::from(CODE_MAX / 2) + codes) as u16;
            bench.run(400);
            assert_eq!(bench.has(Fault::HomingFailed), fails, "{}", sign * part);
        }
    }
}

#[test]
fn homing_gives_way_above_its_ceiling_and_gives_up_at_twice_that() {
    for tendon in 0..3 {
        let mut bench = Bench::new(None);
        assert_eq!(bench.obey(Command::Home), Ok(()));
        // Let out, tared, and the first tendon half taken up.
        bench.run(7000);
        let f_max_n = bench.settings.homing.f_max_n;
        let pulling =
            |tension_n| std::array::from_fn(|i| if i == tendon { tension_n } else { 0.0 });
        bench.tensions(pulling(f_max_n - 5.0));
        let below = bench.run(1);
        bench.tensions(pulling(f_max_n + 5.0));
        let above = bench.run(1);
        let telemetry = bench.leg.telemetry();
        assert_eq!(telemetry.state, State::Homing, "{telemetry:?}");
        let [below, above] = [below, above].map(|duty| duty[tendon]);
        assert!(below > -1e-9 && above < -0.1, "{tendon}: {below} {above}");
        bench.tensions(pulling(2.0 * f_max_n + 1.0));
        bench.run(1);
        assert!(bench.has(Fault::HomingFailed), "{tendon}");
        assert_eq!(bench.leg.state(), State::RampingDown);
    }
}

/// A host that falls silent is missed while the leg is homed as while it follows.
#[test]
fn silence_holds_a_leg_whatever_it_is_asked_for() {
    for (zero, command, state) in [
        (None, Command::Home, State::Homing),
        (Some([0.2; 3]), Command::Arm, State::Active),
    ] {
        let mut bench = Bench::new(zero);
        assert_eq!(bench.obey(command), Ok(()));
        let silence = bench.settings.limits.command_time_s * f32::from(TICK_HZ);
        bench.run_silent(silence as u16 - 2 * u16::from(CYCLE_TICKS));
        assert!(!bench.has(Fault::CommandTimeout));
        assert_eq!(bench.leg.state(), state);
        bench.run_silent(3 * u16::from(CYCLE_TICKS));
        assert!(bench.has(Fault::CommandTimeout));
        assert_eq!(bench.leg.state(), State::Held);
    }
}

/// Where nothing is known of the pose, every tendon is paid out by the same way at the same speed, and no farther.
#[test]
fn a_leg_is_relaxed_by_the_travel_and_at_the_speed_of_its_settings() {
    let mut bench = Bench::new(Some([0.2; 3]));
    assert_eq!(bench.obey(Command::Arm), Ok(()));
    bench.run(400);
    let begun_m = bench.leg.telemetry().pulled_m;
    assert_eq!(bench.obey(Command::Disarm), Ok(()));
    let limits = bench.settings.limits;
    let (travel_m, speed) = (
        f64::from(limits.relax_travel_m),
        f64::from(limits.ramp_m_per_s),
    );
    let mut ticks = 0;
    while bench.leg.state() == State::RampingDown {
        let before_m = bench.leg.telemetry().reference_m;
        bench.run(1);
        ticks += 1;
        for (before, after) in before_m.into_iter().zip(bench.leg.telemetry().reference_m) {
            assert!(before - after <= 1.001 * speed * TICK_S, "{before} {after}");
        }
    }
    assert_eq!(bench.leg.state(), State::Disarmed);
    let time_s = f64::from(ticks) * TICK_S;
    assert!((time_s * speed / travel_m - 1.0).abs() < 0.02, "{time_s} s");
    for (before, after) in begun_m.into_iter().zip(bench.leg.telemetry().pulled_m) {
        // To within what counts as arrived.
        assert!((before - after - travel_m).abs() < 5e-5, "{before} {after}");
    }
}

/// Twice the time of its way, and half a second.
#[test]
fn a_motor_that_does_not_arrive_is_not_waited_for_any_longer() {
    let mut bench = Bench::new(Some([0.2; 3]));
    assert_eq!(bench.obey(Command::Arm), Ok(()));
    bench.run(400);
    let count = bench.sensors.encoder_counts[0];
    assert_eq!(bench.obey(Command::Disarm), Ok(()));
    let mut ticks: u16 = 0;
    while bench.leg.state() == State::RampingDown {
        // It creeps: 0.2 mm/s.
        bench.sensors.encoder_counts[0] = count.wrapping_sub(ticks / u16::from(CYCLE_TICKS));
        bench.run(1);
        ticks += 1;
    }
    let telemetry = bench.leg.telemetry();
    assert_eq!(telemetry.state, State::Disarmed, "{telemetry:?}");
    let limits = bench.settings.limits;
    let way_s = f64::from(limits.relax_travel_m / limits.ramp_m_per_s);
    let time_s = f64::from(ticks) * TICK_S;
    assert!((time_s - 2.0 * way_s - 0.5).abs() < 0.01, "{time_s} s");
}

#[test]
fn commands_that_mean_nothing_now_are_refused_by_name() {
    let mut bench = Bench::new(None);
    assert_eq!(bench.obey(Command::Arm), Err(CommandRefusal::NotHomed));
    let go = Command::Move { x: 0.1, y: 0.0 };
    let disarmed = Err(CommandRefusal::State(State::Disarmed));
    assert_eq!(bench.obey(go), disarmed);
    assert_eq!(bench.obey(Command::Hold), disarmed);
    assert_eq!(bench.obey(Command::Stop), Ok(()));

    let mut bench = Bench::new(Some([0.2; 3]));
    assert_eq!(bench.obey(Command::Arm), Ok(()));
    assert_eq!(bench.leg.state(), State::Active);
    let far = Command::Move { x: 0.9, y: 0.0 };
    assert_eq!(bench.obey(far), Err(CommandRefusal::OutOfReach));
    let lost = Command::Move {
        x: f32::NAN,
        y: 0.0,
    };
    assert_eq!(bench.obey(lost), Err(CommandRefusal::Number));
    for towards in [[f32::NAN, 0.0], [0.0, 0.0], [1.0, 1.0], [f32::MAX, 0.0]] {
        let stiffness = Command::Stiffness {
            demand_nm_per_rad: 100.0,
            towards: Some(towards),
        };
        assert_eq!(bench.obey(stiffness), Err(CommandRefusal::Number));
    }
    assert_eq!(
        bench.obey(Command::Pretension(f32::INFINITY)),
        Err(CommandRefusal::Number)
    );
    assert_eq!(bench.obey(Command::Stop), Ok(()));
    assert_eq!(bench.leg.state(), State::Held);
    // It brakes first.
    bench.run(1300);
    assert_eq!(
        bench.obey(Command::Arm),
        Err(CommandRefusal::State(State::Held))
    );
    bench.sensors.emergency_stop = true;
    bench.run(1);
    assert_eq!(bench.leg.state(), State::Off);
    for command in [Command::Arm, Command::Home, go] {
        assert_eq!(bench.obey(command), Err(CommandRefusal::Faulted));
    }
    assert_eq!(bench.obey(Command::Clear), Err(CommandRefusal::Faulted));
    bench.sensors.emergency_stop = false;
    bench.run(1);
    assert_eq!(bench.obey(Command::Clear), Ok(()));
    assert_eq!(bench.leg.state(), State::Disarmed);
}

/// What a stop overtakes is refused before a tick comes, and leaves its room to others.
#[test]
fn what_a_stop_overtakes_is_refused_at_once_and_in_order() {
    let mut bench = Bench::new(Some([0.2; 3]));
    assert_eq!(bench.obey(Command::Arm), Ok(()));
    for number in 0..8 {
        assert!(bench.leg.command(number, Command::KeepAlive));
    }
    assert!(bench.leg.command(8, Command::Stop));
    for number in 9..16 {
        assert!(bench.leg.command(number, Command::KeepAlive));
    }
    assert!(!bench.leg.command(16, Command::KeepAlive));
    let outcomes: Vec<_> = std::iter::from_fn(|| bench.leg.outcome()).collect();
    let refused = |number| CommandOutcome {
        number,
        result: Err(CommandRefusal::Superseded),
    };
    assert_eq!(outcomes, (0..8).map(refused).collect::<Vec<_>>());
    bench.run(2 * u16::from(CYCLE_TICKS));
    let result = Ok(());
    assert_eq!(
        bench.leg.outcome(),
        Some(CommandOutcome { number: 8, result })
    );
}

/// A stop goes before everything that waits, and what waited is told so.
#[test]
fn a_stop_overtakes_what_waits() {
    let mut bench = Bench::new(Some([0.2; 3]));
    assert_eq!(bench.obey(Command::Arm), Ok(()));
    let mut taken = 0;
    while bench.leg.command(taken, Command::KeepAlive) {
        taken += 1;
    }
    assert_eq!(taken, 8);
    assert!(bench.leg.command(100, Command::Stop));
    bench.run(2 * u16::from(CYCLE_TICKS));
    assert_eq!(bench.leg.state(), State::Held);
    let outcomes: Vec<_> = std::iter::from_fn(|| bench.leg.outcome()).collect();
    // None is lost.
    assert_eq!(outcomes.len(), 9);
    assert_eq!(
        outcomes.last(),
        Some(&CommandOutcome {
            number: 100,
            result: Ok(())
        })
    );
    let overtaken = Err(CommandRefusal::Superseded);
    assert!(
        outcomes[..8]
            .iter()
            .all(|outcome| outcome.result == overtaken)
    );
}
