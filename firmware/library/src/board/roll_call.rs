//! Who has to be alive for the watchdog to be fed.

use core::sync::atomic::{AtomicBool, Ordering};

/// Who checks in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Member {
    /// The control interrupt, once a tick.
    Control,
    /// The task on the host's line, about once a millisecond.
    Link,
    /// The task that keeps settings; to save some can take it a tenth of a second.
    Settings,
}

impl Member {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Control, Self::Link, Self::Settings];

    /// The most rounds in a row that it may miss. A round takes [`RollCall::ROUND_MS`].
    const fn patience(self) -> u8 {
        match self {
            Self::Control => 0,
            Self::Link => 4,
            Self::Settings => 49,
        }
    }

    /// Its name, as the subject of a sentence.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Control => "the control interrupt",
            Self::Link => "the link task",
            Self::Settings => "the settings task",
        }
    }
}

/// Notes who has checked in.
#[derive(Debug, Default)]
pub struct RollCall {
    present: [AtomicBool; 3],
}

impl RollCall {
    /// Time from one round to the next, ms.
    pub const ROUND_MS: u64 = 10;

    /// Nobody has checked in.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            present: [const { AtomicBool::new(false) }; 3],
        }
    }

    /// A member is alive.
    #[inline(always)]
    pub fn check_in(&self, member: Member) {
        self.present[member as usize].store(true, Ordering::Relaxed);
    }

    fn take(&self, member: Member) -> bool {
        self.present[member as usize].swap(false, Ordering::Relaxed)
    }
}

/// Counts the rounds that members miss.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rounds {
    missed: [u8; 3],
    absent: Option<Member>,
}

impl Rounds {
    /// One round. Names who has been away for too long; once one has, for ever, as the watchdog is to bite.
    pub fn call(&mut self, roll: &RollCall) -> Option<Member> {
        for (member, missed) in Member::ALL.into_iter().zip(&mut self.missed) {
            *missed = if roll.take(member) {
                0
            } else {
                missed.saturating_add(1)
            };
            if *missed > member.patience() {
                self.absent = self.absent.or(Some(member));
            }
        }
        self.absent
    }
}

#[cfg(test)]
mod tests {
    use super::{Member, RollCall, Rounds};

    /// How many rounds pass until the one who stays away is named.
    fn rounds_without(away: Member) -> u32 {
        let roll = RollCall::new();
        let mut rounds = Rounds::default();
        for round in 0..1000 {
            for member in Member::ALL {
                if member != away {
                    roll.check_in(member);
                }
            }
            if let Some(absent) = rounds.call(&roll) {
                assert_eq!(absent, away);
                return round;
            }
        }
        u32::MAX
    }

    #[test]
    fn each_member_is_missed_in_its_time() {
        assert_eq!(rounds_without(Member::Control), 0);
        assert_eq!(rounds_without(Member::Link), 4);
        assert_eq!(rounds_without(Member::Settings), 49);
    }

    #[test]
    fn who_comes_now_and_then_is_not_missed() {
        let roll = RollCall::new();
        let mut rounds = Rounds::default();
        for round in 0..1000 {
            roll.check_in(Member::Control);
            if round % 5 == 4 {
                roll.check_in(Member::Link);
            }
            if round % 50 == 49 {
                roll.check_in(Member::Settings);
            }
            assert_eq!(rounds.call(&roll), None, "round {round}");
        }
    }

    #[test]
    fn who_was_missed_once_is_missed_for_ever() {
        let roll = RollCall::new();
        let mut rounds = Rounds::default();
        assert_eq!(rounds.call(&roll), Some(Member::Control));
        for member in Member::ALL {
            roll.check_in(member);
        }
        assert_eq!(rounds.call(&roll), Some(Member::Control));
    }
}
