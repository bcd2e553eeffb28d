//! Where a timer's registers have what.

use crate::device::{FieldPlace, RegisterFile};
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

/// Registers and fields.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    /// `CR1`.
    pub control: u32,
    /// `SR`.
    pub status: u32,
    /// `EGR`.
    pub events: u32,
    /// `CNT`.
    pub count: u32,
    /// `PSC`.
    pub prescaler: u32,
    /// `ARR`.
    pub top: u32,
    /// `RCR`, where there is one.
    pub repetitions: Option<u32>,
    /// `CEN`.
    pub enabled: FieldPlace,
    /// `UDIS`.
    pub no_updates: FieldPlace,
    /// `URS`.
    pub counter_only: FieldPlace,
    /// `OPM`.
    pub one_pulse: FieldPlace,
    /// `DIR`.
    pub down: FieldPlace,
    /// `CMS`.
    pub centre: FieldPlace,
    /// `ARPE`.
    pub preloaded: FieldPlace,
    /// `UIFREMAP`.
    pub flag_in_count: FieldPlace,
    /// `UIFCPY`.
    pub flag_copy: FieldPlace,
    /// `UIF`.
    pub update_flag: FieldPlace,
    /// `UIE`.
    pub update_interrupt: FieldPlace,
    /// `UG`.
    pub generate_update: FieldPlace,
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
    let model = Facts::of_chip().block("TIM1").filter(|_| own.mask == 0);
    model.map_or(own, |block| RegisterFile::new(block).field(register, field))
}

impl Places {
    /// Finds them.
    pub fn new(file: &RegisterFile) -> Self {
        let control = |field| file.field("CR1", field);
        Self {
            control: file.offset("CR1"),
            status: file.offset("SR"),
            events: file.offset("EGR"),
            count: file.offset("CNT"),
            prescaler: file.offset("PSC"),
            top: file.offset("ARR"),
            repetitions: file.block().register("RCR").map(|r| r.offset),
            enabled: control("CEN"),
            no_updates: control("UDIS"),
            counter_only: control("URS"),
            one_pulse: control("OPM"),
            down: optional(file, "CR1", "DIR"),
            centre: optional(file, "CR1", "CMS"),
            preloaded: control("ARPE"),
            flag_in_count: control("UIFREMAP"),
            flag_copy: file.field("CNT", "UIFCPY"),
            update_flag: file.field("SR", "UIF"),
            update_interrupt: file.field("DIER", "UIE"),
            generate_update: file.field("EGR", "UG"),
        }
    }
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
