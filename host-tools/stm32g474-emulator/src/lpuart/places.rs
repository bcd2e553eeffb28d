//! Where the fields of LPUART1 are.

use crate::device::{RegisterFile, places};

places! {
    /// Offsets of the registers.
    #[derive(Clone, Debug)]
    pub struct LpuartOffsets {
        cr1: CR1,
        cr2: CR2,
        cr3: CR3,
        brr: BRR,
        rqr: RQR,
        isr: ISR,
        icr: ICR,
        rdr: RDR,
        tdr: TDR,
        presc: PRESC,
    }
}

places! {
    /// Fields of the control registers.
    #[derive(Clone, Debug)]
    pub struct LpuartSettings {
        enable: CR1.UE,
        receive: CR1.RE,
        transmit: CR1.TE,
        fifo: CR1.FIFOEN,
        length_0: CR1.M0,
        length_1: CR1.M1,
        parity: CR1.PCE,
        stop: CR2.STOP,
        prescaler: PRESC.PRESCALER,
        receive_threshold: CR3.RXFTCFG,
        transmit_threshold: CR3.TXFTCFG,
        flush_received: RQR.RXFRQ,
        flush_transmit: RQR.TXFRQ,
    }
    |file| {
        /// Bits of CR1, CR2 and CR3 that only change while the block is disabled.
        fixed: [u32; 3] = [
            file.mask("CR1", &["M0", "M1", "FIFOEN", "PCE", "PS", "WAKE"]),
            file.mask("CR2", &["STOP", "SWAP", "RXINV", "TXINV", "DATAINV", "MSBFIRST"]),
            file.mask("CR3", &["HDSEL", "OVRDIS", "DEM", "DEP"]),
        ],
    }
}

/// Fields of ISR.
#[derive(Clone, Debug)]
pub struct LpuartFlags {
    pub framing: u32,
    pub noise: u32,
    pub overrun: u32,
    pub idle: u32,
    pub received: u32,
    pub complete: u32,
    pub space: u32,
    pub busy: u32,
    pub transmit_ready: u32,
    pub receive_ready: u32,
    pub transmit_empty: u32,
    pub receive_full: u32,
    pub receive_threshold: u32,
    pub transmit_threshold: u32,
    /// The bits of ISR that ICR clears, each beside its bit there.
    pub clears: Vec<(u32, u32)>,
    /// Flags, and what lets each raise the interrupt: the number of the control register, from 0, and its bit.
    pub interrupts: Vec<(u32, usize, u32)>,
}

impl LpuartFlags {
    pub fn new(file: &RegisterFile) -> Self {
        let isr = |name| file.field("ISR", name).mask;
        let clear = |name| (isr(name), file.field("ICR", name).mask);
        let by = |flag, register, enable| {
            let number = match register {
                "CR1" => 0,
                "CR2" => 1,
                _ => 2,
            };
            (isr(flag), number, file.field(register, enable).mask)
        };
        Self {
            framing: isr("FE"),
            noise: isr("NE"),
            overrun: isr("ORE"),
            idle: isr("IDLE"),
            received: isr("RXNE"),
            complete: isr("TC"),
            space: isr("TXE"),
            busy: isr("BUSY"),
            transmit_ready: isr("TEACK"),
            receive_ready: isr("REACK"),
            transmit_empty: isr("TXFE"),
            receive_full: isr("RXFF"),
            receive_threshold: isr("RXFT"),
            transmit_threshold: isr("TXFT"),
            clears: ["PE", "FE", "NE", "ORE", "IDLE", "TC"].map(clear).to_vec(),
            // RM0440, LPUART interrupt requests.
            interrupts: vec![
                by("RXNE", "CR1", "RXNEIE"),
                by("ORE", "CR1", "RXNEIE"),
                by("TXE", "CR1", "TXEIE"),
                by("TC", "CR1", "TCIE"),
                by("IDLE", "CR1", "IDLEIE"),
                by("PE", "CR1", "PEIE"),
                by("TXFE", "CR1", "TXFEIE"),
                by("RXFF", "CR1", "RXFFIE"),
                by("FE", "CR3", "EIE"),
                by("NE", "CR3", "EIE"),
                by("ORE", "CR3", "EIE"),
                by("RXFT", "CR3", "RXFTIE"),
                by("TXFT", "CR3", "TXFTIE"),
            ],
        }
    }
}
