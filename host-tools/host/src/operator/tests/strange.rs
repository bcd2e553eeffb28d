//! Boards that do not do as they say, and say what was not asked.

use super::lean;
use super::scripted::{at_rest, scripted, told};
use crate::operator::OperatorError;
use leg_base::failure::Failure;
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_firmware::supervisor::State;

#[test]
fn a_reply_of_another_kind_is_named() {
    let mut operator = scripted(|_| Some(HostReply::Done));
    let errors = [
        operator.telemetry().map(drop),
        operator.sensors().map(drop),
        operator.settings().map(drop),
    ];
    for error in errors.map(Result::unwrap_err) {
        assert!(matches!(error, OperatorError::WrongReply { .. }), "{error}");
        assert!(matches!(Failure::from(error), Failure::Refused(_)));
    }
}

#[test]
fn settings_that_read_back_otherwise_are_named() {
    let (_, kept) = at_rest();
    let mut sent = kept.clone();
    sent.limits.slack_n = 3.0;
    let mut operator = scripted(move |request| {
        Some(match request {
            HostRequest::GetSettings => HostReply::Settings(kept.clone()),
            _ => HostReply::Done,
        })
    });
    let error = operator.set_settings(&sent).unwrap_err();
    assert!(
        matches!(&error, OperatorError::ReadBack { names } if *names == ["limits.slack_n"]),
        "{error}"
    );
    assert!(matches!(Failure::from(error), Failure::Missed(_)));
}

#[test]
fn a_busy_board_is_not_taken_for_a_silent_one() {
    let mut operator = scripted(|_| Some(HostReply::Refused(HostRefusal::Busy)));
    let error = operator.save_settings().unwrap_err();
    assert!(
        matches!(
            error,
            OperatorError::Refused {
                refusal: HostRefusal::Busy,
                ..
            }
        ),
        "{error}"
    );
    assert_eq!(
        error.to_string(),
        "the leg does not keep its settings: the board is still busy with what it was asked before"
    );
}

#[test]
fn a_leg_that_never_comes_to_rest_is_late() {
    let (mut telemetry, _) = at_rest();
    telemetry.state = State::RampingDown;
    let mut operator = scripted(move |_| Some(told(&telemetry)));
    let error = operator.reach(&lean(10.0)).unwrap_err();
    assert!(matches!(error, OperatorError::Late { .. }), "{error}");
    assert!(
        error
            .to_string()
            .starts_with("the leg did not come to rest within 60 s; it is "),
        "{error}"
    );
    assert!(matches!(Failure::from(error), Failure::Missed(_)));
}

#[test]
fn a_leg_that_rests_elsewhere_says_where() {
    let (mut telemetry, settings) = at_rest();
    telemetry.state = State::Active;
    telemetry.target = telemetry.pose;
    telemetry.target_tensions_n = telemetry.tensions_n;
    let mut operator = scripted(move |request| {
        Some(match request {
            HostRequest::Telemetry => told(&telemetry),
            HostRequest::GetSettings => HostReply::Settings(settings.clone()),
            _ => HostReply::Done,
        })
    });
    let error = operator.reach(&lean(10.0)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the leg did not move there: it came to rest at straight down"
    );
    assert!(matches!(error, OperatorError::Elsewhere { .. }));
    assert!(matches!(Failure::from(error), Failure::Missed(_)));
}
