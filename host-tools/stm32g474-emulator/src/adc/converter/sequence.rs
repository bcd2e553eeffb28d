//! Sequences of conversions: when they end, and what they give.

use super::{Converter, Surroundings};
use crate::adc::inputs::{shortest_sampling, sum_of};
use crate::device::Context;

/// Half periods of sampling by the value of `SMPx`.
const SAMPLING: [u64; 8] = [5, 13, 25, 49, 95, 185, 495, 1281];
/// Half periods that `SMPPLUS` adds to the shortest.
const LONGER: u64 = 2;
/// Half periods of converting 12 bits; each two bits less take two periods less.
const CONVERTING: u64 = 25;

/// Rising edges start an injected sequence at these values of `JEXTEN`.
const RISING: [u32; 2] = [1, 3];

/// The two kinds of conversions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Regular.
    Regular,
    /// Injected.
    Injected,
}

impl Group {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Regular, Self::Injected];

    /// The one of two that belongs to it.
    pub fn select<T>(self, [regular, injected]: [T; 2]) -> T {
        match self {
            Self::Regular => regular,
            Self::Injected => injected,
        }
    }

    /// The bit that starts it.
    pub fn start_name(self) -> &'static str {
        self.select(["ADSTART", "JADSTART"])
    }
}

/// A sequence that runs.
#[derive(Clone, Copy, Debug)]
pub struct RunningSequence {
    /// The cycle in which it began.
    begin: u64,
    /// Half periods from there to the end of the present code.
    halves: u64,
    /// The cycle in which the present code is done.
    pub due: u64,
    /// The code's place in the sequence.
    rank: u32,
}

impl Converter {
    /// Begins a sequence in a cycle.
    pub(in crate::adc) fn begin(
        &mut self,
        group: Group,
        cycle: u64,
        around: &Surroundings<'_>,
        context: &mut Context<'_>,
    ) {
        self.check_clock(around, context);
        let run = RunningSequence {
            begin: cycle,
            halves: 0,
            due: cycle,
            rank: 0,
        };
        self.begin_code(group, run, around, context);
    }

    /// A trigger with a number comes: an injected sequence begins if it waits for it.
    pub(in crate::adc) fn trigger(
        &mut self,
        number: u32,
        cycle: u64,
        around: &Surroundings<'_>,
        context: &mut Context<'_>,
    ) {
        let group = Group::Injected;
        let waits = self.is(group.select(self.places.start))
            && self.file.value(self.places.injected_trigger) == number
            && RISING.contains(&self.file.value(group.select(self.places.edge)));
        if !waits {
            return;
        }
        if group.select(self.runs).is_some() {
            return self.report(
                context,
                ": the injected sequence is triggered while it still runs",
            );
        }
        self.begin(group, cycle, around, context);
    }

    /// Forgets a sequence.
    pub(in crate::adc) fn end_run(&mut self, group: Group) {
        self.set_run(group, None);
    }

    /// Does what is due of a sequence.
    pub(in crate::adc) fn advance_run(
        &mut self,
        group: Group,
        around: &Surroundings<'_>,
        context: &mut Context<'_>,
    ) {
        while let Some(run) = group
            .select(self.runs)
            .filter(|run| run.due <= context.cycle)
        {
            self.give_code(group, run.rank, around, context);
            if run.rank < self.file.value(group.select(self.places.length)) {
                let rank = run.rank + 1;
                self.begin_code(group, RunningSequence { rank, ..run }, around, context);
            } else {
                self.end_sequence(group, run.due, around, context);
            }
        }
    }

    /// Half periods from the begin of a sequence to its end.
    #[must_use]
    pub fn sequence_halves(&self, group: Group) -> u64 {
        let last = self.file.value(group.select(self.places.length));
        let codes = (0..=last).map(|rank| self.code_halves(group, self.input(group, rank)));
        codes.sum()
    }

    fn begin_code(
        &mut self,
        group: Group,
        run: RunningSequence,
        around: &Surroundings<'_>,
        context: &mut Context<'_>,
    ) {
        let input = self.input(group, run.rank);
        self.check_input(input, around, context);
        let halves = run.halves + self.code_halves(group, input);
        let cycles = around.clock.cycles(halves);
        let due = cycles.map_or(u64::MAX, |cycles| run.begin + cycles);
        self.set_run(group, Some(RunningSequence { halves, due, ..run }));
    }

    fn end_sequence(
        &mut self,
        group: Group,
        cycle: u64,
        around: &Surroundings<'_>,
        context: &mut Context<'_>,
    ) {
        self.file
            .set_value(group.select(self.places.end_of_sequence), 1);
        self.end_run(group);
        let by_software = self.file.value(group.select(self.places.edge)) == 0;
        if group == Group::Regular && self.is(self.places.continuous) {
            self.begin(group, cycle, around, context);
        } else if by_software {
            self.file.set_value(group.select(self.places.start), 0);
        }
    }

    /// The code of a rank is done: stores it, and says so.
    fn give_code(
        &mut self,
        group: Group,
        rank: u32,
        around: &Surroundings<'_>,
        context: &mut Context<'_>,
    ) {
        let code = self.code(group, self.input(group, rank), around, context);
        let end = group.select(self.places.end_of_conversion);
        let place = usize::try_from(rank).unwrap_or_default();
        match group {
            Group::Injected => {
                if let Some(offset) = self.places.injected_data.get(place) {
                    self.file.set(*offset, code);
                }
            }
            Group::Regular if self.is(end) => {
                self.file.set_value(self.places.overrun, 1);
                if self.is(self.places.overwrite) {
                    self.file.set(self.places.data, code);
                }
            }
            Group::Regular => self.file.set(self.places.data, code),
        }
        self.file.set_value(end, 1);
    }

    /// The sum of an input's conversions, shifted as the oversampling says.
    fn code(
        &self,
        group: Group,
        input: u8,
        around: &Surroundings<'_>,
        context: &mut Context<'_>,
    ) -> u32 {
        let name = self.name();
        let Some(sum) = around.inputs.sum16(name, input) else {
            let text = format!(
                " converts input {input}, whose pin is not in analogue mode or not connected"
            );
            self.report(context, &text);
            return 0;
        };
        let narrower = 2 * self.file.value(self.places.resolution);
        let total = sum_of(sum, self.conversions(group), narrower);
        let shift = if self.is(group.select(self.places.oversampling)) {
            self.file.value(self.places.shift)
        } else {
            0
        };
        // Rounded to the nearest.
        let rounded = (total + ((1 << shift) >> 1)) >> shift;
        rounded & u32::from(u16::MAX)
    }

    /// An input has to be calibrated for, and sampled long enough for its source.
    fn check_input(&self, input: u8, around: &Surroundings<'_>, context: &mut Context<'_>) {
        let differential = self.places.is_differential(&self.file, input);
        let [single, both] = self.calibrated;
        if !(if differential { both } else { single }) {
            self.report(
                context,
                " converts without a calibration since its power-up",
            );
        }
        if around.inputs.is_reference(self.name(), input) && !around.reference {
            self.report(
                context,
                " converts VREFINT, which VREFEN has not switched on",
            );
        }
        let ohms = around.inputs.source_ohms(self.name(), input);
        let sampled = around.clock.nanoseconds(self.sampling_halves(input));
        let needed = shortest_sampling(ohms);
        if needed.is_none_or(|needed| sampled < needed) && !around.clock.is_off() {
            let text = format!(
                " samples input {input} for {sampled} ns, too short for a source of {ohms} ohms"
            );
            self.report(context, &text);
        }
    }

    /// Conversions in a code.
    fn conversions(&self, group: Group) -> u32 {
        if self.is(group.select(self.places.oversampling)) {
            2 << self.file.value(self.places.ratio)
        } else {
            1
        }
    }

    fn code_halves(&self, group: Group, input: u8) -> u64 {
        let fewer = 4 * u64::from(self.file.value(self.places.resolution));
        let conversion = self.sampling_halves(input) + CONVERTING - fewer;
        conversion * u64::from(self.conversions(group))
    }

    fn sampling_halves(&self, input: u8) -> u64 {
        let value = self.places.sampling(input).map(|at| self.file.value(at));
        let value = usize::try_from(value.unwrap_or_default()).unwrap_or_default();
        let halves = SAMPLING.get(value).copied().unwrap_or_default();
        let longer = value == 0 && self.is(self.places.longer);
        halves + if longer { LONGER } else { 0 }
    }

    /// The input of a rank.
    fn input(&self, group: Group, rank: u32) -> u8 {
        let [regular, injected] = &self.places.sequence;
        let sequence = group.select([regular, injected]);
        let place = usize::try_from(rank).unwrap_or_default();
        let value = sequence.get(place).map(|place| self.file.value(*place));
        u8::try_from(value.unwrap_or_default()).unwrap_or_default()
    }

    fn set_run(&mut self, group: Group, run: Option<RunningSequence>) {
        let [regular, injected] = &mut self.runs;
        *group.select([regular, injected]) = run;
    }
}
