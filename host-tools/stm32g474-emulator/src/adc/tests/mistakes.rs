//! What an image does wrong with a converter: a mistake, and the sentence that it is reported by.

use super::*;

/// Sets a field of the common registers.
fn common(bench: &mut DeviceBench<Board>, field: &str, value: u32) {
    select(bench, "ADC12_COMMON");
    bench.set("CCR", &[(field, value)]);
    select(bench, "ADC1");
}

type Mistake = fn(&mut DeviceBench<Board>);

/// Mistakes made after the board's set-up of ADC1, before its start; then it is started and triggered.
const MISTAKES: &[(Mistake, &str)] = &[
    (
        |b| b.set("CR", &[("ADVREGEN", 0)]),
        "ADC1_CR: DEEPPWD or ADVREGEN is changed while the converter is switched on",
    ),
    (
        |b| {
            b.set("CFGR", &[("EXTEN", 1)]);
            b.set("CR", &[("ADSTART", 1)]);
        },
        "ADC1_CFGR: EXTEN asks for a trigger of regular conversions, which the emulator does not model",
    ),
    (
        |b| common(b, "CKMODE", 1),
        "ADC12_COMMON_CCR: CKMODE is changed while ADC1 is switched on",
    ),
    (
        |b| common(b, "PRESC", 3),
        "ADC12_COMMON_CCR: PRESC is changed while ADC1 is switched on",
    ),
    (
        |b| common(b, "DUAL", 5),
        "ADC12_COMMON_CCR: DUAL is changed while ADC1 is switched on",
    ),
    (
        |b| common(b, "DUAL", 5),
        "ADC12_COMMON_CCR: DUAL is set, which the emulator does not model",
    ),
    (
        |b| b.set("SMPR", &[("SMP7", 2)]),
        "ADC1 samples input 7 for 294 ns, too short for a source of 1000 ohms",
    ),
    (
        |b| b.set("JSQR", &[("JSQ1", 9)]),
        "ADC1 converts input 9, whose pin is not in analogue mode or not connected",
    ),
    (
        |b| b.clocks.adc12 = 0,
        "ADC1 is to work, but its clock (ADCSEL of RCC_CCIPR) is none",
    ),
    (
        |b| b.clocks.adc12 = 340_000_000,
        "ADC1 runs at 85000000 Hz, above its limit of 52000000 Hz",
    ),
    (
        |b| b.set("CFGR2", &[("TROVS", 1)]),
        "ADC1_CFGR2: TROVS is set, which the emulator does not model",
    ),
    (
        |b| b.set("CR", &[("ADCAL", 1)]),
        "ADC1_CR: ADCAL is set while ADEN is set",
    ),
    (
        |b| b.set("CR", &[("ADCALDIF", 0)]),
        "ADC1_CR: ADCALDIF is changed while the converter is switched on",
    ),
    (
        |b| b.set("DIFSEL", &[("DIFSEL6", 1)]),
        "ADC1_DIFSEL is changed while the converter is switched on",
    ),
];

/// Mistakes made after the start.
const LATE_MISTAKES: &[(Mistake, &str)] = &[
    (
        |b| b.set("JSQR", &[]),
        "ADC1_JSQR is written while JADSTART is set",
    ),
    (
        |b| b.set("SMPR2", &[]),
        "ADC1_SMPR2 is written while JADSTART is set",
    ),
    (
        |b| b.set("CFGR", &[("RES", 1)]),
        "ADC1_CFGR: RES is changed while JADSTART is set",
    ),
    (
        |b| b.set("CFGR2", &[("OVSR", 1)]),
        "ADC1_CFGR2: OVSR is changed while JADSTART is set",
    ),
    (
        |b| b.set("CR", &[("ADDIS", 1)]),
        "ADC1_CR: ADDIS is set during conversions",
    ),
    (
        trigger,
        "ADC1: the injected sequence is triggered while it still runs",
    ),
];

/// Mistakes on the way up.
const EARLY_MISTAKES: &[(Mistake, &str)] = &[
    (
        |b| b.set("CR", &[("ADEN", 1)]),
        "ADC1_CR: ADEN is set without the regulator",
    ),
    (
        |b| b.set("CR", &[("ADSTART", 1)]),
        "ADC1_CR: ADSTART is set while ADEN is clear",
    ),
    (
        |b| b.set("CR", &[("ADDIS", 1)]),
        "ADC1_CR: ADDIS is set while ADEN is clear",
    ),
    (
        |b| {
            b.set("CR", &[("DEEPPWD", 0), ("ADVREGEN", 1)]);
            b.run(REGULATOR);
            b.set("CR", &[("ADCAL", 1)]);
            b.set("CR", &[("ADEN", 1)]);
        },
        "ADC1_CR: ADEN is set while ADCAL is set",
    ),
    (
        |b| {
            b.set("CR", &[("DEEPPWD", 0), ("ADVREGEN", 1)]);
            b.run(REGULATOR);
            b.set("CR", &[("ADEN", 1)]);
            b.set("CR", &[("JADSTART", 1)]);
        },
        "ADC1_CR: JADSTART is set before ADRDY",
    ),
    (
        |b| b.set("CR", &[("ADCAL", 1)]),
        "ADC1_CR: ADCAL is set without the regulator",
    ),
    (
        |b| {
            b.set("CR", &[("DEEPPWD", 0), ("ADVREGEN", 1)]);
            b.run(REGULATOR - 1);
            b.set("CR", &[("ADCAL", 1)]);
        },
        "ADC1_CR: ADCAL is set before the regulator has had its 20 µs",
    ),
    (
        |b| b.set("CR", &[("ADVREGEN", 1)]),
        "ADC1_CR: ADVREGEN is set in deep power-down",
    ),
    (
        |b| {
            b.set("CR", &[("DEEPPWD", 0), ("ADVREGEN", 1)]);
            b.run(REGULATOR);
            b.set("CR", &[("ADCAL", 1)]);
            b.run(112 + 3);
            b.set("CR", &[("ADEN", 1)]);
            assert_eq!(b.get("CR", "ADEN"), 0);
        },
        "ADC1_CR: ADEN is set within 4 converter periods after the calibration, and stays clear",
    ),
    (
        |b| b.set("CR", &[("JADSTART", 1)]),
        "ADC1_CR: JADSTART is set while ADEN is clear",
    ),
];

fn assert_found(bench: &mut DeviceBench<Board>, expected: &str) {
    let findings = bench.findings();
    let found = findings.iter().any(|text| text == expected);
    assert!(found, "{expected}: {findings:?}");
}

#[test]
fn mistakes_are_found() {
    for (mistake, expected) in MISTAKES {
        let mut bench = board();
        assert_eq!(bench.findings(), [""; 0]);
        mistake(&mut bench);
        bench.set("CR", &[("JADSTART", 1)]);
        trigger(&mut bench);
        bench.run(15_000);
        assert_found(&mut bench, expected);
    }
    for (mistake, expected) in LATE_MISTAKES {
        let mut bench = board();
        bench.set("CR", &[("JADSTART", 1)]);
        trigger(&mut bench);
        assert_eq!(bench.findings(), [""; 0]);
        mistake(&mut bench);
        assert_found(&mut bench, expected);
    }
    for (mistake, expected) in EARLY_MISTAKES {
        let mut bench = bench();
        mistake(&mut bench);
        assert_found(&mut bench, expected);
    }
}
