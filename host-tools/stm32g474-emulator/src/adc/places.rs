//! Where a converter's registers have what.

use crate::device::{FieldPlace, RegisterFile, places};

/// Inputs of a converter.
const INPUTS: u8 = 19;
/// Inputs whose sampling time is in the first register.
const INPUTS_OF_FIRST: u8 = 10;
/// Inputs that can be differential.
const INPUTS_OF_DIFFERENTIAL: u8 = 18;

places! {
    /// Registers and fields of a converter.
    #[derive(Clone, Debug)]
    pub struct AdcPlaces {
        /// The interrupts' enables in IER have the places of these.
        flags: ISR,
        interrupts: IER,
        control: CR,
        data: DR,
        ready: ISR.ADRDY,
        overrun: ISR.OVR,
        enabled: CR.ADEN,
        disable: CR.ADDIS,
        regulator: CR.ADVREGEN,
        deep_power_down: CR.DEEPPWD,
        calibrate_differential: CR.ADCALDIF,
        calibrate: CR.ADCAL,
        resolution: CFGR.RES,
        continuous: CFGR.CONT,
        overwrite: CFGR.OVRMOD,
        injected_trigger: JSQR.JEXTSEL,
        queue_off: CFGR.JQDIS,
        ratio: CFGR2.OVSR,
        shift: CFGR2.OVSS,
        longer: SMPR.SMPPLUS,
    }
    |file| {
        injected_data: [u32; 4] = ["JDR1", "JDR2", "JDR3", "JDR4"].map(|name| file.offset(name)),
        end_of_conversion: [FieldPlace; 2] = ["EOC", "JEOC"].map(|name| file.field("ISR", name)),
        end_of_sequence: [FieldPlace; 2] = ["EOS", "JEOS"].map(|name| file.field("ISR", name)),
        start: [FieldPlace; 2] = ["ADSTART", "JADSTART"].map(|name| file.field("CR", name)),
        stop: [FieldPlace; 2] = ["ADSTP", "JADSTP"].map(|name| file.field("CR", name)),
        edge: [FieldPlace; 2] = [file.field("CFGR", "EXTEN"), file.field("JSQR", "JEXTEN")],
        oversampling: [FieldPlace; 2] = ["ROVSE", "JOVSE"].map(|name| file.field("CFGR2", name)),
        length: [FieldPlace; 2] = [file.field("SQR1", "L"), file.field("JSQR", "JL")],
        /// `SQ1` to `SQ16`, `JSQ1` to `JSQ4`.
        sequence: [Vec<FieldPlace>; 2] = [regular_sequence(file), injected_sequence(file)],
        sampling: Vec<FieldPlace> = (0..INPUTS).map(|input| sampling(file, input)).collect(),
        differential: Vec<FieldPlace> = (0..INPUTS_OF_DIFFERENTIAL)
            .map(|input| file.field("DIFSEL", &format!("DIFSEL{input}")))
            .collect(),
    }
}

impl AdcPlaces {
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

fn injected_sequence(file: &RegisterFile) -> Vec<FieldPlace> {
    let places = (0..4).map(|rank| file.field("JSQR", &format!("JSQ{rank}")));
    places.collect()
}
