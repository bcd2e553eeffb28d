//! The clock behind embassy-time: TIMER0 runs freely and keeps the time, TIMER1 raises the next alarm.

use crate::timer::{CmsdkTimer, TIMER_HZ};
use crate::vectors::Interrupt;
use core::cell::RefCell;
use core::task::Waker;
use cortex_m::peripheral::NVIC;
use critical_section::Mutex;
use embassy_time_driver::{Driver, TICK_HZ, time_driver_impl};
use embassy_time_queue_utils::Queue;

/// Timer ticks in one tick of embassy-time.
const SCALE: u64 = TIMER_HZ / TICK_HZ;

/// A full turn of a timer, in its ticks.
const TURN: u64 = 1 << 32;

/// Where TIMER0 starts: it wraps within the boot check's alarm, which so proves the wrap, too.
const FIRST_VALUE: u32 = 12_500;

time_driver_impl!(static CLOCK: Clock = Clock::new());

defmt::timestamp!("{=u64:us}", embassy_time_driver::now());

struct Clock(Mutex<RefCell<State>>);

struct State {
    /// How often TIMER0 has reached zero.
    turns: u64,
    /// The latest time given, in timer ticks since the start.
    latest: u64,
    queue: Queue,
}

/// Starts the clock; the time is zero until then.
#[allow(
    unsafe_code,
    reason = "unmasking an interrupt can break critical sections that rely on masks"
)]
pub fn start() {
    CmsdkTimer::FREE_RUNNING.start(FIRST_VALUE, u32::MAX);
    // SAFETY: the clock's critical sections stop all interrupts and do not rely on masks.
    unsafe {
        NVIC::unmask(Interrupt::Timer0);
        NVIC::unmask(Interrupt::Timer1);
    }
}

impl Clock {
    const fn new() -> Self {
        Self(Mutex::new(RefCell::new(State {
            turns: 0,
            latest: 0,
            queue: Queue::new(),
        })))
    }

    fn with_state<R>(&self, body: impl FnOnce(&mut State) -> R) -> R {
        critical_section::with(|section| body(&mut self.0.borrow_ref_mut(section)))
    }
}

impl Driver for Clock {
    fn now(&self) -> u64 {
        self.with_state(State::elapsed) / SCALE
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        self.with_state(|state| {
            if state.queue.schedule_wake(at, waker) {
                state.set_alarm();
            }
        });
    }
}

impl State {
    /// Timer ticks since the start.
    fn elapsed(&mut self) -> u64 {
        let mut value = CmsdkTimer::FREE_RUNNING.value();
        if CmsdkTimer::FREE_RUNNING.take_event() {
            self.turns += 1;
            value = CmsdkTimer::FREE_RUNNING.value();
        }
        // The event comes with the zero, not after it: a turn starts there. A zero whose event is still to come
        // reads as the old turn's start, and `latest` keeps the time from going back.
        let position = u64::from(value.wrapping_neg());
        let elapsed = (self.turns * TURN + u64::from(FIRST_VALUE) + position).saturating_sub(TURN);
        self.latest = self.latest.max(elapsed);
        self.latest
    }

    /// Wakes what is due and sets TIMER1 to what comes next.
    fn set_alarm(&mut self) {
        let elapsed = self.elapsed();
        let next = self.queue.next_expiration(elapsed / SCALE);
        if next == u64::MAX {
            CmsdkTimer::ALARM.stop();
            return;
        }
        // An alarm beyond a turn rings early and is then set again.
        let wait = next.saturating_mul(SCALE).saturating_sub(elapsed);
        CmsdkTimer::ALARM.start(u32::try_from(wait).unwrap_or(u32::MAX).max(1), 0);
    }
}

#[allow(
    unsafe_code,
    reason = "the vector table names its handlers without mangling"
)]
#[unsafe(no_mangle)]
extern "C" fn TIMER0() {
    CLOCK.with_state(State::elapsed);
}

#[allow(
    unsafe_code,
    reason = "the vector table names its handlers without mangling"
)]
#[unsafe(no_mangle)]
extern "C" fn TIMER1() {
    CmsdkTimer::ALARM.stop();
    CLOCK.with_state(State::set_alarm);
}
