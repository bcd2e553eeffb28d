//! Each behaviour of the flash by its registers, as an image uses them.

#![allow(clippy::unwrap_used)]

use super::Flash;
use super::array::START;
use crate::clocks::Clocks;
use crate::device::{Context, Device};
use crate::findings::Findings;
use crate::memory_map::BANK_SIZE;

const CLOCKS: Clocks = Clocks {
    hclk: 170_000_000,
    ..Clocks::RESET
};
const PAGE: u32 = START + 0x7_c000;
const MS: u64 = 170_000;

struct Bench {
    flash: Flash,
    findings: Findings,
    cycle: u64,
}

impl Bench {
    fn new(dual_bank: bool, seed: u64) -> Self {
        let mut bench = Self {
            flash: Flash::new(dual_bank, 0, seed),
            findings: Findings::default(),
            cycle: 0,
        };
        // A reset leaves the caches on.
        bench.put("ACR", 0);
        bench
    }

    fn context<T>(&mut self, action: impl FnOnce(&mut Flash, &mut Context<'_>) -> T) -> T {
        let mut context = Context {
            cycle: self.cycle,
            clocks: &CLOCKS,
            findings: &mut self.findings,
        };
        action(&mut self.flash, &mut context)
    }

    fn offset(&self, register: &str) -> u32 {
        self.flash.registers.offset(register)
    }

    fn get(&mut self, register: &str) -> u32 {
        let offset = self.offset(register);
        self.context(|flash, context| flash.read(offset, context))
    }

    fn set(&mut self, register: &str, fields: &[(&str, u32)]) {
        let file = &self.flash.registers;
        let value = fields.iter().fold(0, |word, (name, value)| {
            file.field(register, name).insert(word, *value)
        });
        self.put(register, value);
    }

    fn put(&mut self, register: &str, value: u32) {
        let offset = self.offset(register);
        self.context(|flash, context| flash.write(offset, value, context));
    }

    fn word(&mut self, address: u32, value: u32) {
        self.context(|flash, context| flash.write_array(address, 4, value, context));
    }

    fn double_word(&mut self, address: u32, low: u32, high: u32) {
        self.word(address, low);
        self.word(address + 4, high);
    }

    fn open(&mut self) {
        self.put("KEYR", 0x4567_0123);
        self.put("KEYR", 0xcdef_89ab);
    }

    fn program(&mut self, address: u32, low: u32, high: u32) {
        self.open_for_program();
        self.double_word(address, low, high);
        self.cycle += MS;
    }

    fn open_for_program(&mut self) {
        self.open();
        self.set("CR", &[("PG", 1), ("EOPIE", 1), ("ERRIE", 1)]);
    }

    fn erase(&mut self, page: u32) {
        self.open();
        self.set(
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
        let mask = self.flash.registers.field("SR", flag).mask;
        self.get("SR") & mask != 0
    }

    fn read(&mut self, address: u32) -> u32 {
        self.context(|flash, context| flash.read_array(address, 4, context))
    }

    fn texts(&self) -> Vec<&str> {
        let list = self.findings.list();
        list.iter().map(|finding| finding.text.as_str()).collect()
    }
}

/// RM0440, "Read-while-write": a read of the bank in work waits for the end, and gives what there is then.
#[test]
fn a_read_of_the_bank_in_work_waits() {
    let mut bench = Bench::new(true, 1);
    bench.open_for_program();
    bench.word(PAGE, 0x0102_0304);
    bench.word(PAGE + 4, 0x0506_0708);
    let end = bench.flash.next_event().unwrap();
    assert_eq!(bench.read(PAGE), 0x0102_0304);
    assert_eq!(bench.flash.take_stall(), Some(end));
    assert_eq!(bench.flash.take_stall(), None);
    assert_eq!(bench.read(PAGE), 0x0102_0304);
    assert_eq!(bench.flash.take_stall(), None);
}

#[test]
fn a_double_word_takes_its_time_and_ends_with_an_interrupt() {
    let mut bench = Bench::new(true, 1);
    bench.open_for_program();
    bench.word(PAGE, 0x0102_0304);
    assert!(!bench.status("BSY"));
    bench.word(PAGE + 4, 0x0506_0708);
    assert!(bench.status("BSY") && !bench.flash.interrupt());
    let end = bench.flash.next_event().unwrap();
    assert_eq!(end, 82 * 170);
    assert_eq!(bench.flash.stall_until(START), None);
    assert_eq!(bench.flash.stall_until(PAGE), Some(end));
    bench.cycle = end;
    bench.context(Flash::advance);
    assert!(!bench.status("BSY") && bench.flash.interrupt());
    assert_eq!(bench.read(PAGE + 4), 0x0506_0708);
    bench.put("SR", u32::MAX);
    assert!(!bench.flash.interrupt());
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn an_erase_takes_22_ms_and_only_its_page() {
    let mut bench = Bench::new(true, 1);
    for address in [PAGE - 8, PAGE, PAGE + 2040, PAGE + 2048] {
        bench.flash.load(address, &[0; 8]);
    }
    bench.erase(120);
    assert_eq!(bench.flash.next_event(), Some(22 * MS));
    bench.cycle = 22 * MS;
    let words = [PAGE - 8, PAGE, PAGE + 2040, PAGE + 2048].map(|address| bench.read(address));
    assert_eq!(words, [0, u32::MAX, u32::MAX, 0]);
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn mistakes_are_found() {
    type Mistake = fn(&mut Bench);
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
            b.context(|flash, context| flash.write_array(PAGE, 1, 0, context));
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
            b.set("CR", &[("PG", 1)]);
        }),
        ("FLASH_CR is written while FLASH_SR says busy", |b| {
            b.erase(120);
            b.set("CR", &[("PG", 1)]);
        }),
        (
            "FLASH_KEYR: a wrong key is written; FLASH_CR is locked until the next reset",
            |b| b.put("KEYR", 1),
        ),
        (
            "FLASH_KEYR: a key is written while FLASH_CR is open; FLASH_CR is locked until the next reset",
            |b| {
                b.open();
                b.put("KEYR", 0x4567_0123);
            },
        ),
        (
            "FLASH: the programming of 0x0807c000 finds it not erased",
            |b| {
                b.program(PAGE, 1, 1);
                b.put("SR", u32::MAX);
                b.double_word(PAGE, 2, 2);
            },
        ),
        (
            "FLASH_SR: errors were not cleared before the programming of 0x0807c000, which does not start",
            |b| {
                let errors = b.flash.flags.errors;
                let status = b.offset("SR");
                b.flash.registers.set(status, errors);
                b.program(PAGE, 1, 1);
            },
        ),
        (
            "FLASH: the programming of 0x0807c7f8 touches a page of the program",
            |b| {
                b.flash.set_program(PAGE - 100..PAGE + 4);
                b.program(PAGE + 2040, 1, 1);
            },
        ),
        (
            "FLASH: the erase of 2 KiB from 0x0807c000 on stalls the program, which runs from the same bank",
            |b| {
                b.flash.set_program(PAGE - 4096..PAGE - 2048);
                b.erase(120);
            },
        ),
        (
            "FLASH_ACR: the data cache is on during programming or an erase, which may corrupt what it holds",
            |b| {
                b.set("ACR", &[("DCEN", 1)]);
                b.program(PAGE, 1, 1);
            },
        ),
        (
            "FLASH_ACR: DCRST is set while that cache is on, and has no effect",
            |b| {
                b.set("ACR", &[("DCEN", 1)]);
                b.set("ACR", &[("DCRST", 1)]);
            },
        ),
        (
            "FLASH_ACR: ICRST is set while that cache is on, and has no effect",
            |b| {
                b.set("ACR", &[("ICEN", 1)]);
                b.set("ACR", &[("ICRST", 1)]);
            },
        ),
        (
            "FLASH_CR: STRT is set without just one of PG, PER and MER",
            |b| {
                b.open();
                b.set("CR", &[("STRT", 1)]);
            },
        ),
        (
            "FLASH_CR: STRT is set without just one of PG, PER and MER",
            |b| {
                b.open();
                b.set("CR", &[("PG", 1), ("PER", 1), ("STRT", 1)]);
            },
        ),
        (
            "FLASH_CR: fast programming or a change of the option bytes is asked for, which this image must not",
            |b| {
                b.open();
                b.set("CR", &[("FSTPG", 1)]);
            },
        ),
        (
            "FLASH_PDKEYR or FLASH_OPTKEYR is written: power-down and option bytes are not for this image",
            |b| b.put("OPTKEYR", 0x0819_2a3b),
        ),
        (
            "FLASH: the register at 0x20 is written while the option bytes are locked",
            |b| b.put("OPTR", 0),
        ),
    ];
    for (part, mistake) in cases {
        let mut bench = Bench::new(true, 1);
        mistake(&mut bench);
        assert_eq!(bench.texts(), [*part]);
    }
}

#[test]
fn a_wrong_key_locks_until_a_reset() {
    let mut bench = Bench::new(true, 1);
    bench.put("KEYR", 0x4567_0123);
    bench.put("KEYR", 0x4567_0123);
    bench.open();
    let expected = [
        "FLASH_KEYR: a wrong key is written; FLASH_CR is locked until the next reset",
        "FLASH_KEYR: a key is written after a wrong one; FLASH_CR is locked until the next reset",
    ];
    assert_eq!(bench.texts(), expected);
    let lock = bench.flash.registers.field("CR", "LOCK").mask;
    assert_ne!(bench.get("CR") & lock, 0);
    bench.flash.reset();
    bench.open();
    assert_eq!(bench.get("CR") & lock, 0);
}

#[test]
fn zeros_may_be_written_over_anything() {
    let mut bench = Bench::new(true, 1);
    bench.program(PAGE, 1, 1);
    bench.flash.damage(PAGE);
    bench.put("SR", u32::MAX);
    bench.double_word(PAGE, 0, 0);
    bench.cycle += MS;
    assert_eq!(bench.read(PAGE), 0);
    assert!(!bench.flash.nmi());
    assert!(bench.texts().is_empty(), "{:?}", bench.texts());
}

#[test]
fn one_bank_stalls_for_every_operation_and_has_pages_of_4_kib() {
    let mut bench = Bench::new(false, 1);
    bench.flash.load(START + 4096, &[0; 4096]);
    bench.open();
    bench.set("CR", &[("PER", 1), ("PNB", 1), ("STRT", 1)]);
    assert_eq!(
        bench.flash.stall_until(START + BANK_SIZE),
        bench.flash.next_event()
    );
    bench.cycle = 22 * MS;
    assert_eq!(bench.read(START + 8188), u32::MAX);
    let dbank = bench.flash.registers.field("OPTR", "DBANK").mask;
    assert_eq!(bench.get("OPTR") & dbank, 0);
}

#[test]
fn a_damaged_double_word_asks_for_an_nmi_and_names_its_bank() {
    let mut bench = Bench::new(true, 1);
    bench.flash.load(PAGE, &[7; 16]);
    bench.flash.damage(PAGE + 12);
    assert_eq!(bench.read(PAGE), 0x0707_0707);
    assert!(!bench.flash.nmi());
    assert_eq!(bench.read(PAGE + 8), 0x0707_0707);
    assert!(bench.flash.nmi());
    let eccr = bench.get("ECCR");
    let value = |name| bench.flash.registers.field("ECCR", name).extract(eccr);
    let [detected, bank, address] = ["ECCD", "BK_ECC", "ADDR_ECC"].map(value);
    assert_eq!((detected, bank, address), (1, 1, 0x3_c008));
    bench.put("ECCR", eccr);
    assert_eq!(bench.get("ECCR") & !(0x3f_ffff), 0);
    assert!(!bench.flash.nmi());
    bench.read(PAGE + 12);
    assert!(bench.flash.nmi());
}

#[test]
fn a_cut_leaves_a_double_word_erased_complete_or_damaged() {
    let mut seen = [0; 3];
    for seed in 0..60 {
        let mut bench = Bench::new(true, seed);
        bench.open_for_program();
        bench.double_word(PAGE, 0x1111_2222, 0x3333_4444);
        bench.flash.cut_power();
        let offset = PAGE - START;
        let value = bench.flash.array().double_word(offset);
        let kind = match (bench.flash.array().is_damaged(offset), value) {
            (true, _) => 2,
            (false, 0x3333_4444_1111_2222) => 1,
            (false, u64::MAX) => 0,
            other => panic!("{other:?}"),
        };
        seen[kind] += 1;
        assert_eq!(bench.flash.next_event(), None);
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

#[test]
fn a_cut_erase_leaves_a_mix_that_its_seed_decides() {
    let page = |seed| {
        let mut bench = Bench::new(true, seed);
        bench.flash.load(PAGE, &[0x5a; 2048]);
        bench.erase(120);
        bench.flash.reset();
        let array = bench.flash.array();
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
