//! Where a timer's registers have what.

use crate::device::{FieldPlace, RegisterFile, places};
use crate::facts::Facts;

/// A channel that compares.
#[derive(Clone, Copy, Debug)]
pub struct Channel {
    /// `CCRx`.
    pub offset: u32,
    /// `CCxIF`.
    pub flag: FieldPlace,
    /// `CCxIE`.
    pub interrupt: FieldPlace,
    /// `OCxPE`.
    pub preloaded: FieldPlace,
    /// The value in use.
    pub value: u32,
}

places! {
    /// Registers and fields.
    #[derive(Clone, Copy, Debug)]
    pub struct TimerPlaces {
        control: CR1,
        status: SR,
        events: EGR,
        count: CNT,
        prescaler: PSC,
        top: ARR,
        enabled: CR1.CEN,
        no_updates: CR1.UDIS,
        counter_only: CR1.URS,
        one_pulse: CR1.OPM,
        preloaded: CR1.ARPE,
        flag_in_count: CR1.UIFREMAP,
        flag_copy: CNT.UIFCPY,
        update_flag: SR.UIF,
        update_interrupt: DIER.UIE,
        generate_update: EGR.UG,
    }
    |file| {
        /// Where there is one.
        repetitions: Option<u32> = file.block().register("RCR").map(|r| r.offset),
        down: FieldPlace = optional(file, "CR1", "DIR"),
        centre: FieldPlace = optional(file, "CR1", "CMS"),
    }
}

/// A field, or one without bits where the block has none of that name.
fn optional(file: &RegisterFile, register: &str, field: &str) -> FieldPlace {
    let known = file.block().register(register);
    let found = known.is_some_and(|r| r.fields.iter().any(|f| f.name == field));
    if found {
        file.field(register, field)
    } else {
        FieldPlace {
            offset: file.offset(register),
            mask: 0,
        }
    }
}

/// A field that every timer has in the same place; where the block's facts do not have it by that name, TIM1's say where it
/// is. (Those of TIM15 number the first channel's fields and name the second's.)
fn common(file: &RegisterFile, register: &str, field: &str) -> FieldPlace {
    let own = optional(file, register, field);
    let model = Facts::chip().block("TIM1").filter(|_| own.mask == 0);
    model.map_or(own, |block| RegisterFile::new(block).field(register, field))
}

impl Channel {
    /// Counted from 0, as the facts count fields; registers are counted from 1.
    pub fn new(file: &RegisterFile, index: u32) -> Self {
        let mode = format!("CCMR{}", index / 2 + 1);
        Self {
            offset: file.offset(&format!("CCR{}", index + 1)),
            flag: common(file, "SR", &format!("CCIF{index}")),
            interrupt: common(file, "DIER", &format!("CCIE{index}")),
            preloaded: common(file, &mode, &format!("OCPE{}", index % 2)),
            value: 0,
        }
    }
}
