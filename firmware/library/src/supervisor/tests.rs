use super::{Event, Fault, FaultSet, Reaction, State, Supervisor};

const REACTIONS: [Reaction; 4] = [
    Reaction::Limit,
    Reaction::Hold,
    Reaction::RampDown,
    Reaction::GateOff,
];

/// A supervisor, and the state that it is asked about.
#[derive(Clone, Copy)]
struct Supervised {
    supervisor: Supervisor,
    state: State,
}

impl Supervised {
    fn active() -> Self {
        let supervisor = Supervisor::default();
        let armed = supervisor.next(State::Disarmed, Event::Arm);
        assert_eq!(armed, Some(State::Active));
        Self {
            supervisor,
            state: State::Active,
        }
    }

    fn apply(&mut self, event: Event) {
        self.state = self
            .supervisor
            .next(self.state, event)
            .unwrap_or(self.state);
    }

    fn watch(&mut self, present: FaultSet) {
        self.state = self.supervisor.react(self.state, present);
    }

    fn clear(&mut self) -> bool {
        let next = self.supervisor.clear(self.state, true, FaultSet::NONE);
        self.state = next.unwrap_or(self.state);
        next.is_some()
    }

    fn latched(&self) -> FaultSet {
        self.supervisor.latched()
    }
}

#[test]
fn each_fault_has_its_reaction_in_the_same_tick() {
    for fault in Fault::ALL {
        let mut leg = Supervised::active();
        leg.watch(FaultSet::single(fault));
        let expected = match fault.reaction() {
            Reaction::Limit => State::Active,
            Reaction::Hold => State::Held,
            Reaction::RampDown => State::RampingDown,
            Reaction::GateOff => State::Off,
        };
        assert_eq!(leg.state, expected, "{fault:?}");
    }
}

#[test]
fn a_reaction_only_ever_takes_authority_away() {
    let authority = |state| match state {
        State::Active | State::Homing => 4,
        State::KeepingStation => 3,
        State::Held => 2,
        State::RampingDown | State::Jogging => 1,
        State::Boot | State::Disarmed | State::Off => 0,
    };
    for state in State::ALL {
        for reaction in REACTIONS {
            if let Some(after) = state.next(Event::Reaction(reaction)) {
                assert!(
                    authority(after) <= authority(state),
                    "{state:?} {reaction:?} {after:?}"
                );
            }
        }
    }
}

/// What a fault leads to in each state: where nothing stands, the state stays.
#[test]
fn each_state_obeys_each_reaction() {
    use State::{Active, Boot, Disarmed, Held, Homing, Jogging, KeepingStation, Off, RampingDown};
    for (state, hold, ramp_down, gate_off) in [
        (Boot, None, None, Some(Off)),
        (Disarmed, None, None, Some(Off)),
        (Homing, Some(Held), Some(RampingDown), Some(Off)),
        (Active, Some(Held), Some(RampingDown), Some(Off)),
        (KeepingStation, Some(Held), Some(RampingDown), Some(Off)),
        (Held, None, Some(RampingDown), Some(Off)),
        (RampingDown, None, None, Some(Off)),
        (Off, None, None, None),
        (Jogging, Some(Off), Some(Off), Some(Off)),
    ] {
        for (reaction, after) in REACTIONS.into_iter().zip([None, hold, ramp_down, gate_off]) {
            let next = state.next(Event::Reaction(reaction));
            assert_eq!(next, after, "{state:?} {reaction:?}");
        }
    }
}

#[test]
fn whatever_stops_a_leg_switches_a_motor_that_turns_alone_off() {
    for reaction in REACTIONS {
        let stops = reaction > Reaction::Limit;
        let next = State::Jogging.next(Event::Reaction(reaction));
        assert_eq!(next, stops.then_some(State::Off), "{reaction:?}");
    }
}

#[test]
fn nothing_but_a_clear_leads_back() {
    let events = [
        Event::Ready,
        Event::Arm,
        Event::Home,
        Event::KeepStation,
        Event::Jog,
        Event::Jogged,
        Event::Homed,
        Event::Stop,
        Event::Disarm,
        Event::Relaxed,
    ];
    for fault in Fault::ALL
        .into_iter()
        .filter(|fault| fault.reaction() > Reaction::Limit)
    {
        let mut leg = Supervised::active();
        leg.watch(FaultSet::single(fault));
        // Every sequence of three events, the fault's cause gone.
        for first in events {
            for second in events {
                for third in events {
                    let mut tried = leg;
                    for event in [first, second, third] {
                        tried.apply(event);
                        tried.watch(FaultSet::NONE);
                    }
                    let state = tried.state;
                    assert!(
                        !matches!(state, State::Active | State::KeepingStation | State::Homing),
                        "{fault:?} {first:?} {second:?} {third:?}"
                    );
                    let off = fault.reaction() == Reaction::GateOff;
                    assert_eq!(
                        state == State::Off,
                        off,
                        "{fault:?} {first:?} {second:?} {third:?}"
                    );
                }
            }
        }
        assert!(leg.latched().has(fault));
    }
}

/// Not for a tick: a fault that is latched would end it in the same one.
#[test]
fn no_start_leads_anywhere_while_a_fault_is_latched() {
    for fault in Fault::ALL {
        let mut leg = Supervised::active();
        leg.watch(FaultSet::single(fault));
        let limits = fault.reaction() == Reaction::Limit;
        for (event, started) in [
            (Event::Arm, State::Active),
            (Event::Home, State::Homing),
            (Event::Jog, State::Jogging),
        ] {
            let next = leg.supervisor.next(State::Disarmed, event);
            assert_eq!(next, limits.then_some(started), "{fault:?} {event:?}");
        }
    }
}

/// A leg that moves is held, a motor that turns alone is switched off; what does not move goes on as it was.
#[test]
fn a_stop_ends_every_motion() {
    for (state, stopped) in [
        (State::Homing, Some(State::Held)),
        (State::Active, Some(State::Held)),
        (State::KeepingStation, Some(State::Held)),
        (State::Jogging, Some(State::Disarmed)),
        (State::Disarmed, None),
        (State::RampingDown, None),
        (State::Off, None),
    ] {
        assert_eq!(state.next(Event::Stop), stopped, "{state:?}");
    }
}

/// Its tendons would pull against the motor.
#[test]
fn a_motor_turns_alone_on_a_disarmed_leg_only() {
    for state in [
        State::Boot,
        State::Disarmed,
        State::Homing,
        State::Active,
        State::KeepingStation,
        State::Held,
        State::RampingDown,
        State::Off,
    ] {
        let jogging = (state == State::Disarmed).then_some(State::Jogging);
        assert_eq!(state.next(Event::Jog), jogging, "{state:?}");
    }
}

/// What holds the leg does not keep it from a more severe reaction.
#[test]
fn a_held_leg_is_let_down_or_switched_off_by_a_more_severe_fault() {
    for first in [Fault::Slack, Fault::CommandTimeout] {
        for fault in Fault::ALL {
            let mut leg = Supervised::active();
            leg.watch(FaultSet::single(first));
            assert_eq!(leg.state, State::Held);
            leg.watch(FaultSet::single(fault));
            let expected = match fault.reaction() {
                Reaction::Limit | Reaction::Hold => State::Held,
                Reaction::RampDown => State::RampingDown,
                Reaction::GateOff => State::Off,
            };
            assert_eq!(leg.state, expected, "{first:?}, then {fault:?}");
        }
    }
}

/// Without its zero it has to home first, which turns one motor after the other: the tendons are paid out for that.
#[test]
fn a_held_leg_that_is_cleared_is_let_down_unless_it_knows_its_zero() {
    for (homed, expected) in [(true, State::Active), (false, State::RampingDown)] {
        let mut leg = Supervised::active();
        leg.watch(FaultSet::single(Fault::CommandTimeout));
        assert_eq!(leg.state, State::Held);
        leg.watch(FaultSet::NONE);
        let next = leg.supervisor.clear(leg.state, homed, FaultSet::NONE);
        assert_eq!(next, Some(expected));
    }
}

#[test]
fn a_clear_does_nothing_while_the_cause_is_there() {
    let mut leg = Supervised::active();
    leg.watch(FaultSet::single(Fault::EmergencyStop));
    assert!(!leg.clear());
    assert_eq!(leg.state, State::Off);
    leg.watch(FaultSet::NONE);
    assert_eq!(leg.state, State::Off);
    assert!(leg.clear());
    assert_eq!(leg.state, State::Disarmed);
}

#[test]
fn a_fault_that_limits_ends_with_its_cause() {
    let mut leg = Supervised::active();
    leg.watch(FaultSet::single(Fault::Unreachable));
    assert!(leg.latched().has(Fault::Unreachable));
    leg.watch(FaultSet::NONE);
    assert!(!leg.latched().any());
    assert_eq!(leg.state, State::Active);
}
