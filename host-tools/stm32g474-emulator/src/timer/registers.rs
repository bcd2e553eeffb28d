//! The registers around a counter that every timer has: control, prescaler, top, compare values, flags, events.

use super::counter::TimerCounter;
use super::places::{Channel, TimerPlaces};
use super::timebase::Timebase;
use crate::clocks::Clocks;
use crate::device::{Context, RegisterFile};
use crate::facts::Block;

/// A timer that counts its clock: counter, preloads, update and compare flags.
#[derive(Clone, Debug)]
pub struct Timer {
    /// What the registers keep.
    pub file: RegisterFile,
    /// The counter.
    pub counter: TimerCounter,
    /// Its clock.
    pub time: Timebase,
    places: TimerPlaces,
    channels: Vec<Channel>,
    /// Halves before the one that ends with an update.
    repetitions: u32,
    /// Compare flags are known up to this tick.
    known: u64,
    /// The cycle of the last update that nobody has asked for yet.
    update: Option<u64>,
    /// Which clock the timer has.
    clock: fn(&Clocks) -> u32,
}

impl Timer {
    /// A timer with so many channels, as it is after a reset.
    ///
    /// # Panics
    /// If the block is none of a timer.
    #[must_use]
    pub fn new(block: &'static Block, channels: u32, clock: fn(&Clocks) -> u32) -> Self {
        let file = RegisterFile::new(block);
        let mut timer = Self {
            places: TimerPlaces::new(&file),
            channels: (0..channels)
                .map(|index| Channel::new(&file, index))
                .collect(),
            file,
            counter: TimerCounter::default(),
            time: Timebase::default(),
            repetitions: 0,
            known: 0,
            update: None,
            clock,
        };
        timer.reset();
        timer
    }

    /// As after a reset; the clock counts on.
    pub fn reset(&mut self) {
        self.file.reset();
        self.counter = TimerCounter::default();
        self.repetitions = 0;
        self.update = None;
        self.take_preloads();
    }

    /// Lets happen what is due, and takes the frequencies of the moment.
    pub fn advance(&mut self, context: &Context<'_>) {
        let now = self.time.ticks(context.cycle);
        while let Some(end) = self.counter.end().filter(|end| *end <= now) {
            self.compare(end.saturating_sub(1));
            self.counter.turn();
            self.end_half(end);
        }
        self.compare(now);
        let hz = (self.clock)(context.clocks);
        self.time.set(context.cycle, hz, context.clocks.hclk);
    }

    /// The value of a register, at the moment of the last [`Self::advance`].
    #[must_use]
    pub fn read(&self, offset: u32) -> u32 {
        let (places, word) = (&self.places, self.file.get(offset));
        if offset == places.count {
            let flag = self.file.is_set(places.flag_in_count) && self.is_updated();
            let count = self.counter.count(self.known);
            return if flag {
                count | places.flag_copy.mask
            } else {
                count
            };
        }
        if offset == places.control {
            return places.down.insert(word, u32::from(self.counter.down));
        }
        if offset == places.events { 0 } else { word }
    }

    /// Writes a register, at the moment of the last [`Self::advance`].
    pub fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        let places = self.places;
        let now = self.known;
        if offset == places.status {
            // Zeros clear flags, ones leave them.
            self.file.set(offset, self.file.get(offset) & value);
            return;
        }
        if offset == places.events {
            return self.generate(value, context);
        }
        if offset == places.control {
            self.check_mode(value, context);
        }
        self.file.set(offset, value);
        if offset == places.control {
            self.control(now);
        } else if offset == places.count {
            self.counter.set_count(value & !places.flag_copy.mask, now);
        }
        if !self.file.is_set(places.preloaded) {
            self.take_top();
        }
        self.take_compare_values(false);
    }

    /// The next cycle in which the timer updates, or raises a compare interrupt.
    #[must_use]
    pub fn next_event(&self) -> Option<u64> {
        let wanted = |c: &&Channel| self.file.is_set(c.interrupt) && !self.file.is_set(c.flag);
        let compare = self.channels.iter().filter(wanted);
        let compare = compare.filter_map(|channel| self.next_match(channel));
        let tick = self.next_update().into_iter().chain(compare).min();
        self.time.cycle(tick?)
    }

    /// Whether the update flag is set.
    #[must_use]
    pub fn is_updated(&self) -> bool {
        self.file.is_set(self.places.update_flag)
    }

    /// The level of the update interrupt.
    #[must_use]
    pub fn update_interrupt(&self) -> bool {
        self.is_updated() && self.file.is_set(self.places.update_interrupt)
    }

    /// The level of the channels' interrupt.
    #[must_use]
    pub fn compare_interrupt(&self) -> bool {
        let raised = |c: &Channel| self.file.is_set(c.flag) && self.file.is_set(c.interrupt);
        self.channels.iter().any(raised)
    }

    /// The compare value in use of a channel, from 0.
    #[must_use]
    pub fn compare_value(&self, channel: usize) -> u32 {
        let channel = self.channels.get(channel);
        channel.map(|channel| channel.value).unwrap_or_default()
    }

    /// Ticks from an update to the next, with what the registers say.
    #[must_use]
    pub fn update_period(&self) -> u64 {
        let mut counter = self.counter;
        counter.prescaler = self.file.get(self.places.prescaler);
        counter.centre = self.file.is_set(self.places.centre);
        counter.set_top(self.file.get(self.places.top), self.known);
        counter.half() * (u64::from(self.repetitions()) + 1)
    }

    /// The cycle of an update since the last call.
    pub fn take_update(&mut self) -> Option<u64> {
        self.update.take()
    }

    /// The mode of alignment must not change while it counts.
    fn check_mode(&self, value: u32, context: &mut Context<'_>) {
        let centre = self.places.centre;
        let changed = centre.extract(value) != self.file.value(centre);
        if changed && self.counter.runs() && self.file.is_set(self.places.enabled) {
            let name = self.file.block().name;
            let text = format!("{name}_CR1: CMS is changed while the counter runs");
            context.findings.add(text);
        }
    }

    fn control(&mut self, now: u64) {
        let places = self.places;
        self.counter.centre = self.file.is_set(places.centre);
        if !self.counter.centre {
            let count = self.counter.count(now);
            self.counter.down = self.file.is_set(places.down);
            self.counter.set_count(count, now);
        }
        self.counter.run(self.file.is_set(places.enabled), now);
    }

    /// Events that the program asks for.
    fn generate(&mut self, value: u32, context: &Context<'_>) {
        let places = self.places;
        for index in 0..self.channels.len() {
            let flag = self.channels.get(index).map(|channel| channel.flag);
            // An event has its flag's place.
            if let Some(flag) = flag.filter(|flag| flag.mask & value != 0) {
                self.file.set_value(flag, 1);
            }
        }
        if places.generate_update.extract(value) != 0 {
            self.counter.restart(self.known);
            self.repetitions = self.repetitions();
            let flag = !self.file.is_set(places.counter_only);
            self.update(self.known, context.cycle, flag);
        }
    }

    /// A half has ended: counts it, and updates if it was the last.
    fn end_half(&mut self, tick: u64) {
        let Some(left) = self.repetitions.checked_sub(1) else {
            self.repetitions = self.repetitions();
            let cycle = self.time.cycle(tick).unwrap_or_default();
            return self.update(tick, cycle, true);
        };
        self.repetitions = left;
    }

    fn update(&mut self, tick: u64, cycle: u64, flag: bool) {
        if self.file.is_set(self.places.no_updates) {
            return;
        }
        self.take_preloads();
        if flag {
            self.file.set_value(self.places.update_flag, 1);
        }
        self.update = Some(cycle);
        if self.file.is_set(self.places.one_pulse) {
            self.file.set_value(self.places.enabled, 0);
            self.counter.run(false, tick);
        }
    }

    fn take_preloads(&mut self) {
        let prescaler = self.file.get(self.places.prescaler);
        let top = self.file.get(self.places.top);
        self.counter.reload(prescaler, top);
        self.take_compare_values(true);
    }

    fn take_top(&mut self) {
        let top = self.file.get(self.places.top);
        self.counter.set_top(top, self.known);
    }

    /// At an update all of them; else those without a preload.
    fn take_compare_values(&mut self, all: bool) {
        for channel in &mut self.channels {
            if all || !self.file.is_set(channel.preloaded) {
                channel.value = self.file.get(channel.offset);
            }
        }
    }

    /// Sets the flags of the compare values that have come by, up to a tick.
    fn compare(&mut self, tick: u64) {
        for index in 0..self.channels.len() {
            let Some(channel) = self.channels.get(index).copied() else {
                continue;
            };
            let due = self.next_match(&channel).is_some_and(|at| at <= tick);
            if due && !self.file.is_set(channel.flag) {
                self.file.set_value(channel.flag, 1);
            }
        }
        self.known = self.known.max(tick);
    }

    fn next_match(&self, channel: &Channel) -> Option<u64> {
        // Centre-aligned mode 1 compares on the way down, 2 on the way up, 3 on both.
        let directions = match self.file.value(self.places.centre) {
            1 => (false, true),
            2 => (true, false),
            _ => (true, true),
        };
        self.counter
            .next_match(channel.value, self.known, directions)
    }

    fn next_update(&self) -> Option<u64> {
        if self.file.is_set(self.places.no_updates) {
            return None;
        }
        let more = u64::from(self.repetitions) * self.counter.half();
        Some(self.counter.end()? + more)
    }

    /// What `RCR` says.
    fn repetitions(&self) -> u32 {
        let offset = self.places.repetitions;
        offset
            .map(|offset| self.file.get(offset))
            .unwrap_or_default()
    }
}
