//! Each behaviour of the flash by its registers, as an image uses them.

#![allow(clippy::unwrap_used)]

mod ecc;

use super::Flash;
use super::array::START;
use crate::bench::DeviceBench;
use crate::device::Device;
use crate::memory_map::BANK_SIZE;

const PAGE: u32 = START + 0x7_c000;
const MS: u64 = 170_000;

fn bench(dual_bank: bool, seed: u64) -> DeviceBench<Flash> {
    let mut bench = DeviceBench::new("FLASH", |_| Flash::new(dual_bank, 0, seed));
    bench.cycle = 0;
    // A reset leaves the caches on.
    bench.write("ACR", 0);
    bench
}

impl DeviceBench<Flash> {
    fn word(&mut self, address: u32, value: u32) {
        self.act(|flash, context| flash.write_array(address, 4, value, context));
    }

    fn double_word(&mut self, address: u32, low: u32, high: u32) {
        self.word(address, low);
        self.word(address + 4, high);
    }

    fn open(&mut self) {
        self.write("KEYR", 0x4567_0123);
        self.write("KEYR", 0xcdef_89ab);
    }

    fn program(&mut self, address: u32, low: u32, high: u32) {
        self.open_for_program();
        self.double_word(address, low, high);
        self.cycle += MS;
    }

    fn open_for_program(&mut self) {
        self.open();
        self.put("CR", &[("PG", 1), ("EOPIE", 1), ("ERRIE", 1)]);
    }

    fn erase(&mut self, page: u32) {
        self.open();
        self.put(
            "CR",
            &[
                ("PER", 1),
                ("BKER", 1),
                ("PNB", page),
                ("EOPIE", 1),
                ("STRT", 1),
            ],
        );
    }

    fn status(&mut self, flag: &str) -> bool {
        self.get("SR", flag) != 0
    }

    fn word_at(&mut self, address: u32) -> u32 {
        self.act(|flash, context| flash.read_array(address, 4, context))
    }
}

/// RM0440, "Read-while-write": a read of the bank in work waits for the end, and gives what there is then.
#[test]
fn a_read_of_the_bank_in_work_waits() {
    let mut bench = bench(true, 1);
    bench.open_for_program();
    bench.word(PAGE, 0x0102_0304);
    bench.word(PAGE + 4, 0x0506_0708);
    let end = bench.device.next_event().unwrap();
    assert_eq!(bench.word_at(PAGE), 0x0102_0304);
    assert_eq!(bench.device.take_stall(), Some(end));
    assert_eq!(bench.device.take_stall(), None);
    assert_eq!(bench.word_at(PAGE), 0x0102_0304);
    assert_eq!(bench.device.take_stall(), None);
}

#[test]
fn a_double_word_takes_its_time_and_ends_with_an_interrupt() {
    let mut bench = bench(true, 1);
    bench.open_for_program();
    bench.word(PAGE, 0x0102_0304);
    assert!(!bench.status("BSY"));
    bench.word(PAGE + 4, 0x0506_0708);
    assert!(bench.status("BSY") && !bench.device.interrupt());
    let end = bench.device.next_event().unwrap();
    assert_eq!(end, 82 * 170);
    assert_eq!(bench.device.stall_until(START), None);
    assert_eq!(bench.device.stall_until(PAGE), Some(end));
    bench.cycle = end;
    bench.act(Flash::advance);
    assert!(!bench.status("BSY") && bench.device.interrupt());
    assert_eq!(bench.word_at(PAGE + 4), 0x0506_0708);
    bench.write("SR", u32::MAX);
    assert!(!bench.device.interrupt());
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn an_erase_takes_22_ms_and_only_its_page() {
    let mut bench = bench(true, 1);
    for address in [PAGE - 8, PAGE, PAGE + 2040, PAGE + 2048] {
        bench.device.load(address, &[0; 8]);
    }
    bench.erase(120);
    assert_eq!(bench.device.next_event(), Some(22 * MS));
    bench.cycle = 22 * MS;
    let words = [PAGE - 8, PAGE, PAGE + 2040, PAGE + 2048].map(|address| bench.word_at(address));
    assert_eq!(words, [0, u32::MAX, u32::MAX, 0]);
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn mistakes_are_found() {
    type Mistake = fn(&mut DeviceBench<Flash>);
    let cases: &[(&str, Mistake)] = &[
        (
            "FLASH: 0x0807c000 is written while FLASH_CR is locked",
            |b| b.word(PAGE, 1),
        ),
        ("FLASH: 0x0807c000 is written without PG in FLASH_CR", |b| {
            b.open();
            b.word(PAGE, 1);
        }),
        (
            "FLASH: 0x0807c000 is written while FLASH_SR says busy",
            |b| {
                b.erase(120);
                b.word(PAGE, 1);
            },
        ),
        ("FLASH: 0x0807c000 is written by less than a word", |b| {
            b.open_for_program();
            b.act(|flash, context| flash.write_array(PAGE, 1, 0, context));
        }),
        (
            "FLASH: 0x08080000 is written outside of a double word",
            |b| {
                b.open_for_program();
                b.word(START + 2 * BANK_SIZE, 1);
            },
        ),
        (
            "FLASH: the write to 0x0807c008 is not a double word with the one before",
            |b| {
                b.open_for_program();
                b.word(PAGE, 1);
                b.word(PAGE + 8, 1);
            },
        ),
        (
            "FLASH: the write to 0x0807c004 is not a double word with the one before",
            |b| {
                b.open_for_program();
                b.word(PAGE + 4, 1);
            },
        ),
        ("FLASH_CR is written while it is locked", |b| {
            b.put("CR", &[("PG", 1)]);
        }),
        ("FLASH_CR is written while FLASH_SR says busy", |b| {
            b.erase(120);
            b.put("CR", &[("PG", 1)]);
        }),
        (
            "FLASH_KEYR: a wrong key is written; FLASH_CR is locked until the next reset",
            |b| b.write("KEYR", 1),
        ),
        (
            "FLASH_KEYR: a key is written while FLASH_CR is open; FLASH_CR is locked until the next reset",
            |b| {
                b.open();
                b.write("KEYR", 0x4567_0123);
            },
        ),
        (
            "FLASH: the programming of 0x0807c000 finds it not erased",
            |b| {
                b.program(PAGE, 1, 1);
                b.write("SR", u32::MAX);
                b.double_word(PAGE, 2, 2);
            },
        ),
        (
            "FLASH_SR: errors were not cleared before the programming of 0x0807c000, which does not start",
            |b| {
                let errors = b.device.flags.errors;
                let status = b.device.registers.offset("SR");
                b.device.registers.set(status, errors);
                b.program(PAGE, 1, 1);
            },
        ),
        (
            "FLASH: the programming of 0x0807c7f8 touches a page of the program",
            |b| {
                b.device.set_program(PAGE - 100..PAGE + 4);
                b.program(PAGE + 2040, 1, 1);
            },
        ),
        (
            "FLASH: the erase of 2 KiB from 0x0807c000 on stalls the program, which runs from the same bank",
            |b| {
                b.device.set_program(PAGE - 4096..PAGE - 2048);
                b.erase(120);
            },
        ),
        (
            "FLASH_ACR: the data cache is on during programming or an erase, which may corrupt what it holds",
            |b| {
                b.put("ACR", &[("DCEN", 1)]);
                b.program(PAGE, 1, 1);
            },
        ),
        (
            "FLASH_ACR: DCRST is set while that cache is on, and has no effect",
            |b| {
                b.put("ACR", &[("DCEN", 1)]);
                b.put("ACR", &[("DCRST", 1)]);
            },
        ),
        (
            "FLASH_ACR: ICRST is set while that cache is on, and has no effect",
            |b| {
                b.put("ACR", &[("ICEN", 1)]);
                b.put("ACR", &[("ICRST", 1)]);
            },
        ),
        (
            "FLASH_CR: STRT is set without just one of PG, PER and MER",
            |b| {
                b.open();
                b.put("CR", &[("STRT", 1)]);
            },
        ),
        (
            "FLASH_CR: STRT is set without just one of PG, PER and MER",
            |b| {
                b.open();
                b.put("CR", &[("PG", 1), ("PER", 1), ("STRT", 1)]);
            },
        ),
        (
            "FLASH_CR: fast programming or a change of the option bytes is asked for, which this image must not",
            |b| {
                b.open();
                b.put("CR", &[("FSTPG", 1)]);
            },
        ),
        (
            "FLASH_PDKEYR or FLASH_OPTKEYR is written: power-down and option bytes are not for this image",
            |b| b.write("OPTKEYR", 0x0819_2a3b),
        ),
        (
            "FLASH: the register at 0x20 is written while the option bytes are locked",
            |b| b.write("OPTR", 0),
        ),
    ];
    for (part, mistake) in cases {
        let mut bench = bench(true, 1);
        mistake(&mut bench);
        assert_eq!(bench.findings(), [*part]);
    }
}

#[test]
fn a_wrong_key_locks_until_a_reset() {
    let mut bench = bench(true, 1);
    bench.write("KEYR", 0x4567_0123);
    bench.write("KEYR", 0x4567_0123);
    bench.open();
    let expected = [
        "FLASH_KEYR: a wrong key is written; FLASH_CR is locked until the next reset",
        "FLASH_KEYR: a key is written after a wrong one; FLASH_CR is locked until the next reset",
    ];
    assert_eq!(bench.findings(), expected);
    let lock = bench.device.registers.field("CR", "LOCK").mask;
    assert_ne!(bench.read("CR") & lock, 0);
    bench.device.reset();
    bench.open();
    assert_eq!(bench.read("CR") & lock, 0);
}

#[test]
fn zeros_may_be_written_over_anything() {
    let mut bench = bench(true, 1);
    bench.program(PAGE, 1, 1);
    bench.device.damage(PAGE);
    bench.write("SR", u32::MAX);
    bench.double_word(PAGE, 0, 0);
    bench.cycle += MS;
    assert_eq!(bench.word_at(PAGE), 0);
    assert!(!bench.device.nmi());
    assert_eq!(bench.findings(), [""; 0]);
}

#[test]
fn one_bank_stalls_for_every_operation_and_has_pages_of_4_kib() {
    let mut bench = bench(false, 1);
    bench.device.load(START + 4096, &[0; 4096]);
    bench.open();
    bench.put("CR", &[("PER", 1), ("PNB", 1), ("STRT", 1)]);
    assert_eq!(
        bench.device.stall_until(START + BANK_SIZE),
        bench.device.next_event()
    );
    bench.cycle = 22 * MS;
    assert_eq!(bench.word_at(START + 8188), u32::MAX);
    let dbank = bench.device.registers.field("OPTR", "DBANK").mask;
    assert_eq!(bench.read("OPTR") & dbank, 0);
}

#[test]
fn a_cut_leaves_a_double_word_erased_complete_or_damaged() {
    let mut seen = [0; 3];
    for seed in 0..60 {
        let mut bench = bench(true, seed);
        bench.open_for_program();
        bench.double_word(PAGE, 0x1111_2222, 0x3333_4444);
        bench.device.cut_power();
        let offset = PAGE - START;
        let value = bench.device.array().double_word(offset);
        let kind = match (bench.device.array().is_damaged(offset), value) {
            (true, _) => 2,
            (false, 0x3333_4444_1111_2222) => 1,
            (false, u64::MAX) => 0,
            other => panic!("{other:?}"),
        };
        seen[kind] += 1;
        assert_eq!(bench.device.next_event(), None);
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

#[test]
fn a_cut_erase_leaves_a_mix_that_its_seed_decides() {
    let page = |seed| {
        let mut bench = bench(true, seed);
        bench.device.load(PAGE, &[0x5a; 2048]);
        bench.erase(120);
        bench.device.reset();
        let array = bench.device.array();
        let words = (0..2048u32).step_by(8);
        words
            .map(|at| array.double_word(PAGE - START + at))
            .collect::<Vec<_>>()
    };
    assert_eq!(page(3), page(3));
    let pages = (0..20).map(page).collect::<Vec<_>>();
    let old = 0x5a5a_5a5a_5a5a_5a5a;
    let mixed = |page: &&Vec<u64>| {
        let erased = page.iter().filter(|word| **word == u64::MAX).count();
        let kept = page.iter().filter(|word| **word == old).count();
        erased > 0 && kept > 0 && erased + kept < page.len()
    };
    assert!(pages.iter().filter(mixed).count() > 3);
    // An erase sets bits, and clears none.
    assert!(pages.iter().flatten().all(|word| word & old == old));
}
