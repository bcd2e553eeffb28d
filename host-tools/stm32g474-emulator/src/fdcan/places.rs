//! Where the registers and fields of FDCAN2 and the parts of its message RAM are.

use crate::device::{FieldPlace, RegisterFile};

/// Offsets of the registers that do something.
#[derive(Clone, Debug)]
pub struct Offsets {
    pub test: u32,
    pub cccr: u32,
    pub tscv: u32,
    pub ecr: u32,
    pub psr: u32,
    pub ir: u32,
    pub ie: u32,
    pub hpms: u32,
    pub rxfs: [u32; 2],
    pub rxfa: [u32; 2],
    pub txfqs: u32,
    pub txbrp: u32,
    pub txbar: u32,
    pub txbcr: u32,
    pub txbto: u32,
    pub txbcf: u32,
    pub txbtie: u32,
    pub txbcie: u32,
    pub txefs: u32,
    pub txefa: u32,
    /// Those that only change while INIT and CCE are set, with their names: RM0440 marks them with P.
    pub protected: Vec<(u32, &'static str)>,
}

/// Fields of the settings.
#[derive(Clone, Debug)]
pub struct Settings {
    pub init: FieldPlace,
    pub change: FieldPlace,
    pub stop_request: FieldPlace,
    pub stopped: FieldPlace,
    pub restricted: FieldPlace,
    pub monitoring: FieldPlace,
    pub test: FieldPlace,
    pub no_retry: FieldPlace,
    pub fd: FieldPlace,
    pub switch: FieldPlace,
    /// The bits of CCCR that only change while INIT and CCE are set.
    pub protected: u32,
    /// Those of them that may be cleared at any time.
    pub clearable: u32,
    pub nominal: Timing,
    pub data: Timing,
    pub delay_compensation: FieldPlace,
    pub delay_offset: FieldPlace,
    pub clock_divider: FieldPlace,
    pub stamp_source: FieldPlace,
    pub stamp_prescaler: FieldPlace,
    pub standard_filters: FieldPlace,
    pub other_standard: FieldPlace,
    pub overwrite: [FieldPlace; 2],
    pub queue: FieldPlace,
}

/// Fields of a bit's timing.
#[derive(Clone, Debug)]
pub struct Timing {
    pub prescaler: FieldPlace,
    pub segment_1: FieldPlace,
    pub segment_2: FieldPlace,
}

/// Fields of what it shows.
#[derive(Clone, Debug)]
pub struct Flags {
    pub fill: FieldPlace,
    pub get: FieldPlace,
    pub put: FieldPlace,
    pub full: FieldPlace,
    pub lost: FieldPlace,
    pub acknowledge: FieldPlace,
    pub transmit_free: FieldPlace,
    pub transmit_get: FieldPlace,
    pub transmit_put: FieldPlace,
    pub transmit_full: FieldPlace,
    pub event_fill: FieldPlace,
    pub event_get: FieldPlace,
    pub event_put: FieldPlace,
    pub event_full: FieldPlace,
    pub event_lost: FieldPlace,
    pub event_acknowledge: FieldPlace,
    pub transmit_errors: FieldPlace,
    pub receive_errors: FieldPlace,
    pub receive_passive: FieldPlace,
    pub logged_errors: FieldPlace,
    pub last_error: FieldPlace,
    pub last_data_error: FieldPlace,
    pub activity: FieldPlace,
    pub passive: FieldPlace,
    pub warning: FieldPlace,
    pub bus_off: FieldPlace,
    pub received_switch: FieldPlace,
    pub received_fd: FieldPlace,
    pub priority_index: FieldPlace,
    pub priority_storage: FieldPlace,
    pub priority_filter: FieldPlace,
}

/// Where the parts of the message RAM begin, words.
#[derive(Clone, Debug)]
pub struct Parts {
    pub standard_filters: usize,
    pub receive: [usize; 2],
    pub events: usize,
    pub buffers: usize,
}

impl Offsets {
    pub fn new(file: &RegisterFile) -> Self {
        let protected = [
            "DBTP", "RWD", "NBTP", "TSCC", "TOCC", "TDCR", "RXGFC", "XIDAM", "TXBC", "CKDIV",
        ];
        Self {
            test: file.offset("TEST"),
            cccr: file.offset("CCCR"),
            tscv: file.offset("TSCV"),
            ecr: file.offset("ECR"),
            psr: file.offset("PSR"),
            ir: file.offset("IR"),
            ie: file.offset("IE"),
            hpms: file.offset("HPMS"),
            rxfs: ["RXF0S", "RXF1S"].map(|name| file.offset(name)),
            rxfa: ["RXF0A", "RXF1A"].map(|name| file.offset(name)),
            txfqs: file.offset("TXFQS"),
            txbrp: file.offset("TXBRP"),
            txbar: file.offset("TXBAR"),
            txbcr: file.offset("TXBCR"),
            txbto: file.offset("TXBTO"),
            txbcf: file.offset("TXBCF"),
            txbtie: file.offset("TXBTIE"),
            txbcie: file.offset("TXBCIE"),
            txefs: file.offset("TXEFS"),
            txefa: file.offset("TXEFA"),
            protected: protected.map(|name| (file.offset(name), name)).to_vec(),
        }
    }
}

impl Settings {
    pub fn new(file: &RegisterFile) -> Self {
        let cccr = |name| file.field("CCCR", name);
        let mask = |names: &[&'static str]| {
            let masks = names.iter().map(|name| cccr(name).mask);
            masks.fold(0, |all, mask| all | mask)
        };
        let timing = |register, prescaler, segment_1, segment_2| Timing {
            prescaler: file.field(register, prescaler),
            segment_1: file.field(register, segment_1),
            segment_2: file.field(register, segment_2),
        };
        Self {
            init: cccr("INIT"),
            change: cccr("CCE"),
            stop_request: cccr("CSR"),
            stopped: cccr("CSA"),
            restricted: cccr("ASM"),
            monitoring: cccr("MON"),
            test: cccr("TEST"),
            no_retry: cccr("DAR"),
            fd: cccr("FDOE"),
            switch: cccr("BRSE"),
            protected: mask(&[
                "ASM", "MON", "DAR", "TEST", "FDOE", "BRSE", "PXHD", "EFBI", "TXP", "NISO",
            ]),
            clearable: mask(&["ASM", "MON", "TEST"]),
            nominal: timing("NBTP", "NBRP", "NTSEG1", "NTSEG2"),
            data: timing("DBTP", "DBRP", "DTSEG1", "DTSEG2"),
            delay_compensation: file.field("DBTP", "TDC"),
            delay_offset: file.field("TDCR", "TDCO"),
            clock_divider: file.field("CKDIV", "PDIV"),
            stamp_source: file.field("TSCC", "TSS"),
            stamp_prescaler: file.field("TSCC", "TCP"),
            standard_filters: file.field("RXGFC", "LSS"),
            other_standard: file.field("RXGFC", "ANFS"),
            overwrite: ["F0OM", "F1OM"].map(|name| file.field("RXGFC", name)),
            queue: file.field("TXBC", "TFQM"),
        }
    }
}

impl Flags {
    pub fn new(file: &RegisterFile) -> Self {
        Self {
            fill: file.field("RXF0S", "FFL"),
            get: file.field("RXF0S", "FGI"),
            put: file.field("RXF0S", "FPI"),
            full: file.field("RXF0S", "FF"),
            lost: file.field("RXF0S", "RFL"),
            acknowledge: file.field("RXF0A", "FAI"),
            transmit_free: file.field("TXFQS", "TFFL"),
            transmit_get: file.field("TXFQS", "TFGI"),
            transmit_put: file.field("TXFQS", "TFQPI"),
            transmit_full: file.field("TXFQS", "TFQF"),
            event_fill: file.field("TXEFS", "EFFL"),
            event_get: file.field("TXEFS", "EFGI"),
            event_put: file.field("TXEFS", "EFPI"),
            event_full: file.field("TXEFS", "EFF"),
            event_lost: file.field("TXEFS", "TEFL"),
            event_acknowledge: file.field("TXEFA", "EFAI"),
            transmit_errors: file.field("ECR", "TEC"),
            receive_errors: file.field("ECR", "REC"),
            receive_passive: file.field("ECR", "RP"),
            logged_errors: file.field("ECR", "CEL"),
            last_error: file.field("PSR", "LEC"),
            last_data_error: file.field("PSR", "DLEC"),
            activity: file.field("PSR", "ACT"),
            passive: file.field("PSR", "EP"),
            warning: file.field("PSR", "EW"),
            bus_off: file.field("PSR", "BO"),
            received_switch: file.field("PSR", "RBRS"),
            received_fd: file.field("PSR", "REDL"),
            priority_index: file.field("HPMS", "BIDX"),
            priority_storage: file.field("HPMS", "MSI"),
            priority_filter: file.field("HPMS", "FIDX"),
        }
    }
}

impl Parts {
    /// By the makers' names for the words of the message RAM.
    pub fn new(memory: &RegisterFile) -> Self {
        let word = |name| (memory.offset(name) / 4) as usize;
        Self {
            standard_filters: word("FLSSA1"),
            receive: ["RXFIFO01", "RXFIFO11"].map(word),
            events: word("TXEFIFO1"),
            buffers: word("TXBUF1"),
        }
    }
}
