//! The independent watchdog IWDG.
//!
//! It counts a clock of its own, LSI, which is as slow as 29.5 kHz and as fast as 34 kHz: STM32G474 datasheet, LSI
//! oscillator characteristics (by memory of the datasheet; the board layer names the same). The chip says which it is.
//!
//! Not modelled: low-power modes, the option byte that starts it at a reset.

#[cfg(test)]
mod tests;

use crate::clocks::Clocks;
use crate::device::{Context, Device, FieldPlace, RegisterFile};
use crate::facts::Facts;

/// The slowest and the fastest that LSI may be, Hz.
pub const LSI_RANGE_HZ: [u32; 2] = [29_500, 34_000];

/// What KR takes: RM0440, IWDG_KR; stm32-metapac names the same.
const START: u32 = 0xcccc;
const REFRESH: u32 = 0xaaaa;
const UNLOCK: u32 = 0x5555;

/// Periods of LSI until a write has arrived: RM0440, IWDG_SR, and ST's own driver (stm32g4xx_hal_iwdg.c), "up to 5".
const WRITE_PERIODS: u64 = 5;

/// A register that the watchdog takes over in its own time.
#[derive(Clone, Copy, Debug)]
struct Setting {
    name: &'static str,
    offset: u32,
    value: FieldPlace,
    busy: FieldPlace,
    /// What the watchdog counts with.
    used: u32,
    /// A write is on its way; it arrives in this cycle, if the watchdog runs.
    arrives: Option<u64>,
}

/// The watchdog.
#[derive(Clone, Debug)]
pub struct Iwdg {
    registers: RegisterFile,
    key: u32,
    status: u32,
    prescaler: Setting,
    reload: Setting,
    window: Setting,
    unlocked: bool,
    lsi_hz: u32,
    /// The cycle in which it was last refreshed, and the one in which it resets the chip; none before it is started.
    running: Option<(u64, u64)>,
    /// The key of a refresh was written since the last question.
    refreshed: bool,
}

impl Iwdg {
    /// Not started; `lsi_hz` is what its oscillator really does.
    ///
    /// # Panics
    /// If the facts do not know its registers.
    #[must_use]
    pub fn new(lsi_hz: u32) -> Self {
        let Some(block) = Facts::chip().block("IWDG") else {
            panic!("the facts have no block IWDG");
        };
        let registers = RegisterFile::new(block);
        let setting = |name, value, busy| Setting {
            name,
            offset: registers.offset(name),
            value: registers.field(name, value),
            busy: registers.field("SR", busy),
            used: 0,
            arrives: None,
        };
        let mut dog = Self {
            key: registers.offset("KR"),
            status: registers.offset("SR"),
            prescaler: setting("PR", "PR", "PVU"),
            reload: setting("RLR", "RL", "RVU"),
            window: setting("WINR", "WIN", "WVU"),
            registers,
            unlocked: false,
            lsi_hz: lsi_hz.max(1),
            running: None,
            refreshed: false,
        };
        dog.reset();
        dog
    }

    /// The cycle in which it resets the chip; none if it was not started.
    #[must_use]
    pub fn expires_at(&self) -> Option<u64> {
        self.running.map(|(_, end)| end)
    }

    /// Cycles from a refresh to the reset, by what its registers hold, with an oscillator of `lsi_hz`.
    #[must_use]
    pub fn timeout_cycles(&self, lsi_hz: u32, clocks: &Clocks) -> u64 {
        let prescaler = self.registers.value(self.prescaler.value);
        let reload = self.registers.value(self.reload.value);
        let periods = u64::from(reload + 1) * divider(prescaler);
        clocks.cycles(periods, lsi_hz).unwrap_or(u64::MAX)
    }

    /// Whether the key of a refresh was written since the last question.
    pub fn take_refreshed(&mut self) -> bool {
        std::mem::take(&mut self.refreshed)
    }

    /// The processor's clock changes its rate: what is due later is due in other cycles.
    pub fn rate_changes(&mut self, cycle: u64, from_hz: u32, to_hz: u32) {
        let scale = |due: u64| {
            let left = u128::from(due.saturating_sub(cycle)) * u128::from(to_hz);
            cycle + u64::try_from(left / u128::from(from_hz.max(1))).unwrap_or(u64::MAX / 2)
        };
        if let Some((refreshed_at, end)) = self.running {
            let since = u128::from(cycle - refreshed_at.min(cycle)) * u128::from(to_hz);
            let since = u64::try_from(since / u128::from(from_hz.max(1))).unwrap_or(cycle);
            self.running = Some((cycle.saturating_sub(since), scale(end)));
        }
        for setting in self.settings() {
            setting.arrives = setting.arrives.map(scale);
        }
    }

    /// A debugger halts it for some cycles.
    pub fn halt(&mut self, cycles: u64) {
        if let Some((refreshed_at, end)) = &mut self.running {
            (*refreshed_at, *end) = (*refreshed_at + cycles, *end + cycles);
        }
    }

    fn settings(&mut self) -> [&mut Setting; 3] {
        [&mut self.prescaler, &mut self.reload, &mut self.window]
    }

    fn cycles(&self, periods: u64, clocks: &Clocks) -> u64 {
        clocks.cycles(periods, self.lsi_hz).unwrap_or(u64::MAX / 2)
    }

    /// Takes over what has arrived.
    fn settle(&mut self, cycle: u64) {
        let Some((refreshed_at, end)) = self.running else {
            return;
        };
        let before = divider(self.prescaler.used);
        for setting in [&mut self.prescaler, &mut self.reload, &mut self.window] {
            if setting.arrives.is_some_and(|arrives| arrives <= cycle) {
                setting.arrives = None;
                setting.used = self.registers.value(setting.value);
                self.registers.set_value(setting.busy, 0);
            }
        }
        let after = divider(self.prescaler.used);
        if after != before && end > cycle {
            self.running = Some((refreshed_at, cycle + (end - cycle) * after / before));
        }
    }

    fn write_key(&mut self, key: u32, context: &mut Context<'_>) {
        self.unlocked = key == UNLOCK;
        match key {
            START if self.running.is_none() => self.start(context),
            // A second start is a refresh: RM0440 has no other effect of it.
            START | REFRESH => self.refresh(context),
            UNLOCK => {}
            _ => context.findings.add(format!(
                "IWDG_KR: {key:#06x} is no key, and locks the registers"
            )),
        }
    }

    fn start(&mut self, context: &mut Context<'_>) {
        let arrives = context.cycle + self.cycles(WRITE_PERIODS, context.clocks);
        for setting in self.settings() {
            setting.arrives = setting.arrives.map(|_| arrives);
        }
        self.count_again(context);
    }

    fn refresh(&mut self, context: &mut Context<'_>) {
        let Some((refreshed_at, _)) = self.running else {
            return;
        };
        let open = u64::from(self.reload.used.saturating_sub(self.window.used));
        let closed = self.cycles(open * divider(self.prescaler.used), context.clocks);
        if context.cycle < refreshed_at + closed {
            context
                .findings
                .add("IWDG_KR: the watchdog is fed before its window opens");
            self.running = Some((refreshed_at, context.cycle));
            return;
        }
        self.count_again(context);
    }

    fn count_again(&mut self, context: &mut Context<'_>) {
        let periods = u64::from(self.reload.used + 1) * divider(self.prescaler.used);
        let end = context.cycle + self.cycles(periods, context.clocks);
        self.running = Some((context.cycle, end));
    }

    fn write_setting(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        let arrives = context.cycle + self.cycles(WRITE_PERIODS, context.clocks);
        let unlocked = self.unlocked;
        let Some(setting) = self.settings().into_iter().find(|s| s.offset == offset) else {
            return;
        };
        let busy = setting.arrives.is_some();
        if !unlocked || busy {
            let why = if busy {
                "before the last write has arrived"
            } else {
                "without its key in IWDG_KR"
            };
            let text = format!("IWDG_{} is written {why}", setting.name);
            context.findings.add(text);
            return;
        }
        setting.arrives = Some(arrives);
        let flag = setting.busy;
        self.registers.set(offset, value);
        self.registers.set_value(flag, 1);
        // A write of WINR refreshes, says ST's own driver (HAL_IWDG_Init).
        if offset == self.window.offset && self.running.is_some() {
            self.count_again(context);
        }
    }
}

/// Periods of LSI in a count: RM0440, IWDG_PR.
fn divider(prescaler: u32) -> u64 {
    4 << prescaler.min(6)
}

impl Device for Iwdg {
    fn reset(&mut self) {
        self.registers.reset();
        self.unlocked = false;
        self.running = None;
        self.refreshed = false;
        for setting in [&mut self.prescaler, &mut self.reload, &mut self.window] {
            setting.used = self.registers.value(setting.value);
            setting.arrives = None;
        }
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        self.settle(context.cycle);
        if offset == self.key {
            return 0;
        }
        self.registers.get(offset)
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        self.settle(context.cycle);
        if offset == self.key {
            self.refreshed |= value == REFRESH;
            self.write_key(value, context);
        } else if offset != self.status {
            self.write_setting(offset, value, context);
        }
    }

    fn next_event(&self) -> Option<u64> {
        let settings = [&self.prescaler, &self.reload, &self.window];
        let end = self.expires_at()?;
        let arrivals = settings.iter().filter_map(|setting| setting.arrives);
        arrivals.chain([end]).min()
    }

    fn advance(&mut self, context: &mut Context<'_>) {
        self.settle(context.cycle);
    }
}
