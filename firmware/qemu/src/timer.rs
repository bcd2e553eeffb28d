//! A CMSDK timer of the mps2-an386: it counts down at 25 MHz and raises its event at zero.

/// Counting rate of a timer, Hz.
pub const TIMER_HZ: u64 = 25_000_000;

const CONTROL: usize = 0;
const VALUE: usize = 1;
const RELOAD: usize = 2;
const EVENT: usize = 3;

const ENABLE: u32 = 1;
const INTERRUPT: u32 = 1 << 3;

/// One of the timers.
#[derive(Clone, Copy)]
pub struct CmsdkTimer {
    base: *mut u32,
}

impl CmsdkTimer {
    /// TIMER0: keeps the time.
    pub const FREE_RUNNING: Self = Self {
        base: 0x4000_0000 as *mut u32,
    };

    /// TIMER1: raises the next alarm.
    pub const ALARM: Self = Self {
        base: 0x4000_1000 as *mut u32,
    };

    /// Starts from `value` with interrupts; after zero it goes on from `reload`, or stops if that is zero.
    pub fn start(self, value: u32, reload: u32) {
        self.write(CONTROL, 0);
        self.write(RELOAD, reload);
        self.write(VALUE, value);
        self.write(EVENT, 1);
        self.write(CONTROL, ENABLE | INTERRUPT);
    }

    /// Stops it and drops its event.
    pub fn stop(self) {
        self.write(CONTROL, 0);
        self.write(EVENT, 1);
    }

    /// What is left to zero.
    #[inline(always)]
    pub fn value(self) -> u32 {
        self.read(VALUE)
    }

    /// Whether it has reached zero since this was last asked.
    pub fn take_event(self) -> bool {
        let reached = self.read(EVENT) != 0;
        if reached {
            self.write(EVENT, 1);
        }
        reached
    }

    #[allow(unsafe_code, reason = "a device's register is raw memory")]
    #[inline(always)]
    fn read(self, register: usize) -> u32 {
        // SAFETY: `base` is one of the two timers of the board, each of which has the four registers.
        unsafe { self.base.add(register).read_volatile() }
    }

    #[allow(unsafe_code, reason = "a device's register is raw memory")]
    fn write(self, register: usize, value: u32) {
        // SAFETY: as for reading; a timer reaches no memory.
        unsafe { self.base.add(register).write_volatile(value) }
    }
}
