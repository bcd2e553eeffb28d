//! What raises the two interrupt lines.

use crate::device::{FieldPlace, RegisterFile};

/// Bits of IR, and how they reach the two lines.
#[derive(Clone, Debug)]
pub struct Interrupts {
    pub new: [u32; 2],
    pub full: [u32; 2],
    pub lost: [u32; 2],
    pub priority: u32,
    pub complete: u32,
    pub cancelled: u32,
    pub transmit_empty: u32,
    pub event_new: u32,
    pub event_full: u32,
    pub event_lost: u32,
    pub passive: u32,
    pub warning: u32,
    pub bus_off: u32,
    pub data_error: u32,
    pub arbitration_error: u32,
    /// Groups of bits of IR, each with the field that chooses its line: RM0440, FDCAN_ILS.
    pub groups: Vec<(u32, FieldPlace)>,
    pub lines: [FieldPlace; 2],
}

impl Interrupts {
    pub fn new(file: &RegisterFile) -> Self {
        let ir = |name| file.field("IR", name).mask;
        let group = |names: &[&'static str], line| {
            let mask = names.iter().fold(0, |mask, name| mask | ir(name));
            (mask, file.field("ILS", line))
        };
        Self {
            new: ["RFN0", "RFN1"].map(ir),
            full: ["RFF0", "RFF1"].map(ir),
            lost: ["RFL0", "RFL1"].map(ir),
            priority: ir("HPM"),
            complete: ir("TC"),
            cancelled: ir("TCF"),
            transmit_empty: ir("TFE"),
            event_new: ir("TEFN"),
            event_full: ir("TEFF"),
            event_lost: ir("TEFL"),
            passive: ir("EP"),
            warning: ir("EW"),
            bus_off: ir("BO"),
            data_error: ir("PED"),
            arbitration_error: ir("PEA"),
            groups: vec![
                group(&["RFN0", "RFF0", "RFL0"], "RXFIFO0"),
                group(&["RFN1", "RFF1", "RFL1"], "RXFIFO1"),
                group(&["HPM", "TC", "TCF"], "SMSG"),
                group(&["TFE", "TEFN", "TEFF", "TEFL"], "TFERR"),
                group(&["TSW", "MRAF", "TOO"], "MISC"),
                group(&["ELO", "EP"], "BERR"),
                group(&["EW", "BO", "WDI", "PEA", "PED", "ARA"], "PERR"),
            ],
            lines: ["EINT0", "EINT1"].map(|name| file.field("ILE", name)),
        }
    }
}
