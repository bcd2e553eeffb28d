#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::command::{Command, CommandRefusal, Compensation};
use crate::control::{LengthError, Measured, ticks};
use crate::leg::Leg;
use crate::leg::active::Active;
use crate::leg::held::{Held, Momentum};
use crate::leg::mode::Mode;
use crate::set_point::{SetPoint, StreamPart};
use crate::settings::Settings;
use crate::supervisor::{ErrorGrowth, Event, FAR_CYCLES, Fault, FaultSet, SETTLE_CYCLES, State};
use core::f64::consts::TAU;
use leg_model::{Direction, Scalar};

const MEASURED: Measured<f64> = Measured::resting([0.01; 3], [30.0; 3]);

/// A leg that follows commands at rest.
fn armed() -> Leg<f64> {
    armed_by(&MEASURED)
}

fn armed_by<T: Scalar>(measured: &Measured<T>) -> Leg<T> {
    let mut leg = Leg::new(&Settings::table_1().unwrap()).unwrap();
    let active = Active::begin(&mut leg.shared, measured);
    leg.mode = Mode::Active(active);
    leg
}

/// What leads a leg.
fn leading() -> [Command; 6] {
    [
        Command::Move { x: 0.1, y: 0.0 },
        Command::Hold,
        Command::Follow(SetPoint {
            part: StreamPart::First,
            tick: 4000,
            direction: [0.0; 2],
            rate: [0.0; 2],
            acceleration: None,
            tension: None,
        }),
        Command::Pretension(10.0),
        Command::Stiffness {
            demand_nm_per_rad: 1.0,
            towards: None,
        },
        Command::Compensation(Compensation::Off),
    ]
}

/// It has to be armed again first.
#[test]
fn a_leg_that_keeps_station_is_not_led() {
    let mut leg = armed();
    assert!(leg.mode.change_station(State::KeepingStation, &leg.shared));
    for command in leading() {
        let refused = leg.execute(command, &MEASURED);
        let expected = Err(CommandRefusal::State(State::KeepingStation));
        assert_eq!(refused, expected, "{command:?}");
    }
    let active = leg.mode.active().unwrap();
    assert!(!active.trajectory.moving() && active.commanded.is_none());
}

/// It is left to itself where its sensors agree at this moment, which they do again before they are a fault.
#[test]
fn a_leg_whose_sensors_disagree_is_held_in_place_of_keeping_station() {
    for (agrees, state) in [(true, State::KeepingStation), (false, State::Held)] {
        let mut leg = armed();
        if let Mode::Active(active) = &mut leg.mode {
            active.tensioned = true;
        }
        let error = LengthError {
            mean_m: 0.0,
            elongations_m: [1e-3; 3],
        };
        for _ in 0..=SETTLE_CYCLES {
            leg.agreement.watch(&error, &ErrorGrowth::RESTING);
        }
        if !agrees {
            leg.agreement.pause();
        }
        assert!(leg.agreement.watches() && leg.agreement.trusts() == agrees);
        assert_eq!(leg.execute(Command::KeepStation, &MEASURED), Ok(()));
        assert_eq!(leg.mode.state(), state);
    }
}

/// A held leg whose cell came to show too much tension by itself is not cleared while its sensors are not close, although they agree, and has no zero once it
/// is paid out. One whose sensors disagreed for another reason and agree again is cleared.
#[test]
fn a_leg_that_is_held_by_a_doubted_excess_has_to_home() {
    for (part, far_cycles, cleared) in [
        (0.5, FAR_CYCLES, false),
        (0.1, FAR_CYCLES, true),
        (0.5, 0, true),
    ] {
        let mut leg = armed();
        leg.shared.zero_m = Some([0.2; 3]);
        leg.mode = Mode::Held(Held::resting());
        let mut error = LengthError {
            mean_m: 0.0,
            elongations_m: [1e-3; 3],
        };
        for _ in 0..=SETTLE_CYCLES {
            leg.agreement.watch(&error, &ErrorGrowth::STANDING);
        }
        error.mean_m = part * f64::from(Settings::table_1().unwrap().limits.residual_change_m);
        leg.agreement.watch(&error, &ErrorGrowth::STANDING);
        assert!(leg.agreement.agree());
        for _ in 0..far_cycles {
            let _ = leg.agreement.held_excess();
        }
        leg.supervisor
            .react(State::Held, FaultSet::single(Fault::Residual));
        // It is not there any more in the next tick.
        leg.supervisor.react(State::Held, FaultSet::NONE);
        let mut paid_out = leg.clone();
        let expected = if cleared {
            Ok(())
        } else {
            Err(CommandRefusal::Faulted)
        };
        assert_eq!(leg.execute(Command::Clear, &MEASURED), expected);
        assert_eq!(paid_out.execute(Command::Disarm, &MEASURED), Ok(()));
        assert_eq!(paid_out.mode.state(), State::RampingDown);
        assert_eq!(paid_out.shared.zero_m.is_some(), cleared);
    }
}

/// A leg that hangs straight down is paid out no farther than to slack by a pose that its sensors agree on: not before every tendon has pulled for a
/// while, nor with a fault, which may be one of what the pose is estimated by. With a fault nothing is known of slack, either.
#[test]
fn a_ramp_down_relies_on_a_pose_that_is_watched_and_no_fault_doubts() {
    const SLACK_M: [f64; 3] = [-0.01, -0.02, -0.03];
    let error = LengthError {
        mean_m: 0.0,
        elongations_m: [1e-3; 3],
    };
    for (watched, fault, trusted) in [
        (true, None, true),
        (false, None, false),
        (true, Some(Fault::CommandTimeout), false),
        (true, Some(Fault::CellStale), false),
    ] {
        let mut leg = armed();
        leg.shared.zero_m = Some([0.2; 3]);
        leg.shared.known_slack_m = SLACK_M;
        leg.mode = Mode::Held(Held::resting());
        let cycles = if watched { SETTLE_CYCLES } else { 0 };
        for _ in 0..=cycles {
            leg.agreement.watch(&error, &ErrorGrowth::STANDING);
        }
        assert_eq!(leg.agreement.watches(), watched);
        let faults = fault.map_or(FaultSet::NONE, FaultSet::single);
        leg.supervisor.react(State::Held, faults);
        assert_eq!(leg.end(Event::Disarm, &MEASURED), Ok(()));
        let Mode::RampingDown(ramping_down) = &leg.mode else {
            unreachable!("{:?}", leg.mode.state());
        };
        assert_eq!(ramping_down.trusts_pose(), trusted, "{watched} {fault:?}");
        let known = leg.shared.known_slack_m == SLACK_M;
        assert_eq!(known, fault.is_none(), "{watched} {fault:?}");
    }
}

/// A leg that brakes gives way to a tension above the maximum, and no more once a load cell is in doubt.
#[test]
fn a_brake_gives_way_to_no_load_cell_in_doubt() {
    for (fault, gives_way) in [
        (None, true),
        (Some(Fault::DriverFault), true),
        (Some(Fault::TensionJump), false),
        (Some(Fault::CellStuck), false),
    ] {
        let mut leg = armed();
        let momentum = Momentum {
            steps_m: [1e-6; 3],
            ticks_to_end: None,
        };
        leg.mode = Mode::Held(Held::braking(&leg.shared, momentum, false));
        leg.shared.f_max_n = 150.0;
        let faults = fault.map_or(FaultSet::NONE, FaultSet::single);
        leg.supervisor.react(State::Held, faults);
        let _ = leg.advance(&MEASURED);
        assert_eq!(leg.shared.f_max_n < f64::MAX, gives_way, "{fault:?}");
    }
}

/// A leg on its way or at rest, whose second motor turns.
fn turning(moves: bool) -> Leg<f64> {
    let mut leg = armed();
    if moves {
        let went = leg.execute(Command::Move { x: 0.1, y: 0.0 }, &MEASURED);
        assert_eq!(went, Ok(()));
    }
    if let Mode::Active(active) = &mut leg.mode {
        active.pretensioned = true;
    }
    for tick in 0..1000 {
        leg.shared.axes[1].track(1e-6 * f64::from(tick));
    }
    leg.shared.axes[1].lead_by(1e-6);
    leg
}

/// Each fault that a load cell may cause: the motors of a leg at rest may have followed that cell, and stand at once. One on its way brakes, and pays no
/// tendon out by its cells. Every other fault lets both brake, and give way, but that a leg at rest stands at once, too, where a current is in doubt.
#[test]
fn a_held_leg_goes_on_with_nothing_by_any_fault_that_a_load_cell_may_cause() {
    for (fault, of_a_cell) in [
        (Fault::Slack, true),
        (Fault::TensionJump, true),
        (Fault::Residual, true),
        (Fault::CellStale, true),
        (Fault::CellStuck, true),
        (Fault::CellSaturated, true),
        (Fault::Swings, true),
        (Fault::CurrentDisagrees, false),
        (Fault::OverTemperature, false),
        (Fault::SupplyLow, false),
        (Fault::LateTick, false),
        (Fault::CommandTimeout, false),
    ] {
        for moves in [false, true] {
            let mut leg = turning(moves);
            let state = leg.supervisor.react(State::Active, FaultSet::single(fault));
            assert_eq!(state, State::Held);
            leg.enter(state, &MEASURED);
            let stands = of_a_cell || fault == Fault::CurrentDisagrees;
            assert_eq!(leg.mode.brakes(), moves || !stands, "{fault:?} {moves}");
            let gives_way = leg.shared.f_max_n < f64::MAX;
            let expected = leg.mode.brakes() && !of_a_cell;
            assert_eq!(gives_way, expected, "{fault:?} {moves}");
        }
    }
}

/// A tendon that is slack while the leg is on its way may say that something holds it: it is braked in 0.06 s, and by any other fault in 0.15 s.
#[test]
fn a_leg_on_its_way_is_braked_shortly_where_a_tendon_is_slack() {
    for (fault, brake_s) in [(Fault::Slack, 0.06), (Fault::LateTick, 0.15)] {
        let mut leg = turning(true);
        let state = leg.supervisor.react(State::Active, FaultSet::single(fault));
        leg.enter(state, &MEASURED);
        let most = ticks(0.3);
        let braked = (0..most).find(|_| {
            let brakes = leg.mode.brakes();
            let _ = leg.advance(&MEASURED);
            !brakes
        });
        assert_eq!(braked, Some(ticks(brake_s)), "{fault:?}");
    }
}

#[test]
fn a_leg_that_is_led_down_to_be_disarmed_is_not_led_elsewhere() {
    let mut leg = armed();
    if let Mode::Active(active) = &mut leg.mode {
        active.disarm(&mut leg.shared);
    }
    let [go, hold, follow, ..] = leading();
    for command in [go, hold, follow] {
        let refused = leg.execute(command, &MEASURED);
        let expected = Err(CommandRefusal::State(State::RampingDown));
        assert_eq!(refused, expected, "{command:?}");
    }
    let active = leg.mode.active().unwrap();
    assert_eq!(active.commanded, Some([0.0; 2]));
}

/// Whichever azimuth it has, and in either precision.
#[test]
fn a_leg_sets_out_for_the_greatest_tilt() {
    let reach = f64::from(Settings::table_1().unwrap().tilt_max_sine);
    let single = MEASURED.single();
    for step in 0..3600 {
        let (sin, cos) = (f64::from(step) * TAU / 3600.0).sin_cos();
        let [x, y] = [reach * cos, reach * sin].map(|part| part as f32);
        for (part, expected) in [(1.0, Ok(())), (1.000_01, Err(CommandRefusal::OutOfReach))] {
            let to = Command::Move {
                x: part * x,
                y: part * y,
            };
            assert_eq!(armed().execute(to, &MEASURED), expected, "{step}");
            assert_eq!(armed_by(&single).execute(to, &single), expected, "{step}");
        }
    }
}

/// A move to a point of the workspace sets out for it; another one is refused, and the leg stays where it is.
#[test]
fn a_leg_sets_out_for_the_workspace_alone() {
    let reach = Settings::table_1().unwrap().tilt_max_sine;
    let inside = 0.99 * reach;
    let outside = 0.71 * reach;
    for (x, y, expected) in [
        (inside, 0.0, Ok(())),
        (0.0, -inside, Ok(())),
        (outside, outside, Err(CommandRefusal::OutOfReach)),
        (-1.01 * reach, 0.0, Err(CommandRefusal::OutOfReach)),
        (f32::NAN, 0.0, Err(CommandRefusal::Number)),
        (0.0, f32::INFINITY, Err(CommandRefusal::Number)),
    ] {
        let mut leg = armed();
        assert_eq!(leg.execute(Command::Move { x, y }, &MEASURED), expected);
        let active = leg.mode.active().unwrap();
        let [to_x, to_y] = active.commanded.unwrap_or([0.0; 2]);
        if expected.is_ok() {
            let off = (to_x - f64::from(x)).abs() + (to_y - f64::from(y)).abs();
            assert!(off < 1e-6, "{x} {y}");
        } else {
            assert!(active.commanded.is_none(), "{x} {y}");
        }
        assert_eq!(active.trajectory.moving(), expected.is_ok(), "{x} {y}");
        assert_eq!(leg.shared.refused, expected.is_err(), "{x} {y}");
    }
    // Down is inside.
    let mut leg = armed();
    leg.shared.refused = true;
    let down = Direction::<f32>::straight_down().vector();
    let went = leg.execute(
        Command::Move {
            x: down.x,
            y: down.y,
        },
        &MEASURED,
    );
    assert_eq!((went, leg.shared.refused), (Ok(()), false));
}

/// What was refused is told until a command is accepted, a pretension or a stiffness, too; not that a leg has no target.
#[test]
fn a_pretension_that_is_accepted_ends_what_was_refused() {
    let stiffness = |demand_nm_per_rad| Command::Stiffness {
        demand_nm_per_rad,
        towards: None,
    };
    for command in [Command::Pretension(60.0), stiffness(90.0)] {
        for (without_target, refused) in [(false, false), (true, true)] {
            let mut leg = armed();
            let impossible = leg.execute(stiffness(-1.0), &MEASURED);
            assert_eq!(impossible, Err(CommandRefusal::Number));
            assert!(leg.shared.refused);
            if let Mode::Active(active) = &mut leg.mode {
                active.without_target = without_target;
            }
            assert_eq!(leg.execute(command, &MEASURED), Ok(()));
            assert_eq!(leg.shared.refused, refused, "{command:?}");
        }
    }
}

/// Somebody left the load out, and is not there any more: a leg that homes compensates, so that what it shows then is looked at.
#[test]
fn a_homing_ends_that_the_load_is_left_out() {
    for compensation in [Compensation::Off, Compensation::Frozen] {
        let mut leg = armed();
        leg.mode = Mode::Disarmed;
        assert_eq!(
            leg.execute(Command::Compensation(compensation), &MEASURED),
            Ok(())
        );
        assert_eq!(leg.shared.compensation, compensation);
        assert_eq!(leg.execute(Command::Home, &MEASURED), Ok(()));
        assert_eq!(leg.mode.state(), State::Homing);
        assert_eq!(leg.shared.compensation, Compensation::Estimated);
    }
}
