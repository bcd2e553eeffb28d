//! What `LOCK` in `BDTR` protects until the next reset.

use crate::device::{Context, FieldPlace, RegisterFile};

/// By level: register and fields. Those of `BDTR` and that `LOCK` can be written once: ST's `stm32g4xx_ll_tim.h`. The
/// others: by memory of the manual, at `LOCK` and at each field.
const LOCKED: [(u32, &str, &[&str]); 9] = [
    (
        1,
        "BDTR",
        &[
            "DTG", "BKE0", "BKP0", "BKF0", "BKBID0", "BKE1", "BKP1", "BKF1", "BK2BID", "AOE",
        ],
    ),
    (
        1,
        "CR2",
        &[
            "OIS0", "OIS1", "OIS2", "OIS3", "OIS4", "OIS5", "OISN0", "OISN1", "OISN2", "OISN3",
        ],
    ),
    (1, "AF1", &["BKINE", "BKINP"]),
    (1, "AF2", &["BK2INE", "BK2INP"]),
    (1, "DTR2", &["DTGF", "DTAE", "DTPE"]),
    (2, "BDTR", &["OSSI", "OSSR"]),
    (
        2,
        "CCER",
        &[
            "CCP0", "CCP1", "CCP2", "CCP3", "CCP4", "CCP5", "CCNP0", "CCNP1", "CCNP2", "CCNP3",
        ],
    ),
    (3, "CCMR1", &["OCM0", "OCPE0", "OCM1", "OCPE1"]),
    (3, "CCMR2", &["OCM0", "OCPE0", "OCM1", "OCPE1"]),
];

/// The lock of an advanced timer.
#[derive(Clone, Debug)]
pub struct Lock {
    level: FieldPlace,
    locked: Vec<(u32, &'static str, &'static str, FieldPlace)>,
    /// `BDTR` has been written: its `LOCK` is final.
    is_final: bool,
}

impl Lock {
    /// Open, as after a reset.
    #[must_use]
    pub fn new(file: &RegisterFile) -> Self {
        let fields = LOCKED.iter().flat_map(|(level, register, fields)| {
            fields
                .iter()
                .map(move |field| (*level, *register, *field, file.field(register, field)))
        });
        Self {
            level: file.field("BDTR", "LOCK"),
            locked: fields.collect(),
            is_final: false,
        }
    }

    /// As after a reset.
    pub fn reset(&mut self) {
        self.is_final = false;
    }

    /// What of a write gets through. A locked field that would change is a finding.
    pub fn pass(
        &mut self,
        file: &RegisterFile,
        offset: u32,
        value: u32,
        context: &mut Context<'_>,
    ) -> u32 {
        let (old, level) = (file.get(offset), file.value(self.level));
        let mut passed = value;
        for (at, register, field, place) in &self.locked {
            if place.offset == offset && *at <= level {
                if (old ^ value) & place.mask != 0 {
                    let name = file.block().name;
                    context.findings.add(format!(
                        "{name}_{register}: {field} is written with another value, but LOCK level {level} protects it"
                    ));
                }
                passed = (passed & !place.mask) | (old & place.mask);
            }
        }
        if offset == self.level.offset {
            passed = self.pass_level(file, passed, context);
        }
        passed
    }

    /// `LOCK` itself can be written once.
    fn pass_level(&mut self, file: &RegisterFile, value: u32, context: &mut Context<'_>) -> u32 {
        let kept = file.value(self.level);
        if !std::mem::replace(&mut self.is_final, true) || self.level.extract(value) == kept {
            return value;
        }
        let name = file.block().name;
        let text = format!("{name}_BDTR: LOCK is written again, but its first value is final");
        context.findings.add(text);
        self.level.insert(value, kept)
    }
}
