//! Where the registers and fields of FDCAN2 and the parts of its message RAM are.

use crate::device::{FieldPlace, RegisterFile, places};

places! {
    /// Offsets of the registers that do something.
    #[derive(Clone, Debug)]
    pub struct FdcanOffsets {
        test: TEST,
        cccr: CCCR,
        tscv: TSCV,
        ecr: ECR,
        psr: PSR,
        ir: IR,
        ie: IE,
        hpms: HPMS,
        txfqs: TXFQS,
        txbrp: TXBRP,
        txbar: TXBAR,
        txbcr: TXBCR,
        txbto: TXBTO,
        txbcf: TXBCF,
        txbtie: TXBTIE,
        txbcie: TXBCIE,
        txefs: TXEFS,
        txefa: TXEFA,
    }
    |file| {
        rxfs: [u32; 2] = ["RXF0S", "RXF1S"].map(|name| file.offset(name)),
        rxfa: [u32; 2] = ["RXF0A", "RXF1A"].map(|name| file.offset(name)),
        /// Those that only change while INIT and CCE are set, with their names: RM0440 marks them with P.
        protected: Vec<(u32, &'static str)> = [
            "DBTP", "RWD", "NBTP", "TSCC", "TOCC", "TDCR", "RXGFC", "XIDAM", "TXBC", "CKDIV",
        ].map(|name| (file.offset(name), name)).to_vec(),
    }
}

places! {
    /// Fields of the settings.
    #[derive(Clone, Debug)]
    pub struct FdcanSettings {
        init: CCCR.INIT,
        change: CCCR.CCE,
        stop_request: CCCR.CSR,
        stopped: CCCR.CSA,
        restricted: CCCR.ASM,
        monitoring: CCCR.MON,
        test: CCCR.TEST,
        no_retry: CCCR.DAR,
        fd: CCCR.FDOE,
        switch: CCCR.BRSE,
        delay_compensation: DBTP.TDC,
        delay_offset: TDCR.TDCO,
        clock_divider: CKDIV.PDIV,
        stamp_source: TSCC.TSS,
        stamp_prescaler: TSCC.TCP,
        standard_filters: RXGFC.LSS,
        other_standard: RXGFC.ANFS,
        queue: TXBC.TFQM,
    }
    |file| {
        /// The bits of CCCR that only change while INIT and CCE are set.
        protected: u32 = file.mask("CCCR", &[
            "ASM", "MON", "DAR", "TEST", "FDOE", "BRSE", "PXHD", "EFBI", "TXP", "NISO",
        ]),
        /// Those of them that may be cleared at any time.
        clearable: u32 = file.mask("CCCR", &["ASM", "MON", "TEST"]),
        nominal: Timing = timing(file, "NBTP", ["NBRP", "NTSEG1", "NTSEG2"]),
        data: Timing = timing(file, "DBTP", ["DBRP", "DTSEG1", "DTSEG2"]),
        overwrite: [FieldPlace; 2] = ["F0OM", "F1OM"].map(|name| file.field("RXGFC", name)),
    }
}

/// Fields of a bit's timing.
#[derive(Clone, Debug)]
pub struct Timing {
    pub prescaler: FieldPlace,
    pub segment_1: FieldPlace,
    pub segment_2: FieldPlace,
}

fn timing(file: &RegisterFile, register: &str, fields: [&str; 3]) -> Timing {
    let [prescaler, segment_1, segment_2] = fields.map(|name| file.field(register, name));
    Timing {
        prescaler,
        segment_1,
        segment_2,
    }
}

places! {
    /// Fields of what it shows.
    #[derive(Clone, Debug)]
    pub struct FdcanFlags {
        fill: RXF0S.FFL,
        get: RXF0S.FGI,
        put: RXF0S.FPI,
        full: RXF0S.FF,
        lost: RXF0S.RFL,
        acknowledge: RXF0A.FAI,
        transmit_free: TXFQS.TFFL,
        transmit_get: TXFQS.TFGI,
        transmit_put: TXFQS.TFQPI,
        transmit_full: TXFQS.TFQF,
        event_fill: TXEFS.EFFL,
        event_get: TXEFS.EFGI,
        event_put: TXEFS.EFPI,
        event_full: TXEFS.EFF,
        event_lost: TXEFS.TEFL,
        event_acknowledge: TXEFA.EFAI,
        transmit_errors: ECR.TEC,
        receive_errors: ECR.REC,
        receive_passive: ECR.RP,
        logged_errors: ECR.CEL,
        last_error: PSR.LEC,
        last_data_error: PSR.DLEC,
        activity: PSR.ACT,
        passive: PSR.EP,
        warning: PSR.EW,
        bus_off: PSR.BO,
        received_switch: PSR.RBRS,
        received_fd: PSR.REDL,
        priority_index: HPMS.BIDX,
        priority_storage: HPMS.MSI,
        priority_filter: HPMS.FIDX,
    }
}

/// Where the parts of the message RAM begin, words.
#[derive(Clone, Debug)]
pub struct Parts {
    pub standard_filters: usize,
    pub receive: [usize; 2],
    pub events: usize,
    pub buffers: usize,
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
