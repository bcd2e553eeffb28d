use super::{Event, Fault, FaultSet, Reaction, State, Supervisor};

const REACTIONS: [Reaction; 4] = [
    Reaction::Limit,
    Reaction::Hold,
    Reaction::RampDown,
    Reaction::GateOff,
];

fn active() -> Supervisor {
    let mut supervisor = Supervisor::default();
    assert!(supervisor.happen(Event::Ready));
    assert!(supervisor.happen(Event::Arm));
    supervisor
}

#[test]
fn each_fault_has_its_reaction_in_the_same_tick() {
    for fault in Fault::ALL {
        let mut supervisor = active();
        supervisor.watch(FaultSet::of(fault));
        let expected = match fault.reaction() {
            Reaction::Limit => State::Active,
            Reaction::Hold => State::Held,
            Reaction::RampDown => State::RampingDown,
            Reaction::GateOff => State::Off,
        };
        assert_eq!(supervisor.state(), expected, "{fault:?}");
    }
}

#[test]
fn a_reaction_only_ever_takes_authority_away() {
    let authority = |state| match state {
        State::Active | State::Homing => 3,
        State::Held => 2,
        State::RampingDown => 1,
        State::Boot | State::Disarmed | State::Off => 0,
    };
    for state in State::ALL {
        for reaction in REACTIONS {
            if let Some(after) = state.after(Event::Reaction(reaction)) {
                assert!(
                    authority(after) <= authority(state),
                    "{state:?} {reaction:?} {after:?}"
                );
            }
        }
    }
}

#[test]
fn nothing_but_a_clear_leads_back() {
    let events = [
        Event::Ready,
        Event::Arm,
        Event::Home,
        Event::Homed,
        Event::Stop,
        Event::Disarm,
        Event::Relaxed,
    ];
    for fault in Fault::ALL
        .into_iter()
        .filter(|fault| fault.reaction() > Reaction::Limit)
    {
        let mut supervisor = active();
        supervisor.watch(FaultSet::of(fault));
        // Every sequence of three events, the fault's cause gone.
        for first in events {
            for second in events {
                for third in events {
                    let mut tried = supervisor;
                    for event in [first, second, third] {
                        tried.happen(event);
                        tried.watch(FaultSet::NONE);
                    }
                    let state = tried.state();
                    assert!(
                        !matches!(state, State::Active | State::Homing),
                        "{fault:?} {first:?} {second:?} {third:?}"
                    );
                }
            }
        }
        assert!(supervisor.latched().has(fault));
    }
}

#[test]
fn a_clear_does_nothing_while_the_cause_is_there() {
    let mut supervisor = active();
    supervisor.watch(FaultSet::of(Fault::EmergencyStop));
    assert!(!supervisor.clear(true));
    assert_eq!(supervisor.state(), State::Off);
    supervisor.watch(FaultSet::NONE);
    assert_eq!(supervisor.state(), State::Off);
    assert!(supervisor.clear(true));
    assert_eq!(supervisor.state(), State::Disarmed);
}

#[test]
fn a_fault_that_limits_ends_with_its_cause() {
    let mut supervisor = active();
    supervisor.watch(FaultSet::of(Fault::Unreachable));
    assert!(supervisor.latched().has(Fault::Unreachable));
    supervisor.watch(FaultSet::NONE);
    assert!(!supervisor.latched().any());
    assert_eq!(supervisor.state(), State::Active);
}
