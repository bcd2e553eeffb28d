//! The tasks that must check in before the hardware watchdog is fed.

use core::sync::atomic::{AtomicBool, Ordering};

/// What checks in: two tasks and the control interrupt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WatchedTask {
    /// The control interrupt, once a tick.
    Control,
    /// The task on the host's line, about once a millisecond.
    Link,
    /// The task that keeps settings; to save some can take it a tenth of a second.
    Settings,
}

impl WatchedTask {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Control, Self::Link, Self::Settings];

    /// The most rounds in a row that it may miss. A round takes [`CheckIns::PERIOD_MS`].
    const fn missed_max(self) -> u8 {
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

/// The flags of those that have checked in.
#[derive(Debug, Default)]
pub struct CheckIns {
    present: [AtomicBool; 3],
}

impl CheckIns {
    /// Time from one round to the next, ms.
    pub const PERIOD_MS: u64 = 10;

    /// None has checked in.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            present: [const { AtomicBool::new(false) }; 3],
        }
    }

    /// A task checks in.
    #[inline(always)]
    pub fn check_in(&self, task: WatchedTask) {
        self.present[task as usize].store(true, Ordering::Relaxed);
    }

    fn take(&self, task: WatchedTask) -> bool {
        self.present[task as usize].swap(false, Ordering::Relaxed)
    }
}

/// Counts the rounds that each task has missed in a row.
#[derive(Clone, Copy, Debug, Default)]
pub struct TaskWatchdog {
    missed: [u8; 3],
    absent: Option<WatchedTask>,
}

impl TaskWatchdog {
    /// One round. Names a task that has missed too many; once one has, for ever, as the reset is then due.
    pub fn poll(&mut self, check_ins: &CheckIns) -> Option<WatchedTask> {
        for (task, missed) in WatchedTask::ALL.into_iter().zip(&mut self.missed) {
            *missed = if check_ins.take(task) {
                0
            } else {
                missed.saturating_add(1)
            };
            if *missed > task.missed_max() {
                self.absent = self.absent.or(Some(task));
            }
        }
        self.absent
    }
}

#[cfg(test)]
mod tests {
    use super::{CheckIns, TaskWatchdog, WatchedTask};

    /// How many rounds pass until the task that stays away is named.
    fn rounds_without(away: WatchedTask) -> u32 {
        let check_ins = CheckIns::new();
        let mut watchdog = TaskWatchdog::default();
        for round in 0..1000 {
            for task in WatchedTask::ALL {
                if task != away {
                    check_ins.check_in(task);
                }
            }
            if let Some(absent) = watchdog.poll(&check_ins) {
                assert_eq!(absent, away);
                return round;
            }
        }
        u32::MAX
    }

    #[test]
    fn each_task_is_named_in_its_time() {
        assert_eq!(rounds_without(WatchedTask::Control), 0);
        assert_eq!(rounds_without(WatchedTask::Link), 4);
        assert_eq!(rounds_without(WatchedTask::Settings), 49);
    }

    #[test]
    fn a_task_that_checks_in_in_time_is_not_named() {
        let check_ins = CheckIns::new();
        let mut watchdog = TaskWatchdog::default();
        for round in 0..1000 {
            check_ins.check_in(WatchedTask::Control);
            if round % 5 == 4 {
                check_ins.check_in(WatchedTask::Link);
            }
            if round % 50 == 49 {
                check_ins.check_in(WatchedTask::Settings);
            }
            assert_eq!(watchdog.poll(&check_ins), None, "round {round}");
        }
    }

    #[test]
    fn a_task_once_named_stays_named() {
        let check_ins = CheckIns::new();
        let mut watchdog = TaskWatchdog::default();
        assert_eq!(watchdog.poll(&check_ins), Some(WatchedTask::Control));
        for task in WatchedTask::ALL {
            check_ins.check_in(task);
        }
        assert_eq!(watchdog.poll(&check_ins), Some(WatchedTask::Control));
    }
}
