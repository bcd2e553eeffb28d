use super::*;
use crate::bench::DeviceBench;

fn bench() -> DeviceBench<Tim1> {
    DeviceBench::new("TIM1", Tim1::new)
}

/// As the image sets it up, running, its outputs off and its pins at rest.
fn board() -> DeviceBench<Tim1> {
    let mut bench = bench();
    bench.act(|timer, context| timer.set_break_input(0, true, context));
    bench.set("CR1", &[("CMS", 1), ("ARPE", 1)]);
    bench.write("ARR", 2125);
    bench.write("RCR", 9);
    for (register, field) in [("CCMR1", 0), ("CCMR1", 1), ("CCMR2", 0)] {
        let (mode, preload) = (format!("OCM{field}"), format!("OCPE{field}"));
        bench.set(register, &[(&mode, 6), (&preload, 1)]);
    }
    bench.set("CCER", &[("CCE0", 1), ("CCE1", 1), ("CCE2", 1)]);
    bench.set("CR2", &[("MMS2", 2)]);
    bench.set("AF1", &[("BKINE", 1)]);
    bench.set("AF2", &[("BK2INE", 1)]);
    bench.set(
        "BDTR",
        &[
            ("BKE0", 1),
            ("BKF0", 9),
            ("BKE1", 1),
            ("BKP1", 1),
            ("BKF1", 9),
            ("OSSI", 1),
            ("OSSR", 1),
            ("LOCK", 1),
        ],
    );
    bench.run(200);
    bench.write("EGR", 1);
    bench.write("SR", 0);
    bench.act(|timer, _| timer.take_trigger());
    bench.set("CR1", &[("CEN", 1)]);
    bench
}

fn set_pin(bench: &mut DeviceBench<Tim1>, input: usize, level: bool) {
    bench.act(|timer, context| timer.set_break_input(input, level, context));
}

#[test]
fn an_update_comes_after_as_many_halves_as_the_repetition_counter_says() {
    for (centre, prescaler, repetitions, period, count) in [
        (1, 0, 9, 21_250, 0),
        (1, 0, 8, 19_125, 2_125),
        (1, 3, 1, 17_000, 0),
        (0, 0, 9, 21_260, 0),
    ] {
        let mut bench = bench();
        bench.set("CR1", &[("CMS", centre), ("ARPE", 1)]);
        bench.write("PSC", prescaler);
        bench.write("ARR", 2125);
        bench.write("RCR", repetitions);
        bench.set("CR2", &[("MMS2", 2)]);
        bench.write("EGR", 1);
        assert_eq!(bench.device.take_trigger(), Some(1_000));
        bench.write("SR", 0);
        bench.set("CR1", &[("CEN", 1)]);
        assert_eq!(bench.device.update_period_cycles(), period);
        bench.run(period - 1);
        assert_eq!(
            (bench.get("SR", "UIF"), bench.device.take_trigger()),
            (0, None)
        );
        bench.run(1);
        assert_eq!(bench.device.take_trigger(), Some(1_000 + period));
        assert_eq!((bench.get("SR", "UIF"), bench.read("CNT")), (1, count));
    }
}

#[test]
fn preloaded_values_take_effect_at_the_update() {
    let mut bench = board();
    bench.set("BDTR", &[("MOE", 1)]);
    bench.run(30_000);
    bench.write("CCR1", 100);
    bench.write("CCR3", 2125);
    assert_eq!(bench.device.outputs().high, [0, 0, 0].map(Some));
    bench.run_to(1_200 + 2 * 21_250);
    assert_eq!(bench.device.outputs().high, [100, 0, 2125].map(Some));
    assert_eq!(bench.device.outputs().top, 2125);
}

#[test]
fn a_break_switches_off_once_it_has_lasted_as_long_as_the_filter() {
    for (input, active, flag) in [(0, false, "BIF0"), (1, true, "BIF1")] {
        let mut bench = board();
        bench.set("BDTR", &[("MOE", 1)]);
        bench.set("DIER", &[("BIE", 1)]);
        for (cycles, switched) in [(63, 1), (64, 0)] {
            set_pin(&mut bench, input, active);
            bench.run(cycles);
            assert_eq!(bench.get("BDTR", "MOE"), switched, "{input} {cycles}");
            assert_eq!(bench.get("SR", flag), 1 - switched);
            assert_eq!(bench.device.interrupts()[0].1, switched == 0);
            if switched == 1 {
                set_pin(&mut bench, input, !active);
            }
        }
        // While it lasts it can neither be cleared nor overruled.
        bench.write("SR", 0);
        bench.set("BDTR", &[("MOE", 1)]);
        assert_eq!((bench.get("SR", flag), bench.get("BDTR", "MOE")), (1, 0));
        set_pin(&mut bench, input, !active);
        bench.run(64);
        bench.write("SR", 0);
        bench.set("BDTR", &[("MOE", 1)]);
        assert_eq!((bench.get("SR", flag), bench.get("BDTR", "MOE")), (0, 1));
        assert_eq!(bench.findings(), [""; 0]);
    }
}

#[test]
fn what_is_armed_before_its_pin_is_routed_breaks() {
    let mut bench = bench();
    bench.set("AF1", &[("BKINE", 1)]);
    bench.set("BDTR", &[("BKE0", 1)]);
    assert_eq!(bench.get("SR", "BIF0"), 1);
}

#[test]
fn the_chip_can_break() {
    let mut bench = board();
    bench.set("BDTR", &[("MOE", 1)]);
    bench.act(|timer, context| timer.set_system_break(true, context));
    bench.write("SR", 0);
    bench.set("BDTR", &[("MOE", 1)]);
    assert_eq!((bench.get("SR", "SBIF"), bench.get("BDTR", "MOE")), (1, 0));
    bench.act(|timer, context| timer.set_system_break(false, context));
    bench.write("SR", 0);
    bench.set("BDTR", &[("MOE", 1)]);
    assert_eq!((bench.get("SR", "SBIF"), bench.get("BDTR", "MOE")), (0, 1));
}

#[test]
fn what_is_locked_stays() {
    for (register, field, value, kept) in [
        ("BDTR", "BKP0", 1, true),
        ("BDTR", "BKF1", 0, true),
        ("BDTR", "LOCK", 0, true),
        ("BDTR", "DTG", 9, true),
        ("BDTR", "MOE", 1, false),
        ("AF1", "BKINP", 1, true),
        ("CR2", "OIS0", 1, true),
        ("CCER", "CCP0", 1, false),
        ("CCMR1", "OCM0", 7, false),
    ] {
        let mut bench = board();
        let before = bench.get(register, field);
        bench.set(register, &[(field, value)]);
        let after = bench.get(register, field);
        assert_eq!(after, if kept { before } else { value }, "{field}");
        let findings = bench.findings();
        assert_eq!(findings.len(), usize::from(kept), "{field} {findings:?}");
        let expected = if field == "LOCK" {
            "TIM1_BDTR: LOCK is written again, but its first value is final".into()
        } else {
            format!(
                "TIM1_{register}: {field} is written with another value, but LOCK level 1 protects it"
            )
        };
        assert!(
            findings.iter().all(|text| *text == expected),
            "{findings:?}"
        );
    }
}

#[test]
fn a_reset_opens_the_lock() {
    let mut bench = board();
    bench.device.reset();
    bench.set("BDTR", &[("BKP0", 1), ("LOCK", 2)]);
    assert_eq!((bench.get("BDTR", "BKP0"), bench.findings().len()), (1, 0));
}

#[test]
fn pins_carry_what_mode_polarity_and_switch_say() {
    type Change = (&'static str, &'static str, u32);
    let cases: [(&[Change], Option<u16>); 8] = [
        (&[], Some(500)),
        (&[("CCMR1", "OCM0", 7)], Some(1_625)),
        (&[("CCER", "CCP0", 1)], Some(1_625)),
        (&[("CCMR1", "OCM0", 4)], Some(0)),
        (&[("CCER", "CCE0", 0)], Some(0)),
        (&[("CCER", "CCE0", 0), ("BDTR", "OSSR", 0)], None),
        (&[("BDTR", "MOE", 0)], Some(0)),
        (&[("BDTR", "MOE", 0), ("BDTR", "OSSI", 0)], None),
    ];
    for (changes, high) in cases {
        let mut bench = board();
        bench.write("CCR1", 500);
        bench.run(21_250);
        bench.set("BDTR", &[("MOE", 1)]);
        for (register, field, value) in changes {
            bench.set(register, &[(field, *value)]);
        }
        assert_eq!(bench.device.outputs().high[0], high, "{changes:?}");
    }
}

#[test]
fn the_second_break_wants_driven_pins() {
    let mut bench = bench();
    bench.set("BDTR", &[("BKE1", 1), ("BKP1", 1), ("OSSI", 1)]);
    let expected = "TIM1_BDTR: BK2E is set without OSSI and OSSR";
    assert_eq!(bench.findings(), [expected]);
}

#[test]
fn complementary_outputs_are_reported() {
    let mut bench = bench();
    bench.set("CCER", &[("CCNE1", 1)]);
    let expected = "TIM1_CCER: a complementary output is enabled, which is not modelled";
    assert_eq!(bench.findings(), [expected]);
}

#[test]
fn alignment_stays_while_it_counts() {
    let mut bench = board();
    bench.set("CR1", &[("CMS", 2)]);
    assert_eq!(
        bench.findings(),
        ["TIM1_CR1: CMS is changed while the counter runs"]
    );
}
