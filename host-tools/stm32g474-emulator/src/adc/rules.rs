//! What the reference manual forbids to write while a converter is busy, and what is not modelled.

use crate::device::{Context, FieldPlace, RegisterFile};

/// When a write is forbidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum While {
    /// `ADSTART` is set.
    Regular,
    /// `JADSTART` is set.
    Injected,
    /// One of the two is set.
    Either,
    /// The converter is switched on, or busy with anything.
    Enabled,
}

/// Fields that must not change then. As the manual says at each field.
const FIELDS: [(While, &str, &[&str]); 5] = [
    (
        While::Regular,
        "CFGR",
        &["CONT", "OVRMOD", "EXTEN", "EXTSEL", "DISCEN", "DISCNUM"],
    ),
    (While::Injected, "CFGR", &["JDISCEN", "JQM"]),
    (
        While::Either,
        "CFGR",
        &[
            "DMAEN", "DMACFG", "RES", "AUTDLY", "ALIGN", "JAUTO", "JQDIS",
        ],
    ),
    (
        While::Either,
        "CFGR2",
        &["ROVSE", "JOVSE", "OVSR", "OVSS", "TROVS", "ROVSM", "GCOMP"],
    ),
    (While::Enabled, "CR", &["ADCALDIF"]),
];

/// Registers that must not be written then, whatever the value.
const REGISTERS: [(While, &str); 6] = [
    (While::Either, "SMPR"),
    (While::Either, "SMPR2"),
    (While::Regular, "SQR1"),
    (While::Regular, "SQR2"),
    (While::Regular, "SQR3"),
    (While::Regular, "SQR4"),
];

/// Fields whose function is not modelled.
const UNMODELLED: [(&str, &[&str]); 2] = [
    (
        "CFGR",
        &[
            "DMAEN", "AUTDLY", "ALIGN", "DISCEN", "JDISCEN", "JAUTO", "AWD1EN", "JAWD1EN",
        ],
    ),
    ("CFGR2", &["TROVS", "GCOMP", "SWTRIG", "BULB", "SMPTRIG"]),
];

/// The rules of a converter.
#[derive(Clone, Debug)]
pub struct Rules {
    fields: Vec<(While, &'static str, &'static str, FieldPlace)>,
    registers: Vec<(While, &'static str, u32)>,
    unmodelled: Vec<(&'static str, &'static str, FieldPlace)>,
    injected: u32,
    differential: u32,
}

/// What a converter is busy with.
#[derive(Clone, Copy, Debug)]
pub struct Busy {
    /// `ADSTART`.
    pub regular: bool,
    /// `JADSTART`.
    pub injected: bool,
    /// Switched on or calibrating.
    pub enabled: bool,
    /// The queue of injected sequences is on, which takes new ones at any time.
    pub queue: bool,
}

impl While {
    /// The words for what forbids a write now.
    fn forbids(self, busy: Busy) -> Option<&'static str> {
        let (regular, injected) = ("ADSTART is set", "JADSTART is set");
        match self {
            Self::Regular | Self::Either if busy.regular => Some(regular),
            Self::Injected | Self::Either if busy.injected => Some(injected),
            Self::Enabled if busy.enabled => Some("the converter is switched on"),
            _ => None,
        }
    }
}

impl Rules {
    /// Finds the places.
    #[must_use]
    pub fn new(file: &RegisterFile) -> Self {
        let fields = FIELDS.iter().flat_map(|(when, register, fields)| {
            let place = |field| (*when, *register, field, file.field(register, field));
            fields.iter().map(move |field| place(*field))
        });
        let unmodelled = UNMODELLED.iter().flat_map(|(register, fields)| {
            let place = |field| (*register, field, file.field(register, field));
            fields.iter().map(move |field| place(*field))
        });
        let registers = REGISTERS.iter();
        Self {
            fields: fields.collect(),
            registers: registers
                .map(|(when, register)| (*when, *register, file.offset(register)))
                .collect(),
            unmodelled: unmodelled.collect(),
            injected: file.offset("JSQR"),
            differential: file.offset("DIFSEL"),
        }
    }

    /// Checks a write.
    pub fn check(
        &self,
        file: &RegisterFile,
        (offset, value): (u32, u32),
        busy: Busy,
        context: &mut Context<'_>,
    ) {
        let name = file.block().name;
        for (when, register, at) in &self.registers {
            if let Some(cause) = when.forbids(busy).filter(|_| *at == offset) {
                let text = format!("{name}_{register} is written while {cause}");
                context.findings.add(text);
            }
        }
        if offset == self.injected && busy.injected && !busy.queue {
            let text = format!("{name}_JSQR is written while JADSTART is set");
            context.findings.add(text);
        }
        let changed = file.get(offset) ^ value;
        // Written with what it has, as embassy-stm32 does, it does no harm.
        if offset == self.differential && busy.enabled && changed != 0 {
            let text = format!("{name}_DIFSEL is changed while the converter is switched on");
            context.findings.add(text);
        }
        for (when, register, field, place) in &self.fields {
            let changes = place.offset == offset && changed & place.mask != 0;
            if let Some(cause) = when.forbids(busy).filter(|_| changes) {
                let text = format!("{name}_{register}: {field} is changed while {cause}");
                context.findings.add(text);
            }
        }
    }

    /// Reports functions that are asked for and are not modelled.
    pub fn check_unmodelled(&self, file: &RegisterFile, context: &mut Context<'_>) {
        for (register, field, place) in &self.unmodelled {
            if file.is_set(*place) {
                let name = file.block().name;
                context.findings.add(format!(
                    "{name}_{register}: {field} is set, which the emulator does not model"
                ));
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::*;
    use crate::bench::BOARD_CLOCKS;
    use crate::facts::Facts;
    use crate::findings::Findings;

    const IDLE: Busy = Busy {
        regular: false,
        injected: false,
        enabled: false,
        queue: false,
    };

    /// What a converter may be busy with, what is then forbidden, and the words for it.
    const STATES: [(Busy, &[While], &str); 3] = [
        (
            Busy {
                regular: true,
                ..IDLE
            },
            &[While::Regular, While::Either],
            "ADSTART is set",
        ),
        (
            Busy {
                injected: true,
                ..IDLE
            },
            &[While::Injected, While::Either],
            "JADSTART is set",
        ),
        (
            Busy {
                enabled: true,
                ..IDLE
            },
            &[While::Enabled],
            "the converter is switched on",
        ),
    ];

    /// What is found when a word is written to a converter in a state.
    fn found(file: &RegisterFile, place: (u32, u32), busy: Busy) -> Vec<String> {
        let mut findings = Findings::default();
        let mut context = Context {
            cycle: 0,
            clocks: &BOARD_CLOCKS,
            findings: &mut findings,
        };
        Rules::new(file).check(file, place, busy, &mut context);
        let list = findings.list().iter();
        list.map(|finding| finding.text.clone()).collect()
    }

    #[test]
    fn every_field_and_register_is_kept_where_the_manual_says() {
        let file = RegisterFile::new(Facts::chip().block("ADC1").unwrap());
        for (busy, forbidden, cause) in STATES {
            let expected = |when: &While, text: String| -> Vec<String> {
                let text = format!("ADC1_{text} while {cause}");
                forbidden
                    .contains(when)
                    .then_some(text)
                    .into_iter()
                    .collect()
            };
            let fields = FIELDS.iter();
            for (when, register, field) in fields
                .flat_map(|(when, register, all)| all.iter().map(move |f| (when, register, f)))
            {
                let place = file.field(register, field);
                let word = file.get(place.offset) ^ place.mask;
                let expected = expected(when, format!("{register}: {field} is changed"));
                assert_eq!(found(&file, (place.offset, word), busy), expected);
            }
            for (when, register) in REGISTERS {
                let offset = file.offset(register);
                let expected = expected(&when, format!("{register} is written"));
                assert_eq!(found(&file, (offset, file.get(offset)), busy), expected);
            }
        }
    }

    #[test]
    fn every_unmodelled_function_is_found() {
        for (register, fields) in UNMODELLED {
            for field in fields {
                let mut file = RegisterFile::new(Facts::chip().block("ADC1").unwrap());
                file.set_value(file.field(register, field), 1);
                let mut findings = Findings::default();
                let mut context = Context {
                    cycle: 0,
                    clocks: &BOARD_CLOCKS,
                    findings: &mut findings,
                };
                Rules::new(&file).check_unmodelled(&file, &mut context);
                let expected =
                    format!("ADC1_{register}: {field} is set, which the emulator does not model");
                let found = findings.list().iter().map(|one| one.text.as_str());
                assert_eq!(found.collect::<Vec<_>>(), [expected]);
            }
        }
    }
}
