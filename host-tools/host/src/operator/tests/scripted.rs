//! Boards that do not know their host, do not do as they report, and send what was not asked.

use super::scripted_board::{
    introduction, resting_leg, scripted, scripted_by_number, scripted_from_start, telemetry_reply,
};
use super::{is_failed, lean, stiffness};
use crate::operator::{Operator, OperatorError};
use leg_base::failure::Failure;
use leg_base::timed_path::{PathRow, TimedPath};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_firmware::supervisor::{Fault, FaultSet, State};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::time::Duration;

#[test]
fn other_firmware_and_silence_are_told_apart() {
    let schema = HostRefusal::SchemaMismatch { schema: [0xab; 8] };
    let opened = scripted_from_start(move |_| Some(HostReply::Refused(schema)));
    let error = error_of!(opened, OperatorError::OtherSchema(..));
    let text = error.to_string();
    assert!(
        text.starts_with(
            "the firmware at a scripted board speaks another protocol (schema abababababababab, this program "
        ),
        "{text}"
    );
    let silent = scripted_from_start(|_| Some(HostReply::Done));
    let error = error_of!(silent, OperatorError::NoAnswer(_));
    assert_eq!(error.to_string(), "a scripted board does not answer");
}

#[test]
fn a_reply_of_another_kind_is_named() {
    let mut operator = scripted(|_| Some(HostReply::Done));
    for result in [
        operator.telemetry().map(drop),
        operator.sensors().map(drop),
        operator.settings().map(drop),
    ] {
        let error = error_of!(result, OperatorError::WrongReply(_));
        assert!(!is_failed(&error));
    }
}

/// Hosts that share a line count their requests alike now and then.
#[test]
fn a_reply_to_another_host_with_the_same_number_is_left_out() {
    let (telemetry, settings) = resting_leg();
    let kept = settings.clone();
    let mut operator = scripted_by_number(move |number, request| {
        let (other, own) = match request {
            HostRequest::Telemetry => (HostReply::Done, telemetry_reply(&telemetry)),
            HostRequest::GetSettings => {
                let settings = HostReply::Settings(settings.clone());
                (telemetry_reply(&telemetry), settings)
            }
            HostRequest::Identify(_) => (HostReply::Done, introduction()),
            _ => (telemetry_reply(&telemetry), HostReply::Done),
        };
        vec![(number, other), (number, own)]
    })
    .unwrap();
    operator.telemetry().unwrap();
    assert_eq!(operator.settings().unwrap(), kept);
    operator.command(Command::KeepAlive).unwrap();
    operator.stop().unwrap();
}

/// It had begun: nothing is wrong with what was asked.
#[test]
fn what_a_stop_came_before_has_failed() {
    let superseded = HostRefusal::Command(CommandRefusal::Superseded);
    let error = OperatorError::Refused("follow the path", superseded);
    assert!(is_failed(&error));
    assert_eq!(
        error.to_string(),
        "the leg did not follow the path: a stop or a disarm came first"
    );
}

#[test]
fn settings_that_read_back_otherwise_are_named() {
    let (_, kept) = resting_leg();
    let mut sent = kept.clone();
    sent.limits.slack_n = 3.0;
    let mut operator = scripted(move |request| {
        Some(match request {
            HostRequest::GetSettings => HostReply::Settings(kept.clone()),
            _ => HostReply::Done,
        })
    });
    let error = error_of!(
        operator.set_settings(&sent),
        OperatorError::ReadBack(names) if *names == ["limits.slack_n"]
    );
    assert!(is_failed(&error));
}

#[test]
fn a_busy_board_is_not_taken_for_a_silent_one() {
    let mut operator = scripted(|_| Some(HostReply::Refused(HostRefusal::Busy)));
    let error = error_of!(
        operator.save_settings(),
        OperatorError::Refused(_, HostRefusal::Busy)
    );
    assert_eq!(
        error.to_string(),
        "the leg does not keep its settings: the board is still busy with what it was asked before"
    );
}

#[test]
fn a_stop_is_repeated_at_its_pace_however_soon_it_is_refused() {
    let asked = Rc::new(Cell::new(0));
    let counted = Rc::clone(&asked);
    let mut operator = scripted(move |request| {
        if matches!(request, HostRequest::Telemetry) {
            return Some(telemetry_reply(&resting_leg().0));
        }
        counted.set(counted.get() + 1);
        (counted.get() < 39).then_some(HostReply::Refused(HostRefusal::Busy))
    });
    let told = watch_late(&mut operator);
    let begun = operator.now();
    error_of!(operator.stop(), OperatorError::NotStopped(_));
    assert_eq!(asked.get(), 200, "one in 50 ms");
    assert_eq!(operator.now() - begun, Duration::from_secs(10));
    // After two seconds each.
    let late = "a scripted board did not acknowledge the stop";
    assert_eq!(*told.borrow(), [late; 4]);
}

/// A board is so late that a disarm is sent again, and the second one goes before the first.
#[test]
fn a_repeated_disarm_is_not_refused_for_its_own_repetition() {
    let (mut telemetry, _) = resting_leg();
    telemetry.state = State::Disarmed;
    let superseded = HostReply::Refused(HostRefusal::Command(CommandRefusal::Superseded));
    for (last, accepted) in [(HostReply::Done, true), (superseded.clone(), false)] {
        let first = Cell::new(None);
        let superseded = superseded.clone();
        let mut operator = scripted_by_number(move |number, request| match request {
            HostRequest::Identify(_) => vec![(number, introduction())],
            HostRequest::Telemetry => vec![(number, telemetry_reply(&telemetry))],
            _ => match first.replace(Some(number)) {
                None => Vec::new(),
                Some(first) => vec![(first, superseded.clone()), (number, last.clone())],
            },
        })
        .unwrap();
        assert_eq!(operator.command(Command::Disarm).is_ok(), accepted);
    }
}

/// What the operator says while the board does not answer.
fn watch_late(operator: &mut Operator) -> Rc<RefCell<Vec<String>>> {
    let told = Rc::<RefCell<Vec<String>>>::default();
    let tell = Rc::clone(&told);
    operator.set_late_watcher(move |error| tell.borrow_mut().push(error.to_string()));
    told
}

#[test]
fn a_board_that_answers_late_is_waited_for_and_said_to_be_late() {
    let late_s = 8;
    let answer = resting_leg().0;
    let asked = Rc::new(Cell::new(0));
    let counted = Rc::clone(&asked);
    let mut operator = scripted(move |_| {
        counted.set(counted.get() + 1);
        (counted.get() > 4 * late_s).then(|| telemetry_reply(&answer))
    });
    let told = watch_late(&mut operator);
    operator.telemetry().unwrap();
    assert_eq!(*told.borrow(), ["a scripted board does not answer"]);
    assert_eq!(asked.get(), 4 * late_s + 1);
}

#[test]
fn a_leg_that_never_comes_to_rest_is_late() {
    let (mut telemetry, _) = resting_leg();
    telemetry.state = State::RampingDown;
    let mut operator = scripted(move |_| Some(telemetry_reply(&telemetry)));
    let error = error_of!(operator.reach(&lean(10.0)), OperatorError::TimedOut(..));
    let text = error.to_string();
    assert!(
        text.starts_with("the leg did not come to rest within 60 s; it is "),
        "{text}"
    );
    assert!(is_failed(&error));
}

/// What a load cell that is off by half its gain comes to.
#[test]
fn a_leg_that_stays_off_its_target_is_late_and_its_cells_are_named() {
    let (mut telemetry, settings) = resting_leg();
    telemetry.state = State::Active;
    telemetry.pose[0] = telemetry.target[0] + 0.0009;
    let mut operator = scripted(move |request| {
        Some(match request {
            HostRequest::Telemetry => telemetry_reply(&telemetry),
            HostRequest::GetSettings => HostReply::Settings(settings.clone()),
            _ => HostReply::Done,
        })
    });
    let error = error_of!(
        operator.reach(&stiffness(60.0)),
        OperatorError::TimedOut(..)
    );
    let Failure::Failed(message) = error.failure() else {
        panic!("{error}");
    };
    assert_eq!(
        message.sentence,
        "the leg did not change its stiffness within 60 s; it is active, 0.05° off its target, faults: none"
    );
    assert!(
        message
            .help
            .unwrap()
            .starts_with("calibrate the load cells")
    );
}

/// A leg that is paid out is waited for as long as its motors move, however slowly, and for five seconds once they stand.
#[test]
fn a_disarm_waits_while_the_motors_move_and_five_seconds_more() {
    const MOVES_S: u64 = 90;
    let (mut telemetry, _) = resting_leg();
    telemetry.state = State::RampingDown;
    let asked = Rc::new(Cell::new(0_u64));
    let counted = Rc::clone(&asked);
    let mut operator = scripted(move |request| {
        if !matches!(request, HostRequest::Telemetry) {
            return Some(HostReply::Done);
        }
        counted.set(counted.get() + 1);
        // A poll in 20 ms: 2 µm in each.
        if counted.get() <= 50 * MOVES_S {
            telemetry.pulled_m[0] -= 2e-6;
        }
        Some(telemetry_reply(&telemetry))
    });
    let begun = operator.now();
    let error = error_of!(operator.disarm(), OperatorError::TimedOut(..));
    assert!(error.to_string().contains("within 5 s"), "{error}");
    let waited_s = (operator.now() - begun).as_secs_f64();
    let moved_s = waited_s - 5.0;
    assert!(moved_s > 30.0, "it gave up after {waited_s} s");
    let polls = asked.get() as f64;
    assert!(
        polls > 50.0 * MOVES_S as f64,
        "{polls} polls in {waited_s} s"
    );
}

#[test]
fn a_leg_that_rests_elsewhere_reports_where() {
    let (mut telemetry, settings) = resting_leg();
    telemetry.state = State::Active;
    telemetry.target = telemetry.pose;
    telemetry.target_tensions_n = telemetry.tensions_n;
    let mut operator = scripted(move |request| {
        Some(match request {
            HostRequest::Telemetry => telemetry_reply(&telemetry),
            HostRequest::GetSettings => HostReply::Settings(settings.clone()),
            _ => HostReply::Done,
        })
    });
    let error = error_of!(operator.reach(&lean(10.0)), OperatorError::OtherPose(_));
    assert_eq!(
        error.to_string(),
        "the leg did not move there: it came to rest at straight down"
    );
    assert!(is_failed(&error));
}

/// A point is refused for the ramp down: that is no bad path, and what limits the leg on its way down does not matter.
#[test]
fn a_path_whose_leg_another_host_disarms_has_failed() {
    let (mut telemetry, settings) = resting_leg();
    telemetry.state = State::Active;
    telemetry.target = telemetry.pose;
    telemetry.target_tensions_n = telemetry.tensions_n;
    let mut points = 0;
    let mut operator = scripted(move |request| {
        Some(match request {
            HostRequest::Telemetry => telemetry_reply(&telemetry),
            HostRequest::GetSettings => HostReply::Settings(settings.clone()),
            HostRequest::Command {
                command: Command::Follow(_),
                ..
            } => {
                points += 1;
                if points < 5 {
                    return Some(HostReply::Done);
                }
                telemetry.state = State::RampingDown;
                telemetry.faults = FaultSet::single(Fault::Infeasible);
                let state = CommandRefusal::State(State::RampingDown);
                HostReply::Refused(HostRefusal::Command(state))
            }
            _ => HostReply::Done,
        })
    });
    let rows = [0.0, 5.0, 10.0, 15.0, 20.0];
    let rows = rows.map(|tilt_deg| PathRow::from_angles(0.2 * tilt_deg, 90.0, tilt_deg));
    let error = error_of!(
        operator.follow_whole(&TimedPath::new(&rows), Duration::from_millis(200)),
        OperatorError::StoppedByOtherHost(_, State::RampingDown)
    );
    assert!(is_failed(&error));
}

#[test]
fn silence_ends_the_wait_for_telemetry_in_time() {
    // Longer than any wait of the operator's own.
    let long = Duration::from_secs(20);
    let mut operator = scripted(|_| Some(HostReply::Done));
    operator.start_stream(1000).unwrap();
    let before = operator.now();
    assert_eq!(operator.next_streamed(long).unwrap(), None);
    assert_eq!(operator.now() - before, long);
}
