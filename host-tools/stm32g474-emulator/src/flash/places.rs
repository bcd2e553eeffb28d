//! Where the fields are that the controller serves.

use crate::device::places;

const ERRORS: [&str; 7] = [
    "PROGERR", "WRPERR", "PGAERR", "SIZERR", "PGSERR", "MISERR", "FASTERR",
];

places! {
    /// Offsets of the registers.
    #[derive(Clone, Debug)]
    pub struct FlashOffsets {
        acr: ACR,
        pdkeyr: PDKEYR,
        keyr: KEYR,
        optkeyr: OPTKEYR,
        sr: SR,
        cr: CR,
        eccr: ECCR,
    }
}

places! {
    /// Fields of ACR and CR.
    #[derive(Clone, Debug)]
    pub struct FlashSettings {
        latency: ACR.LATENCY,
        data_cache: ACR.DCEN,
        data_cache_reset: ACR.DCRST,
        instruction_cache: ACR.ICEN,
        instruction_cache_reset: ACR.ICRST,
        program: CR.PG,
        page_erase: CR.PER,
        erase_bank_1: CR.MER1,
        erase_bank_2: CR.MER2,
        page: CR.PNB,
        bank: CR.BKER,
        start: CR.STRT,
        option_start: CR.OPTSTRT,
        fast: CR.FSTPG,
        end_interrupt: CR.EOPIE,
        error_interrupt: CR.ERRIE,
        option_load: CR.OBL_LAUNCH,
        option_lock: CR.OPTLOCK,
        lock: CR.LOCK,
    }
}

places! {
    /// Flags of SR and ECCR, and the option byte DBANK.
    #[derive(Clone, Debug)]
    pub struct FlashFlags {
        end: SR.EOP,
        operation_error: SR.OPERR,
        not_erased: SR.PROGERR,
        alignment: SR.PGAERR,
        size: SR.SIZERR,
        sequence: SR.PGSERR,
        busy: SR.BSY,
        ecc_address: ECCR.ADDR_ECC,
        ecc_bank: ECCR.BK_ECC,
        ecc_system: ECCR.SYSF_ECC,
        ecc_interrupt: ECCR.ECCIE,
        ecc_corrected: ECCR.ECCC,
        ecc_corrected_above: ECCR.ECCC2,
        ecc_detected: ECCR.ECCD,
        /// The same for the upper double word of four words, which one bank reads at once.
        ecc_detected_above: ECCR.ECCD2,
        dual_bank: OPTR.DBANK,
        /// Below which supply the chip is reset.
        brown_out_level: OPTR.BOR_LEV,
    }
    |file| {
        /// All of SR that a one clears.
        clearable: u32 = file.mask("SR", &ERRORS) | file.mask("SR", &["EOP", "OPERR", "RDERR", "OPTVERR"]),
        /// The errors that keep an operation from starting.
        errors: u32 = file.mask("SR", &ERRORS),
        /// All of ECCR that a one clears.
        ecc_clearable: u32 = file.mask("ECCR", &["ECCC", "ECCD", "ECCC2", "ECCD2"]),
    }
}
