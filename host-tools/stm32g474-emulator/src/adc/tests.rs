#![allow(clippy::unwrap_used)]

mod mistakes;

use super::*;
use crate::bench::{BOARD_CLOCKS, DeviceBench};
use crate::device::Device;
use crate::facts::Block;

/// Cycles of the processor in a period of the converters' clock, and in the regulator's start.
const PERIOD: u64 = 4;
const REGULATOR: u64 = 3_400;

/// The inputs of the board, by converter and number.
struct Inputs(Vec<(&'static str, u8, u16)>);

impl AnalogueInputs for Inputs {
    fn sum16(&self, converter: &str, input: u8) -> Option<u16> {
        let mut all = self.0.iter();
        let found = all.find(|(name, number, _)| (*name, *number) == (converter, input));
        found.map(|(_, _, sum)| *sum)
    }
}

/// The converters behind one block's registers.
struct Board {
    converters: AdcConverters,
    block: &'static str,
    inputs: Inputs,
}

impl Device for Board {
    fn reset(&mut self) {
        self.converters.reset(self.block);
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        self.converters
            .read(self.block, offset, &self.inputs, context)
            .unwrap()
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        self.converters
            .write(self.block, (offset, value), &self.inputs, context)
            .unwrap();
    }

    fn next_event(&self) -> Option<u64> {
        self.converters.next_event()
    }

    fn advance(&mut self, context: &mut Context<'_>) {
        self.converters.advance(&self.inputs, context);
    }
}

fn bench() -> DeviceBench<Board> {
    let inputs = vec![
        ("ADC1", 6, 1_003),
        ("ADC1", 7, 65_520),
        ("ADC1", 8, 30_017),
        ("ADC2", 17, 1),
        ("ADC2", 3, 0),
        ("ADC2", 4, 4_095),
        ("ADC3", 1, 47_001),
    ];
    let mut bench = DeviceBench::new("ADC1", |_: &'static Block| Board {
        converters: AdcConverters::new(Facts::chip()),
        block: "ADC1",
        inputs: Inputs(inputs),
    });
    bench.set("CR", &[("DEEPPWD", 1), ("ADVREGEN", 0)]);
    bench.set("CFGR", &[("JQDIS", 1)]);
    bench
}

fn select(bench: &mut DeviceBench<Board>, block: &'static str) {
    bench.device.block = block;
    bench.select(block);
}

/// As embassy-stm32 brings a converter up.
fn bring_up(bench: &mut DeviceBench<Board>, common: &'static str, name: &'static str) {
    select(bench, common);
    bench.set("CCR", &[("PRESC", 2)]);
    select(bench, name);
    bench.set("CR", &[("DEEPPWD", 0), ("ADVREGEN", 1)]);
    bench.run(REGULATOR);
    for differential in [0, 1] {
        bench.set("CR", &[("ADCALDIF", differential)]);
        bench.set("CR", &[("ADCAL", 1)]);
        bench.run(111 * PERIOD);
        assert_eq!(bench.get("CR", "ADCAL"), 1);
        bench.run(PERIOD);
        assert_eq!(bench.get("CR", "ADCAL"), 0);
        bench.run(REGULATOR);
    }
    bench.set("CR", &[("ADEN", 1)]);
    bench.run(15 * PERIOD);
    assert_eq!(bench.get("ISR", "ADRDY"), 1);
    bench.set("CFGR2", &[("OVSR", 3)]);
}

/// As the image sets up its injected sequences, up to their start.
fn wait_for_timer(bench: &mut DeviceBench<Board>, name: &'static str, inputs: [u32; 3]) {
    bring_up(bench, "ADC12_COMMON", name);
    bench.set("CFGR2", &[("JOVSE", 1)]);
    for input in inputs {
        let (register, number) = if input < 10 {
            ("SMPR", input)
        } else {
            ("SMPR2", input - 10)
        };
        bench.set(register, &[(&format!("SMP{number}"), 4)]);
    }
    bench.set("JSQR", &[("JEXTSEL", 8), ("JEXTEN", 1), ("JL", 2)]);
    for (rank, input) in inputs.into_iter().enumerate() {
        bench.set("JSQR", &[(&format!("JSQ{rank}"), input)]);
    }
    bench.set("IER", &[("JEOSIE", u32::from(name == "ADC1"))]);
}

fn board() -> DeviceBench<Board> {
    let mut bench = bench();
    wait_for_timer(&mut bench, "ADC2", [17, 3, 4]);
    bench.set("CR", &[("JADSTART", 1)]);
    wait_for_timer(&mut bench, "ADC1", [6, 7, 8]);
    bench
}

fn trigger(bench: &mut DeviceBench<Board>) {
    let cycle = bench.cycle;
    bench.act(|board, context| board.converters.trigger(cycle, &board.inputs, context));
}

#[test]
fn the_board_reads_its_sums_in_time() {
    let mut bench = board();
    bench.set("CR", &[("JADSTART", 1)]);
    for _ in 0..2 {
        trigger(&mut bench);
        bench.run(11_519);
        assert!(!bench.device.converters.interrupts()[0].1);
        bench.run(1);
        assert_eq!(
            bench.device.converters.interrupts(),
            [("ADC1_2", true), ("ADC3", false)]
        );
        for (name, codes) in [("ADC1", [1_003, 65_520, 30_017]), ("ADC2", [1, 0, 4_095])] {
            select(&mut bench, name);
            assert_eq!(bench.get("ISR", "JEOS"), 1);
            bench.write("ISR", 0b100_0000);
            assert_eq!(bench.get("ISR", "JEOS"), 0);
            let converters = &bench.device.converters;
            let kept = [0, 1, 2].map(|rank| converters.injected_code(name, rank));
            assert_eq!(kept, codes.map(Some));
            // The harness's look has done nothing, the program's read takes the flag.
            for (register, (code, flag)) in ["JDR1", "JDR2", "JDR3"]
                .into_iter()
                .zip(codes.into_iter().zip([1, 0, 0]))
            {
                assert_eq!(
                    (bench.get("ISR", "JEOC"), bench.read(register)),
                    (flag, code)
                );
            }
        }
        assert!(!bench.device.converters.interrupts()[0].1);
    }
    let time = bench
        .device
        .converters
        .injected_cycles("ADC1", &BOARD_CLOCKS);
    assert_eq!(time, Some(11_520));
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn a_program_reads_an_input() {
    // Oversampled or not, with 12 and with 8 bits.
    for (oversampled, bits, code, halves) in [
        (1, 0, 47_001, 16 * (185 + 25)),
        (0, 0, 47_001 / 16, 185 + 25),
        (0, 2, 47_001 / 256, 185 + 17),
    ] {
        let mut bench = bench();
        bring_up(&mut bench, "ADC345_COMMON", "ADC3");
        bench.set("CFGR2", &[("ROVSE", oversampled), ("ROVSM", 0)]);
        bench.set("CFGR", &[("RES", bits)]);
        bench.set("SMPR", &[("SMP1", 5)]);
        bench.set("SQR1", &[("L", 0), ("SQ0", 1)]);
        for _ in 0..2 {
            bench.write("ISR", 0b1100);
            bench.set("CR", &[("ADSTART", 1)]);
            bench.run(halves * PERIOD / 2 - 1);
            assert_eq!(
                (bench.get("ISR", "EOS"), bench.get("CR", "ADSTART")),
                (0, 1)
            );
            bench.run(1);
            assert_eq!(
                (bench.get("ISR", "EOS"), bench.get("CR", "ADSTART")),
                (1, 0)
            );
            assert_eq!((bench.read("DR"), bench.get("ISR", "EOC")), (code, 0));
        }
        assert_eq!((bench.get("ISR", "OVR"), bench.findings().len()), (0, 0));
    }
}

#[test]
fn what_is_not_read_is_overrun() {
    let mut bench = bench();
    bring_up(&mut bench, "ADC345_COMMON", "ADC3");
    bench.set("SMPR", &[("SMP1", 5)]);
    bench.set("SQR1", &[("L", 1), ("SQ0", 1), ("SQ1", 1)]);
    bench.set("CR", &[("ADSTART", 1)]);
    bench.run(1_000);
    assert_eq!((bench.get("ISR", "OVR"), bench.get("ISR", "EOS")), (1, 1));
}

#[test]
fn a_reset_forgets_the_calibration() {
    let mut bench = board();
    bench.act(|board, _| board.converters.reset("ADC12_COMMON"));
    assert_eq!(bench.get("CR", "ADEN"), 0);
    select(&mut bench, "ADC12_COMMON");
    bench.set("CCR", &[("PRESC", 2)]);
    select(&mut bench, "ADC1");
    bench.set("CR", &[("DEEPPWD", 0), ("ADVREGEN", 1)]);
    bench.run(REGULATOR);
    bench.set("CR", &[("ADEN", 1)]);
    bench.run(15 * PERIOD);
    bench.set("SMPR", &[("SMP6", 4)]);
    bench.set("JSQR", &[("JSQ0", 6)]);
    assert_eq!(bench.findings(), [""; 0]);
    bench.set("CR", &[("JADSTART", 1)]);
    let expected = "ADC1 converts without a calibration since its power-up";
    assert_eq!(bench.findings(), [expected]);
}

#[test]
fn a_change_of_the_queue_forgets_the_sequence() {
    let mut bench = board();
    bench.set("CFGR", &[("JQDIS", 0)]);
    assert_eq!(bench.read("JSQR"), 0);
}

#[test]
fn another_trigger_or_edge_does_not_start_it() {
    for change in [("JEXTSEL", 9), ("JEXTEN", 2)] {
        let mut bench = board();
        bench.set("JSQR", &[change]);
        bench.set("CR", &[("JADSTART", 1)]);
        trigger(&mut bench);
        bench.run(20_000);
        assert_eq!(bench.get("ISR", "JEOS"), 0);
    }
}
