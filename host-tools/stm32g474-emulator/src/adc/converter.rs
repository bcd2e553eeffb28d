//! One converter: from deep power-down over regulator, calibration and enable to its conversions.

mod sequence;

pub use sequence::Group;

use super::clock::{ConverterClock, LIMIT_HZ};
use super::inputs::AnalogueInputs;
use super::places::AdcPlaces;
use super::rules::{Busy, Rules};
use crate::device::{Context, FieldPlace, RegisterFile};
use crate::facts::Block;
use sequence::RunningSequence;

/// What a converter sees of its group and of the board.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// The group's clock.
    pub clock: ConverterClock,
    /// More than one converter of the group is switched on.
    pub several: bool,
    /// The chip's own voltage is switched on.
    pub reference: bool,
    /// What the board gives.
    pub inputs: &'a dyn AnalogueInputs,
}

/// A converter.
#[derive(Clone, Debug)]
pub struct Converter {
    /// What the registers keep.
    pub(super) file: RegisterFile,
    pub(super) places: AdcPlaces,
    rules: Rules,
    /// The cycle in which the regulator was switched on.
    pub(super) regulator: Option<u64>,
    /// The cycle in which the calibration ends.
    pub(super) calibration: Option<u64>,
    /// The cycle in which the last calibration ended.
    pub(super) calibrated_at: Option<u64>,
    /// For inputs against ground, and for differential ones.
    pub(super) calibrated: [bool; 2],
    /// The cycle in which the converter is ready.
    pub(super) ready: Option<u64>,
    /// Regular and injected.
    pub(super) runs: [Option<RunningSequence>; 2],
}

impl Converter {
    /// As after a reset.
    ///
    /// # Panics
    /// If the block is none of a converter.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        let file = RegisterFile::new(block);
        Self {
            places: AdcPlaces::new(&file),
            rules: Rules::new(&file),
            file,
            regulator: None,
            calibration: None,
            calibrated_at: None,
            calibrated: [false; 2],
            ready: None,
            runs: [None; 2],
        }
    }

    /// As after a reset: the calibration is lost.
    pub fn reset(&mut self) {
        self.file.reset();
        self.power_down();
        self.regulator = None;
    }

    /// `ADC1`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.file.block().name
    }

    /// Whether it is switched on or calibrates: the group's clock must not change.
    #[must_use]
    pub fn is_enabled(&self) -> bool {
        self.is(self.places.enabled) || self.is(self.places.calibrate)
    }

    /// Its interrupt's level.
    #[must_use]
    pub fn interrupt(&self) -> bool {
        self.flags() & self.file.get(self.places.interrupts) != 0
    }

    /// The flags (`ISR`).
    #[must_use]
    pub fn flags(&self) -> u32 {
        self.file.get(self.places.flags)
    }

    /// The next cycle in which something happens.
    #[must_use]
    pub fn next_event(&self) -> Option<u64> {
        let runs = self.runs.iter().flatten().map(|run| run.due);
        let others = self.calibration.into_iter().chain(self.ready);
        runs.chain(others).filter(|due| *due < u64::MAX).min()
    }

    /// Does what is due.
    pub fn advance(&mut self, around: &Surroundings<'_>, context: &mut Context<'_>) {
        let now = context.cycle;
        if let Some(end) = self.calibration.take_if(|end| *end <= now) {
            let kind = usize::from(self.is(self.places.calibrate_differential));
            if let Some(calibrated) = self.calibrated.get_mut(kind) {
                *calibrated = true;
            }
            self.calibrated_at = Some(end);
            self.file.set_value(self.places.calibrate, 0);
        }
        if self.ready.take_if(|at| *at <= now).is_some() {
            self.file.set_value(self.places.ready, 1);
        }
        for group in Group::BOTH {
            self.advance_run(group, around, context);
        }
    }

    /// The input that a rank of the injected sequence, 0 to 3, converts.
    #[must_use]
    pub fn injected_input(&self, rank: usize) -> Option<u8> {
        let [_, injected] = &self.places.sequence;
        u8::try_from(self.file.value(*injected.get(rank)?)).ok()
    }

    /// The code of a rank of the injected sequence, 0 to 3.
    #[must_use]
    pub fn injected_code(&self, rank: usize) -> Option<u32> {
        Some(self.file.get(*self.places.injected_data.get(rank)?))
    }

    /// The value of a register, with what reading it does.
    pub fn read(&mut self, offset: u32) -> u32 {
        let value = self.file.get(offset);
        let [regular, injected] = self.places.end_of_conversion;
        if offset == self.places.data {
            self.file.set_value(regular, 0);
        } else if self.places.injected_data.contains(&offset) {
            self.file.set_value(injected, 0);
        }
        value
    }

    /// Writes a register.
    pub fn write(
        &mut self,
        offset: u32,
        value: u32,
        around: &Surroundings<'_>,
        context: &mut Context<'_>,
    ) {
        let busy = self.busy();
        self.rules.check(&self.file, (offset, value), busy, context);
        if offset == self.places.flags {
            // Ones clear flags.
            self.file.set(offset, self.flags() & !value);
        } else if offset == self.places.control {
            self.control(value, around, context);
        } else {
            let queue = self.places.queue_off;
            if offset == queue.offset && queue.extract(value) != self.file.value(queue) {
                // As ST's `stm32g4xx_ll_adc.h` says: a change of the queue's mode clears JSQR.
                self.file.set(self.places.injected_trigger.offset, 0);
            }
            self.file.set(offset, value);
        }
    }

    pub(super) fn is(&self, place: FieldPlace) -> bool {
        self.file.is_set(place)
    }

    pub(super) fn report(&self, context: &mut Context<'_>, text: &str) {
        context.findings.add(format!("{}{text}", self.name()));
    }

    pub(super) fn check_unmodelled(&self, context: &mut Context<'_>) {
        self.rules.check_unmodelled(&self.file, context);
    }

    /// The clock must stand neither still nor above its limit.
    pub(super) fn check_clock(&self, around: &Surroundings<'_>, context: &mut Context<'_>) {
        let (one, more) = LIMIT_HZ;
        let limit = if around.several { more } else { one };
        if around.clock.is_off() {
            self.report(
                context,
                " is to work, but its clock (ADCSEL of RCC_CCIPR) is none",
            );
        } else if around.clock.hz() > limit {
            let text = format!(
                " runs at {} Hz, above its limit of {limit} Hz",
                around.clock.hz()
            );
            self.report(context, &text);
        }
    }

    pub(super) fn busy(&self) -> Busy {
        let [regular, injected] = self.places.start;
        Busy {
            regular: self.is(regular),
            injected: self.is(injected),
            enabled: self.is_enabled(),
            queue: !self.is(self.places.queue_off),
        }
    }

    /// `CR`: some bits are set by the program and cleared by the converter, the others keep what is written.
    fn control(&mut self, value: u32, around: &Surroundings<'_>, context: &mut Context<'_>) {
        let places = self.places.clone();
        let set = |place: FieldPlace| value & place.mask != 0;
        self.power(set(places.deep_power_down), set(places.regulator), context);
        let differential = u32::from(set(places.calibrate_differential));
        self.file
            .set_value(places.calibrate_differential, differential);
        if set(places.calibrate) && !self.is(places.calibrate) {
            self.calibrate(around, context);
        }
        if set(places.disable) {
            self.disable(context);
        } else if set(places.enabled) && !self.is(places.enabled) {
            self.enable(around, context);
        }
        for group in Group::BOTH {
            if set(group.select(places.stop)) {
                self.stop(group);
            } else if set(group.select(places.start)) && !self.is(group.select(places.start)) {
                self.start(group, around, context);
            }
        }
    }

    fn stop(&mut self, group: Group) {
        self.file.set_value(group.select(self.places.start), 0);
        self.end_run(group);
    }

    /// `ADSTART`, `JADSTART`.
    fn start(&mut self, group: Group, around: &Surroundings<'_>, context: &mut Context<'_>) {
        let name = group.start_name();
        if !self.is(self.places.enabled) {
            return self.report(context, &format!("_CR: {name} is set while ADEN is clear"));
        }
        if self.ready.is_some() {
            self.report(context, &format!("_CR: {name} is set before ADRDY"));
        }
        self.check_unmodelled(context);
        self.file.set_value(group.select(self.places.start), 1);
        if self.file.value(group.select(self.places.edge)) == 0 {
            self.begin(group, context.cycle, around, context);
        } else if group == Group::Regular {
            self.report(
                context,
                "_CFGR: EXTEN asks for a trigger of regular conversions, which the emulator does not model",
            );
        }
    }
}
