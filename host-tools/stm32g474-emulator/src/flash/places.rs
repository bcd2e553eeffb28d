//! Where the fields are that the controller serves.

use crate::device::{FieldPlace, RegisterFile};

/// Offsets of the registers.
#[derive(Clone, Debug)]
pub struct Offsets {
    pub acr: u32,
    pub pdkeyr: u32,
    pub keyr: u32,
    pub optkeyr: u32,
    pub sr: u32,
    pub cr: u32,
    pub eccr: u32,
}

/// Fields of ACR and CR.
#[derive(Clone, Debug)]
pub struct Settings {
    pub latency: FieldPlace,
    pub data_cache: FieldPlace,
    pub data_cache_reset: FieldPlace,
    pub instruction_cache: FieldPlace,
    pub instruction_cache_reset: FieldPlace,
    pub program: FieldPlace,
    pub page_erase: FieldPlace,
    pub erase_bank_1: FieldPlace,
    pub erase_bank_2: FieldPlace,
    pub page: FieldPlace,
    pub bank: FieldPlace,
    pub start: FieldPlace,
    pub option_start: FieldPlace,
    pub fast: FieldPlace,
    pub end_interrupt: FieldPlace,
    pub error_interrupt: FieldPlace,
    pub option_load: FieldPlace,
    pub option_lock: FieldPlace,
    pub lock: FieldPlace,
}

/// Flags of SR and ECCR, and the option byte DBANK.
#[derive(Clone, Debug)]
pub struct Flags {
    pub end: FieldPlace,
    pub operation_error: FieldPlace,
    pub not_erased: FieldPlace,
    pub alignment: FieldPlace,
    pub size: FieldPlace,
    pub sequence: FieldPlace,
    pub busy: FieldPlace,
    /// All of SR that a one clears.
    pub clearable: u32,
    /// The errors that keep an operation from starting.
    pub errors: u32,
    pub ecc_address: FieldPlace,
    pub ecc_bank: FieldPlace,
    pub ecc_system: FieldPlace,
    pub ecc_interrupt: FieldPlace,
    pub ecc_corrected: FieldPlace,
    pub ecc_detected: FieldPlace,
    /// The same for the upper double word of four words, which one bank reads at once.
    pub ecc_detected_above: FieldPlace,
    /// All of ECCR that a one clears.
    pub ecc_clearable: u32,
    pub dual_bank: FieldPlace,
    /// Below which supply the chip is reset.
    pub brown_out_level: FieldPlace,
}

impl Offsets {
    pub fn new(file: &RegisterFile) -> Self {
        Self {
            acr: file.offset("ACR"),
            pdkeyr: file.offset("PDKEYR"),
            keyr: file.offset("KEYR"),
            optkeyr: file.offset("OPTKEYR"),
            sr: file.offset("SR"),
            cr: file.offset("CR"),
            eccr: file.offset("ECCR"),
        }
    }
}

impl Settings {
    pub fn new(file: &RegisterFile) -> Self {
        let acr = |name| file.field("ACR", name);
        let cr = |name| file.field("CR", name);
        Self {
            latency: acr("LATENCY"),
            data_cache: acr("DCEN"),
            data_cache_reset: acr("DCRST"),
            instruction_cache: acr("ICEN"),
            instruction_cache_reset: acr("ICRST"),
            program: cr("PG"),
            page_erase: cr("PER"),
            erase_bank_1: cr("MER1"),
            erase_bank_2: cr("MER2"),
            page: cr("PNB"),
            bank: cr("BKER"),
            start: cr("STRT"),
            option_start: cr("OPTSTRT"),
            fast: cr("FSTPG"),
            end_interrupt: cr("EOPIE"),
            error_interrupt: cr("ERRIE"),
            option_load: cr("OBL_LAUNCH"),
            option_lock: cr("OPTLOCK"),
            lock: cr("LOCK"),
        }
    }
}

impl Flags {
    pub fn new(file: &RegisterFile) -> Self {
        let sr = |name| file.field("SR", name);
        let eccr = |name| file.field("ECCR", name);
        let mask = |names: &[&'static str]| names.iter().fold(0, |mask, name| mask | sr(name).mask);
        let errors = [
            "PROGERR", "WRPERR", "PGAERR", "SIZERR", "PGSERR", "MISERR", "FASTERR",
        ];
        let errors = mask(&errors);
        Self {
            end: sr("EOP"),
            operation_error: sr("OPERR"),
            not_erased: sr("PROGERR"),
            alignment: sr("PGAERR"),
            size: sr("SIZERR"),
            sequence: sr("PGSERR"),
            busy: sr("BSY"),
            clearable: errors | mask(&["EOP", "OPERR", "RDERR", "OPTVERR"]),
            errors,
            ecc_address: eccr("ADDR_ECC"),
            ecc_bank: eccr("BK_ECC"),
            ecc_system: eccr("SYSF_ECC"),
            ecc_interrupt: eccr("ECCIE"),
            ecc_corrected: eccr("ECCC"),
            ecc_detected: eccr("ECCD"),
            ecc_detected_above: eccr("ECCD2"),
            ecc_clearable: ["ECCC", "ECCD", "ECCC2", "ECCD2"]
                .iter()
                .fold(0, |mask, name| mask | eccr(name).mask),
            dual_bank: file.field("OPTR", "DBANK"),
            brown_out_level: file.field("OPTR", "BOR_LEV"),
        }
    }
}
