//! TIM2, TIM3 and TIM4 as counters of encoders.
//!
//! The tracks are not modelled edge by edge: the encoder's position moves, and the counter with it, as if that many edges
//! had come. The filters of the inputs are checked by nobody here; they delay by less than a tick.

use crate::device::{Context, Device, FieldPlace, RegisterFile, places};
use crate::facts::Block;

/// Counts every edge of both tracks (`SMS`), those of one track (1 and 2).
const BOTH_TRACKS: u32 = 3;
/// `CCxS`: the channel's own input.
const OWN_INPUT: u32 = 1;

/// A timer that counts the edges of an encoder.
#[derive(Clone, Debug)]
pub struct EncoderTimer {
    file: RegisterFile,
    places: Places,
    /// The encoder's position that has been counted up to.
    position: u32,
    /// It counts down.
    down: bool,
}

places! {
    /// Registers and fields.
    #[derive(Clone, Copy, Debug)]
    struct Places {
        control: CR1,
        status: SR,
        events: EGR,
        count: CNT,
        top: ARR,
        modes: CCMR1,
        enabled: CR1.CEN,
        down: CR1.DIR,
        counter: CNT.CNT,
        flag_in_count: CR1.UIFREMAP,
        flag_copy: CNT.UIFCPY,
        mode: SMCR.SMS,
        update: EGR.UG,
        update_flag: SR.UIF,
        update_interrupt: DIER.UIE,
        transition_error: SR.TERRIF,
    }
    |file| {
        inputs: [FieldPlace; 2] = ["CCS0", "CCS1"].map(|name| file.field("CCMR1", name)),
        channels: [FieldPlace; 2] = ["CCE0", "CCE1"].map(|name| file.field("CCER", name)),
        inverted: [FieldPlace; 2] = ["CCP0", "CCP1"].map(|name| file.field("CCER", name)),
    }
}

impl EncoderTimer {
    /// As after a reset.
    ///
    /// # Panics
    /// If the block is none of a timer with encoder inputs.
    #[must_use]
    pub fn new(block: &'static Block) -> Self {
        let file = RegisterFile::new(block);
        Self {
            places: Places::new(&file),
            file,
            position: 0,
            down: false,
        }
    }

    /// Where the encoder is, in edges of both tracks; it wraps. The counter follows if the timer is switched on, counts
    /// edges, and both tracks are routed to it.
    pub fn set_position(&mut self, counts: u32, routed: bool) {
        let moved = counts.wrapping_sub(self.position).cast_signed();
        self.position = counts;
        if moved != 0 && routed && self.counts() {
            let inverted = self.places.inverted.map(|place| self.file.is_set(place));
            let backwards = inverted[0] != inverted[1];
            self.move_by(if backwards { -moved } else { moved });
        }
    }

    /// Both tracks change at once, which is counted as nothing here.
    pub fn break_sequence(&mut self) {
        if self.counts() {
            self.file.set_value(self.places.transition_error, 1);
        }
    }

    /// Whether the timer counts the edges of both tracks.
    #[must_use]
    pub fn counts(&self) -> bool {
        let (places, file) = (&self.places, &self.file);
        file.is_set(places.enabled)
            && file.value(places.mode) == BOTH_TRACKS
            && places
                .inputs
                .iter()
                .all(|place| file.value(*place) == OWN_INPUT)
    }

    /// Its interrupt's level, on the line of the timer's own name.
    #[must_use]
    pub fn interrupt(&self) -> bool {
        self.file.is_set(self.places.update_flag) && self.file.is_set(self.places.update_interrupt)
    }

    fn move_by(&mut self, edges: i32) {
        let top = i64::from(self.file.get(self.places.top) & self.count_mask());
        let sum = i64::from(self.count()) + i64::from(edges);
        let wrapped = sum.rem_euclid(top + 1);
        self.down = edges < 0;
        self.set_count(u32::try_from(wrapped).unwrap_or_default());
        if wrapped != sum {
            self.file.set_value(self.places.update_flag, 1);
        }
    }

    fn count(&self) -> u32 {
        self.file.get(self.places.count) & self.count_mask()
    }

    fn set_count(&mut self, count: u32) {
        self.file.set(self.places.count, count & self.count_mask());
    }

    /// All bits of the counter: that of a timer of 32 bits lends its highest to the copy of the update flag.
    fn count_mask(&self) -> u32 {
        let (counter, copy) = (self.places.counter.mask, self.places.flag_copy.mask);
        match self.file.is_set(self.places.flag_in_count) {
            true => counter & !copy,
            false => counter,
        }
    }

    /// An input is chosen while its channel is off.
    fn check_inputs(&self, value: u32, context: &mut Context<'_>) {
        let places = self.places.inputs.into_iter().zip(self.places.channels);
        for (channel, (input, enabled)) in (1..).zip(places) {
            let changed = input.extract(value) != self.file.value(input);
            if changed && self.file.is_set(enabled) {
                let name = self.file.block().name;
                context.findings.add(format!(
                    "{name}_CCMR1: CC{channel}S is changed while CC{channel}E is set"
                ));
            }
        }
    }
}

impl Device for EncoderTimer {
    fn reset(&mut self) {
        self.file.reset();
        self.down = false;
    }

    fn read(&mut self, offset: u32, _context: &mut Context<'_>) -> u32 {
        let (places, word) = (self.places, self.file.get(offset));
        if offset == places.control {
            return places.down.insert(word, u32::from(self.down));
        }
        if offset == places.count && self.file.is_set(places.flag_in_count) {
            let flag = self.file.value(places.update_flag);
            return places.flag_copy.insert(self.count(), flag);
        }
        if offset == places.events { 0 } else { word }
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        let places = self.places;
        if offset == places.status {
            // Zeros clear flags, ones leave them.
            self.file.set(offset, self.file.get(offset) & value);
        } else if offset == places.events {
            if places.update.extract(value) != 0 {
                self.set_count(0);
                self.file.set_value(places.update_flag, 1);
            }
        } else if offset == places.count {
            self.set_count(value);
        } else {
            if offset == places.modes {
                self.check_inputs(value, context);
            }
            self.file.set(offset, value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::DeviceBench;

    /// As embassy-stm32 and the image set it up.
    fn bench(name: &str) -> DeviceBench<EncoderTimer> {
        let mut bench = DeviceBench::new(name, EncoderTimer::new);
        bench.set("CCMR1", &[("CCS0", 1), ("CCS1", 1)]);
        bench.set("CCER", &[("CCE0", 1), ("CCE1", 1)]);
        bench.set("SMCR", &[("SMS", 3)]);
        bench.write("ARR", 0xffff);
        bench.set("CR1", &[("CEN", 1)]);
        bench.set("CCMR1", &[("ICF0", 9), ("ICF1", 9)]);
        bench
    }

    #[test]
    fn it_follows_where_it_counts() {
        type Change = (&'static str, &'static str, u32);
        let cases: [(&[Change], bool, u32); 7] = [
            (&[], true, 10),
            (&[], false, 0),
            (&[("CR1", "CEN", 0)], true, 0),
            (&[("SMCR", "SMS", 0)], true, 0),
            (&[("CCER", "CCE1", 0), ("CCMR1", "CCS1", 2)], true, 0),
            (&[("CCER", "CCP0", 1)], true, 0xfff6),
            (&[("CCER", "CCP0", 1), ("CCER", "CCP1", 1)], true, 10),
        ];
        for name in ["TIM2", "TIM3", "TIM4"] {
            for (changes, routed, count) in cases {
                let mut bench = bench(name);
                for (register, field, value) in changes {
                    bench.set(register, &[(field, *value)]);
                }
                bench.device.set_position(10, routed);
                assert_eq!(bench.read("CNT"), count, "{name} {changes:?} {routed}");
                assert_eq!(bench.findings(), [""; 0]);
            }
        }
    }

    #[test]
    fn it_wraps_at_its_top_and_says_the_direction() {
        for (name, top) in [("TIM2", u32::MAX), ("TIM3", 0xffff), ("TIM2", 0xffff)] {
            let mut bench = bench(name);
            bench.write("ARR", top);
            bench.device.set_position(2u32.wrapping_sub(5), true);
            assert_eq!((bench.read("CNT"), bench.get("CR1", "DIR")), (top - 2, 1));
            bench.device.set_position(4, true);
            assert_eq!((bench.read("CNT"), bench.get("CR1", "DIR")), (4, 0));
        }
    }

    #[test]
    fn what_moved_before_does_not_count() {
        let mut bench = bench("TIM3");
        bench.set("CR1", &[("CEN", 0)]);
        bench.device.set_position(700, true);
        bench.set("CR1", &[("CEN", 1)]);
        bench.device.set_position(701, true);
        assert_eq!(bench.read("CNT"), 1);
    }

    #[test]
    fn inputs_are_chosen_while_their_channels_are_off() {
        let mut bench = bench("TIM3");
        bench.set("CCMR1", &[("CCS0", 2)]);
        assert_eq!(
            bench.findings(),
            ["TIM3_CCMR1: CC1S is changed while CC1E is set"]
        );
    }
}
