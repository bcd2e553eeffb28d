//! Commands, and who may give them.

use super::{Line, ONE, OTHER, not_obeyed, refused};
use crate::command::{Command, CommandRefusal};
use crate::host_link::{HostRefusal, HostReply, HostRequest};
use crate::supervisor::State;

const MOVE: Command = Command::Move { x: 0.1, y: 0.2 };

/// A leg that follows the first of two hosts.
fn followed(state: State) -> Line {
    let mut line = Line::identified();
    assert_eq!(line.obey(ONE, Command::Arm), HostReply::Done);
    line.leg.state = state;
    line
}

#[test]
fn a_command_is_answered_under_its_number_once_a_tick_obeyed_it() {
    let mut line = Line::identified();
    let number = line.command(ONE, MOVE);
    line.link.report(&mut line.leg);
    assert_eq!(line.heard(), []);
    line.tick();
    assert_eq!(line.leg.obeyed, [MOVE]);
    assert_eq!(line.heard(), [(number, HostReply::Done)]);
    line.tick();
    assert_eq!(line.heard(), []);
}

#[test]
fn a_command_that_the_tick_refuses_is_refused_by_name() {
    let mut line = Line::identified();
    line.leg.result = Err(CommandRefusal::OutOfReach);
    assert_eq!(line.obey(ONE, MOVE), not_obeyed(CommandRefusal::OutOfReach));
}

#[test]
fn every_outcome_since_the_last_report_is_told() {
    let mut line = Line::identified();
    let numbers = [MOVE, Command::Hold].map(|command| line.command(ONE, command));
    line.leg.tick();
    line.leg.tick();
    line.tick();
    assert_eq!(
        line.heard(),
        numbers.map(|number| (number, HostReply::Done))
    );
}

#[test]
fn a_command_that_finds_no_room_is_told_that_the_leg_is_busy() {
    let mut line = Line::identified();
    let waiting = [MOVE, Command::Hold].map(|command| line.command(ONE, command));
    let request = HostRequest::Command {
        host: ONE,
        command: MOVE,
    };
    assert_eq!(line.ask(&request), refused(HostRefusal::Busy));
    line.tick();
    line.tick();
    assert_eq!(
        line.heard(),
        waiting.map(|number| (number, HostReply::Done))
    );
    assert_eq!(line.leg.obeyed, [MOVE, Command::Hold]);
}

/// A host that finds no room does not drive.
#[test]
fn a_host_that_the_leg_has_no_room_for_does_not_become_its_driver() {
    let mut line = followed(State::Held);
    line.leg.room = 0;
    let request = HostRequest::Command {
        host: OTHER,
        command: Command::Clear,
    };
    assert_eq!(line.ask(&request), refused(HostRefusal::Busy));
    line.leg.room = 2;
    line.leg.state = State::Active;
    assert_eq!(line.obey(ONE, MOVE), HostReply::Done);
}

#[test]
fn a_second_host_is_refused_while_the_first_drives() {
    for state in [State::Active, State::Homing] {
        let mut line = followed(state);
        // Its silence must not be broken by the wrong host either.
        for command in [MOVE, Command::KeepAlive, Command::Hold, Command::Clear] {
            let request = HostRequest::Command {
                host: OTHER,
                command,
            };
            assert_eq!(line.ask(&request), refused(HostRefusal::OtherHost));
        }
        assert!(line.leg.waiting.is_empty(), "{:?}", line.leg.waiting);
        assert_eq!(line.obey(ONE, MOVE), HostReply::Done);
    }
}

/// Between an arm and the tick that obeys it the leg does not follow anybody yet.
#[test]
fn who_only_speaks_does_not_take_the_leg_over() {
    for command in [Command::KeepAlive, MOVE, Command::Pretension(70.0)] {
        let mut line = followed(State::Disarmed);
        assert_eq!(line.obey(OTHER, command), HostReply::Done);
        line.leg.state = State::Active;
        assert_eq!(line.obey(ONE, MOVE), HostReply::Done);
    }
}

/// A leg that brakes executes nothing before it stands: neither is what another host sends meanwhile executed after what the first one sent.
#[test]
fn a_second_host_is_refused_while_what_the_first_begins_waits() {
    for begin in [Command::Arm, Command::Home, Command::Clear] {
        for other in [MOVE, Command::KeepAlive, Command::Clear] {
            let mut line = followed(State::Held);
            let number = line.command(ONE, begin);
            let request = HostRequest::Command {
                host: OTHER,
                command: other,
            };
            assert_eq!(line.ask(&request), refused(HostRefusal::OtherHost));
            assert_eq!(line.leg.waiting, [(number, begin)]);
            // Once that was refused, the leg follows nobody.
            line.leg.result = Err(CommandRefusal::NotHomed);
            line.tick();
            assert_eq!(
                line.heard(),
                [(number, not_obeyed(CommandRefusal::NotHomed))]
            );
            line.leg.result = Ok(());
            assert_eq!(line.obey(OTHER, other), HostReply::Done);
        }
    }
}

#[test]
fn any_host_may_stop_or_disarm_and_does_not_drive_by_that() {
    for end in [Command::Stop, Command::Disarm] {
        let mut line = followed(State::Active);
        assert_eq!(line.obey(OTHER, end), HostReply::Done);
        assert_eq!(line.leg.obeyed.last(), Some(&end));
        // As if there had been nothing to end: the leg follows the first host as before.
        let request = HostRequest::Command {
            host: OTHER,
            command: MOVE,
        };
        assert_eq!(line.ask(&request), refused(HostRefusal::OtherHost));
        assert_eq!(line.obey(ONE, MOVE), HostReply::Done);
    }
}

#[test]
fn a_leg_that_follows_nobody_obeys_whoever_comes() {
    for state in [State::Disarmed, State::Held, State::Off] {
        let mut line = followed(state);
        assert_eq!(line.obey(OTHER, Command::Clear), HostReply::Done);
        line.leg.state = State::Active;
        let request = HostRequest::Command {
            host: ONE,
            command: MOVE,
        };
        assert_eq!(line.ask(&request), refused(HostRefusal::OtherHost));
        assert_eq!(line.obey(OTHER, MOVE), HostReply::Done);
    }
}

#[test]
fn a_leg_that_was_never_commanded_obeys_the_first_that_does() {
    let mut line = Line::identified();
    line.leg.state = State::Active;
    assert_eq!(line.obey(OTHER, MOVE), HostReply::Done);
}
