//! Where a converter's registers have what.

use crate::device::{FieldPlace, RegisterFile};

/// Inputs of a converter.
const INPUTS: u8 = 19;
/// Inputs whose sampling time is in the first register.
const INPUTS_OF_FIRST: u8 = 10;
/// Inputs that can be differential.
const INPUTS_OF_DIFFERENTIAL: u8 = 18;

/// Registers and fields of a converter.
#[derive(Clone, Debug)]
pub struct Places {
    /// `ISR`; the interrupts' enables in `IER` have the places of their flags.
    pub flags: u32,
    /// `IER`.
    pub interrupts: u32,
    /// `CR`.
    pub control: u32,
    /// `DR`.
    pub data: u32,
    /// `JDR1` to `JDR4`.
    pub injected_data: [u32; 4],
    /// `ADRDY`.
    pub ready: FieldPlace,
    /// `OVR`.
    pub overrun: FieldPlace,
    /// `EOC`, `JEOC`.
    pub end_of_conversion: [FieldPlace; 2],
    /// `EOS`, `JEOS`.
    pub end_of_sequence: [FieldPlace; 2],
    /// `ADEN`.
    pub enabled: FieldPlace,
    /// `ADDIS`.
    pub disable: FieldPlace,
    /// `ADSTART`, `JADSTART`.
    pub start: [FieldPlace; 2],
    /// `ADSTP`, `JADSTP`.
    pub stop: [FieldPlace; 2],
    /// `ADVREGEN`.
    pub regulator: FieldPlace,
    /// `DEEPPWD`.
    pub deep_power_down: FieldPlace,
    /// `ADCALDIF`.
    pub calibrate_differential: FieldPlace,
    /// `ADCAL`.
    pub calibrate: FieldPlace,
    /// `RES`.
    pub resolution: FieldPlace,
    /// `CONT`.
    pub continuous: FieldPlace,
    /// `OVRMOD`.
    pub overwrite: FieldPlace,
    /// `EXTEN`, `JEXTEN`.
    pub edge: [FieldPlace; 2],
    /// `JEXTSEL`.
    pub injected_trigger: FieldPlace,
    /// `JQDIS`.
    pub queue_off: FieldPlace,
    /// `ROVSE`, `JOVSE`.
    pub oversampling: [FieldPlace; 2],
    /// `OVSR`.
    pub ratio: FieldPlace,
    /// `OVSS`.
    pub shift: FieldPlace,
    /// `L`, `JL`.
    pub length: [FieldPlace; 2],
    /// `SQ1` to `SQ16`, `JSQ1` to `JSQ4`.
    pub sequence: [Vec<FieldPlace>; 2],
    /// `SMPPLUS`.
    pub longer: FieldPlace,
    sampling: Vec<FieldPlace>,
    differential: Vec<FieldPlace>,
}

impl Places {
    /// Finds them.
    #[must_use]
    pub fn new(file: &RegisterFile) -> Self {
        let pair = |register: &str, one: &str, other: &str| {
            [file.field(register, one), file.field(register, other)]
        };
        let injected = (0..4).map(|rank| file.field("JSQR", &format!("JSQ{rank}")));
        Self {
            flags: file.offset("ISR"),
            interrupts: file.offset("IER"),
            control: file.offset("CR"),
            data: file.offset("DR"),
            injected_data: ["JDR1", "JDR2", "JDR3", "JDR4"].map(|name| file.offset(name)),
            ready: file.field("ISR", "ADRDY"),
            overrun: file.field("ISR", "OVR"),
            end_of_conversion: pair("ISR", "EOC", "JEOC"),
            end_of_sequence: pair("ISR", "EOS", "JEOS"),
            enabled: file.field("CR", "ADEN"),
            disable: file.field("CR", "ADDIS"),
            start: pair("CR", "ADSTART", "JADSTART"),
            stop: pair("CR", "ADSTP", "JADSTP"),
            regulator: file.field("CR", "ADVREGEN"),
            deep_power_down: file.field("CR", "DEEPPWD"),
            calibrate_differential: file.field("CR", "ADCALDIF"),
            calibrate: file.field("CR", "ADCAL"),
            resolution: file.field("CFGR", "RES"),
            continuous: file.field("CFGR", "CONT"),
            overwrite: file.field("CFGR", "OVRMOD"),
            edge: [file.field("CFGR", "EXTEN"), file.field("JSQR", "JEXTEN")],
            injected_trigger: file.field("JSQR", "JEXTSEL"),
            queue_off: file.field("CFGR", "JQDIS"),
            oversampling: pair("CFGR2", "ROVSE", "JOVSE"),
            ratio: file.field("CFGR2", "OVSR"),
            shift: file.field("CFGR2", "OVSS"),
            length: [file.field("SQR1", "L"), file.field("JSQR", "JL")],
            sequence: [regular_sequence(file), injected.collect()],
            longer: file.field("SMPR", "SMPPLUS"),
            sampling: (0..INPUTS).map(|input| sampling(file, input)).collect(),
            differential: (0..INPUTS_OF_DIFFERENTIAL)
                .map(|input| file.field("DIFSEL", &format!("DIFSEL{input}")))
                .collect(),
        }
    }

    /// The sampling time of an input (`SMPx`).
    #[must_use]
    pub fn sampling(&self, input: u8) -> Option<FieldPlace> {
        self.sampling.get(usize::from(input)).copied()
    }

    /// Whether an input is converted against its neighbour.
    #[must_use]
    pub fn is_differential(&self, file: &RegisterFile, input: u8) -> bool {
        let place = self.differential.get(usize::from(input));
        place.is_some_and(|place| file.is_set(*place))
    }
}

fn sampling(file: &RegisterFile, input: u8) -> FieldPlace {
    match input.checked_sub(INPUTS_OF_FIRST) {
        None => file.field("SMPR", &format!("SMP{input}")),
        Some(input) => file.field("SMPR2", &format!("SMP{input}")),
    }
}

fn regular_sequence(file: &RegisterFile) -> Vec<FieldPlace> {
    let registers = [("SQR1", 4), ("SQR2", 5), ("SQR3", 5), ("SQR4", 2)];
    let places = registers.into_iter().flat_map(|(register, count)| {
        (0..count).map(move |rank| file.field(register, &format!("SQ{rank}")))
    });
    places.collect()
}
