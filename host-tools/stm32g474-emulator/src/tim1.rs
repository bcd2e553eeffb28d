//! TIM1: the pulses of the power stage, its breaks, and the trigger of the converters.

mod breaks;
mod lock;
mod outputs;
#[cfg(test)]
mod tests;

pub use outputs::{CHANNELS, PowerOutputs};

use crate::device::{Context, Device, FieldPlace, places};
use crate::facts::Block;
use crate::timer::registers::Timer;
use breaks::BreakInput;
use lock::Lock;
use outputs::OutputPlaces;

/// `MMS2`: an update is the second trigger.
const TRIGGER_IS_UPDATE: u32 = 2;

/// Compare channels with a flag of their own in the same register as the others.
const COMPARE_CHANNELS: u32 = 4;

/// The advanced timer.
#[derive(Clone, Debug)]
pub struct Tim1 {
    timer: Timer,
    lock: Lock,
    breaks: [BreakInput; 2],
    outputs: OutputPlaces,
    places: Places,
    /// The chip asks for a break: see [`Self::set_system_break`].
    system: bool,
    trigger: Option<u64>,
}

places! {
    /// Registers and fields.
    #[derive(Clone, Copy, Debug)]
    struct Places {
        events: EGR,
        switch: BDTR.MOE,
        switch_by_update: BDTR.AOE,
        lock: BDTR.LOCK,
        break_enabled: BDTR.BKE0,
        second_enabled: BDTR.BKE1,
        system_flag: SR.SBIF,
        break_interrupt: DIER.BIE,
        trigger: CR2.MMS2,
    }
    |file| {
        complementary: [FieldPlace; 4] =
            [0, 1, 2, 3].map(|channel| file.field("CCER", &format!("CCNE{channel}"))),
        driven: [FieldPlace; 2] = ["OSSI", "OSSR"].map(|name| file.field("BDTR", name)),
        preloads: [FieldPlace; 4] = [
            ("CR1", "ARPE"), ("CCMR1", "OCPE0"), ("CCMR1", "OCPE1"), ("CCMR2", "OCPE0"),
        ].map(|(register, name)| file.field(register, name)),
    }
}

impl Tim1 {
    /// As after a reset.
    ///
    /// # Panics
    /// If the block is none of an advanced timer.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        let timer = Timer::new(block, COMPARE_CHANNELS, |clocks| clocks.timers2);
        let file = &timer.file;
        Self {
            lock: Lock::new(file),
            breaks: BreakInput::pair(file),
            outputs: OutputPlaces::new(file),
            places: Places::new(file),
            timer,
            system: false,
            trigger: None,
        }
    }

    /// The level of the pin that is routed to `BKIN` (0) or `BKIN2` (1); low where none is.
    pub fn set_break_input(&mut self, index: usize, level: bool, context: &mut Context<'_>) {
        self.advance(context);
        if let Some(input) = self.breaks.get_mut(index) {
            input.set_pin(level);
        }
        self.apply_breaks(context.cycle);
    }

    /// Whether the chip asks for a break: a failed clock, a lockup, too low a supply, or wrong bits in the flash.
    pub fn set_system_break(&mut self, active: bool, context: &mut Context<'_>) {
        if self.system == active {
            return;
        }
        self.advance(context);
        self.system = active;
        self.apply_breaks(context.cycle);
    }

    /// The cycle of a trigger of the converters since the last call.
    pub fn take_trigger(&mut self) -> Option<u64> {
        self.trigger.take()
    }

    /// What the pins carry, at the moment of the last call with a context.
    #[must_use]
    pub fn outputs(&self) -> PowerOutputs {
        let counter = &self.timer.counter;
        let compare = [0, 1, 2].map(|channel| self.timer.compare_value(channel));
        self.outputs
            .outputs(&self.timer.file, counter.runs(), counter.top(), compare)
    }

    /// Whether top and compare values wait for the next update: else a pulse that has begun may change its length.
    #[must_use]
    pub fn preloads(&self) -> bool {
        let file = &self.timer.file;
        self.places.preloads.iter().all(|place| file.is_set(*place))
    }

    /// The level of `LOCK`.
    #[must_use]
    pub fn lock_level(&self) -> u32 {
        self.timer.file.value(self.places.lock)
    }

    /// The flags of both breaks.
    #[must_use]
    pub fn break_flags(&self) -> [bool; 2] {
        let flag = |input: &BreakInput| self.timer.file.is_set(input.flag);
        let [first, second] = &self.breaks;
        [flag(first), flag(second)]
    }

    /// Its interrupts and their levels.
    #[must_use]
    pub fn interrupts(&self) -> [(&'static str, bool); 3] {
        let file = &self.timer.file;
        let [first, second] = &self.breaks;
        let flags = [first.flag, second.flag, self.places.system_flag];
        let broken = flags.into_iter().any(|flag| file.is_set(flag));
        [
            (
                "TIM1_BRK_TIM15",
                broken && file.is_set(self.places.break_interrupt),
            ),
            ("TIM1_UP_TIM16", self.timer.update_interrupt()),
            ("TIM1_CC", self.timer.compare_interrupt()),
        ]
    }

    /// Cycles from an update to the next, with what the registers say.
    #[must_use]
    pub fn update_period_cycles(&self) -> u64 {
        self.timer.time.cycles(self.timer.update_period())
    }

    /// Lets through what the filters have held back long enough, and breaks where a break is asked for.
    fn apply_breaks(&mut self, cycle: u64) {
        for input in &mut self.breaks {
            input.update(&self.timer.file, &self.timer.time, cycle);
            if input.is_active(&self.timer.file) {
                self.timer.file.set_value(input.flag, 1);
                self.timer.file.set_value(self.places.switch, 0);
            }
        }
        if self.system && self.timer.file.is_set(self.places.break_enabled) {
            self.timer.file.set_value(self.places.system_flag, 1);
            self.timer.file.set_value(self.places.switch, 0);
        }
    }

    /// What an update does beyond the counter.
    fn take_update(&mut self) {
        let Some(cycle) = self.timer.take_update() else {
            return;
        };
        let file = &mut self.timer.file;
        if file.value(self.places.trigger) == TRIGGER_IS_UPDATE {
            self.trigger = Some(cycle);
        }
        // A break that lasts takes it back.
        if file.is_set(self.places.switch_by_update) {
            file.set_value(self.places.switch, 1);
        }
    }

    /// The manual wants the second break only where the timer drives its pins when they are off.
    fn check_second_break(&self, context: &mut Context<'_>) {
        let (file, places) = (&self.timer.file, &self.places);
        let driven = places.driven.iter().all(|place| file.is_set(*place));
        if file.is_set(places.second_enabled) && !driven {
            let text = "TIM1_BDTR: BK2E is set without OSSI and OSSR";
            context.findings.add(text);
        }
    }

    /// Only complementary outputs have a dead time, and neither is modelled.
    fn check_complementary(&self, offset: u32, context: &mut Context<'_>) {
        let (file, fields) = (&self.timer.file, &self.places.complementary);
        if fields
            .iter()
            .any(|one| one.offset == offset && file.is_set(*one))
        {
            let text = "TIM1_CCER: a complementary output is enabled, which is not modelled";
            context.findings.add(text);
        }
    }

    /// Breaks that the program asks for.
    fn generate_breaks(&mut self, value: u32) {
        for input in &self.breaks {
            if input.generate.extract(value) != 0 {
                self.timer.file.set_value(input.flag, 1);
                self.timer.file.set_value(self.places.switch, 0);
            }
        }
    }
}

impl Device for Tim1 {
    fn reset(&mut self) {
        self.timer.reset();
        self.lock.reset();
        self.trigger = None;
        for input in &mut self.breaks {
            input.reset(&self.timer.file);
        }
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        self.advance(context);
        self.timer.read(offset)
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        self.advance(context);
        let value = self.lock.pass(&self.timer.file, offset, value, context);
        self.timer.write(offset, value, context);
        if offset == self.places.events {
            self.generate_breaks(value);
        }
        if offset == self.places.switch.offset {
            self.check_second_break(context);
        }
        self.check_complementary(offset, context);
        self.take_update();
        self.apply_breaks(context.cycle);
    }

    fn next_event(&self) -> Option<u64> {
        let breaks = self.breaks.iter().filter_map(BreakInput::next_event);
        breaks.chain(self.timer.next_event()).min()
    }

    fn advance(&mut self, context: &mut Context<'_>) {
        self.timer.advance(context);
        self.take_update();
        self.apply_breaks(context.cycle);
    }
}
