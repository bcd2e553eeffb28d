#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::call_graph::{CallGraph, PANICS};
use super::elf_file::{Bytes, Mapping};
use super::error::ImageBudgetError;
use super::function::Function;
use super::program::Program;
use super::vector_table;
use super::{
    BudgetCheck, ByteBounds, ImageBudget, ImageNeeds, MemoryUsage, Root, RootKind, Task, checks,
};
use std::collections::BTreeSet;

/// Where hand-made code begins.
const START: u32 = 0x0800_0000;

/// Reads hand-made code whose stretches begin so many bytes behind its start, with instructions or without.
fn read_named(
    name: &str,
    halfwords: &[u16],
    stretches: &[(u32, bool)],
) -> Result<Function, ImageBudgetError> {
    let bytes: Vec<u8> = halfwords
        .iter()
        .flat_map(|half| half.to_le_bytes())
        .collect();
    let mapping = |&(offset, code)| Mapping {
        address: START + offset,
        code,
    };
    let mappings: Vec<Mapping> = stretches.iter().map(mapping).collect();
    let range = START..START + u32::try_from(bytes.len()).unwrap();
    let section = Bytes {
        address: START,
        bytes: &bytes,
    };
    Function::read(vec![name.into()], range, &section, &mappings)
}

/// Reads hand-made code that is all instructions.
fn read(halfwords: &[u16]) -> Result<Function, ImageBudgetError> {
    read_named("it", halfwords, &[(0, true)])
}

#[test]
fn all_that_takes_stack_is_added_up() {
    #[rustfmt::skip]
    let code = [
        0xb5f0, // push {r4-r7, lr}: 20
        0xe92d, 0x0b00, // push.w {r8, r9, r11}: 12
        0xed2d, 0x8b04, // vpush {d8-d9}: 16
        0xf5ad, 0x6d80, // sub.w sp, sp, #1024
        0xf50d, 0x6d80, // add.w sp, sp, #1024: gives back, which is not taken off
        0xb084, // sub sp, #16
        0xbdf0, // pop {r4-r7, pc}
    ];
    assert_eq!(read(&code).unwrap().frame, 20 + 12 + 16 + 1024 + 16);
}

#[test]
fn data_between_instructions_is_not_decoded() {
    // push {r7, lr}; bx lr; a word that would be `sub sp, #508` twice; sub sp, #16; bx lr
    let code = [0xb580, 0x4770, 0xb0ff, 0xb0ff, 0xb084, 0x4770];
    let function = read_named("it", &code, &[(0, true), (4, false), (8, true)]).unwrap();
    assert_eq!(function.frame, 8 + 16);
    assert_eq!(function.words, BTreeSet::from([0xb0ff_b0ff]));
    assert!(function.leads_to.is_empty());
}

#[test]
fn a_function_leads_where_its_code_goes_on() {
    let cases: [(&[u16], &[u32], &str); 3] = [
        (
            &[
                0xd001, 0xf000, 0xf80d, 0xf7ff, 0xbffb, 0xf000, 0xb880, 0x4798, 0x4718,
            ],
            &[32, 10 + 4 + 256],
            "beq to the `bl`; bl 32 bytes on from the start; b.w to the start; b.w beyond the end; blx r3; bx r3",
        ),
        (
            &[0x2000, 0xbf00],
            &[4],
            "movs r0, #0; nop: the next function",
        ),
        (&[0x4770, 0xbf00], &[], "bx lr; nop"),
    ];
    for (code, offsets, text) in cases {
        let wanted: BTreeSet<u32> = offsets.iter().map(|offset| START + offset).collect();
        assert_eq!(read(code).unwrap().leads_to, wanted, "{text}");
    }
    assert_eq!(read(cases[0].0).unwrap().indirect_calls, 2);
}

#[test]
fn an_address_in_two_halves_is_seen() {
    // movw r3, #0x5679; movw r4, #0; movt r3, #0x0801; bx lr
    let function = read(&[0xf245, 0x6379, 0xf240, 0x0400, 0xf6c0, 0x0301, 0x4770]);
    assert_eq!(function.unwrap().words, BTreeSet::from([0x0801_5679]));
}

#[test]
fn a_veneer_leads_to_the_address_that_it_makes() {
    // movw r12, #0x245; movt r12, #0x800; bx r12
    let code = [0xf240, 0x2c45, 0xf6c0, 0x0c00, 0x4760];
    let veneer = read_named("__Thumbv7ABSLongThunk_far", &code, &[(0, true)]).unwrap();
    assert_eq!(veneer.leads_to, BTreeSet::from([0x0800_0244]));
    assert_eq!((veneer.indirect_calls, veneer.words.len()), (0, 0));
    let other = read(&code).unwrap();
    assert!(other.leads_to.is_empty());
    assert_eq!(other.indirect_calls, 1);
    assert_eq!(other.words, BTreeSet::from([0x0800_0245]));
}

#[test]
fn code_that_is_not_understood_is_an_error() {
    let moved = read(&[0x46a5]); // mov sp, r4
    assert!(matches!(moved, Err(ImageBudgetError::UnknownStack(..))));
    let cut_off = read(&[0xf000]); // the first half of `bl`
    assert!(matches!(cut_off, Err(ImageBudgetError::CutOff(..))));
}

/// A function at a number times 16, by name, frame, the numbers that it calls, and its calls by address.
type Sketch<'a> = (&'a str, u32, &'a [u32], usize);

/// A program of functions, the addresses of some of which are taken.
fn program(sketches: &[Sketch<'_>], taken: &[u32]) -> Program {
    let mut program = Program::default();
    for (number, (name, frame, calls, indirect_calls)) in (0_u32..).zip(sketches) {
        let function = Function {
            names: vec![(*name).into()],
            range: number * 16..number * 16 + 16,
            frame: *frame,
            leads_to: calls.iter().map(|called| called * 16).collect(),
            indirect_calls: *indirect_calls,
            words: BTreeSet::new(),
        };
        program.names.insert((*name).into(), number * 16);
        program.functions.insert(number * 16, function);
    }
    program.taken = taken.iter().map(|number| number * 16).collect();
    program
}

/// Bytes of the deepest stack from the first function, and the names on it.
fn stack(sketches: &[Sketch<'_>], taken: &[u32]) -> Result<(u32, String), ImageBudgetError> {
    let program = program(sketches, taken);
    let stack = CallGraph::new(&program)?.stack(0)?;
    Ok((stack.bytes, stack.functions.join(" ")))
}

const WAKER: &str = "embassy_executor::raw::waker::wake";
const POLL: &str = "embassy_executor::raw::TaskStorage<F>::poll";
const PANIC: &str = "core::panicking::panic";
const PANIC_HANDLER: &str = "__rustc::rust_begin_unwind";

/// A caller of which nothing is declared, and what it may reach.
const UNDECLARED: [Sketch<'_>; 3] = [("a", 8, &[], 1), ("b", 100, &[], 0), ("c", 200, &[], 0)];

/// A caller of which it is declared that it reaches wakers.
const DECLARED: [Sketch<'_>; 4] = [
    ("TIMER1", 8, &[], 2),
    (WAKER, 16, &[], 0),
    (POLL, 500, &[], 0),
    ("other", 100, &[], 0),
];

/// A text that is written by what writes texts.
const NESTED: [Sketch<'_>; 2] = [
    ("core::fmt::write", 10, &[], 1),
    ("<u32 as core::fmt::Display>::fmt", 1, &[0], 0),
];

/// A panic whose handler panics.
const PANICS_TWICE: [Sketch<'_>; 3] = [
    ("a", 1, &[1], 0),
    (PANIC, 10, &[2], 0),
    (PANIC_HANDLER, 100, &[1], 0),
];

const BRANCHED: [Sketch<'_>; 4] = [
    ("a", 8, &[1, 2], 0),
    ("b", 100, &[], 0),
    ("c", 16, &[3], 0),
    ("d", 90, &[], 0),
];

#[test]
fn the_deepest_chain_counts() {
    let cases: [(&[Sketch<'_>], &[u32], u32, &str); 7] = [
        (&BRANCHED, &[], 8 + 16 + 90, "the longest chain"),
        (&UNDECLARED, &[1], 8 + 100, "all whose address is taken"),
        (&UNDECLARED, &[1, 2], 8 + 200, "the deepest of them"),
        (&DECLARED, &[1, 2], 8 + 16, "what is declared"),
        (&DECLARED, &[1, 2, 3], 8 + 100, "what is named nowhere"),
        (&NESTED, &[1], 10 + 8 * 11, "as often as is declared"),
        (&PANICS_TWICE, &[], 1 + 2 * 110 + 10, "two panics at most"),
    ];
    for (sketches, taken, bytes, text) in cases {
        assert_eq!(stack(sketches, taken).unwrap().0, bytes, "{text}");
    }
    assert_eq!(stack(&BRANCHED, &[]).unwrap().1, "a c d");
    assert_eq!(stack(&UNDECLARED, &[1, 2]).unwrap().1, "a c");
}

#[test]
fn a_stack_without_a_known_bound_is_an_error() {
    let more_calls = [("TIMER1", 8, &[][..], 3)];
    let cases: [(&[Sketch<'_>], &[u32], &str); 3] = [
        (&UNDECLARED, &[0, 1], "a recursion has no bound"),
        (&DECLARED, &[2], "no function whose address is taken"),
        (&more_calls, &[], "makes 3 indirect calls, 2 are declared"),
    ];
    for (sketches, taken, wanted) in cases {
        let error = stack(sketches, taken).unwrap_err().to_string();
        assert!(error.contains(wanted), "{error}");
    }
}

#[test]
fn a_recursion_is_an_error_that_names_its_circle() {
    for (last_calls, wanted) in [(&[1_u32] as &[u32], "b c"), (&[2], "c"), (&[0], "a b c")] {
        let sketches = [
            ("a", 8, &[1_u32][..], 0),
            ("b", 8, &[2], 0),
            ("c", 8, last_calls, 0),
        ];
        let Err(ImageBudgetError::Recursion(circle)) = stack(&sketches, &[]) else {
            panic!("{wanted} is a circle");
        };
        assert_eq!(circle.join(" "), wanted);
    }
}

#[test]
fn a_panic_is_found_by_the_shortest_path_directly_or_by_address() {
    let direct = [
        ("a", 8, &[1_u32, 2][..], 0),
        ("b", 8, &[2], 0),
        ("c", 8, &[3], 0),
        (PANIC, 8, &[], 0),
    ];
    let by_address = [("a", 8, &[][..], 1), ("b", 8, &[2], 0), (PANIC, 8, &[], 0)];
    let none = [("a", 8, &[1][..], 0), ("b", 8, &[], 0), (PANIC, 8, &[], 0)];
    let cases: [(&[Sketch<'_>], &[u32], Option<&str>); 3] = [
        (&direct, &[], Some("a c core::panicking::panic")),
        (&by_address, &[1], Some("a b core::panicking::panic")),
        (&none, &[], None),
    ];
    for (sketches, taken, wanted) in cases {
        let program = program(sketches, taken);
        let path = CallGraph::new(&program).unwrap().shortest_path(&PANICS, 0);
        assert_eq!(path.map(|path| path.join(" ")).as_deref(), wanted);
    }
}

#[test]
fn the_vector_table_gives_each_handler_once() {
    let names = ["Reset", "DefaultHandler", "ADC1_2"];
    let program = program(&names.map(|name| (name, 0, &[][..], 0)), &[]);
    // The stack's start, the reset, an exception and two interrupts without a handler, and one with; odd is Thumb.
    let mut table = vec![0x2002_0000, 0x01, 0x11];
    table.resize(16, 0);
    table.extend([0x11, 0x21, 0x11]);
    let entries = vector_table::entries(&table, &program).unwrap();
    let found: Vec<_> = entries
        .iter()
        .map(|entry| (entry.name.as_str(), entry.kind))
        .collect();
    assert_eq!(
        found,
        [
            ("Reset", RootKind::Thread),
            ("DefaultHandler", RootKind::Exception),
            ("ADC1_2", RootKind::Interrupt),
        ]
    );
    table.push(0x31);
    assert!(matches!(
        vector_table::entries(&table, &program),
        Err(ImageBudgetError::Vector(19, _))
    ));
}

#[test]
fn an_interrupt_without_a_handler_is_no_root() {
    let mut program = program(&[("Reset", 0, &[], 0), ("DefaultHandler", 0, &[], 0)], &[]);
    program.names.insert("ADC1_2".into(), 16);
    let table = [0x2002_0000, 0x01, 0x11];
    let named = |name| vector_table::named(name, &table, &program);
    assert!(matches!(named("ADC1_2"), Err(ImageBudgetError::NoRoot(_))));
    assert_eq!(named("DefaultHandler").unwrap().kind, RootKind::Exception);
}

fn usage(used: u32) -> MemoryUsage {
    MemoryUsage { used, size: 100 }
}

const TASKS: &[(&str, ByteBounds)] = &[("module::task", ByteBounds::new(10, 100))];

fn passed(needs: &ImageNeeds, hot: &'static [&'static str]) -> Vec<bool> {
    let bounds = ByteBounds::new(10, 120);
    let budget = ImageBudget {
        flash: bounds,
        ram: bounds,
        stack: bounds,
        tasks: TASKS,
        hot,
    };
    let checks: Vec<BudgetCheck> = checks(needs, &budget).unwrap();
    checks.iter().map(|check| check.passed).collect()
}

#[test]
fn a_budget_fails_below_above_beyond_the_memory_by_a_panic_and_by_a_log() {
    let root = |name: &str, panic: Option<&str>, log: Option<&str>| Root {
        name: name.into(),
        kind: RootKind::Interrupt,
        stack_bytes: 8,
        deepest: Vec::new(),
        panic: panic.map(|to| vec![to.into()]),
        log: log.map(|to| vec![to.into()]),
        indirect: Vec::new(),
    };
    let mut needs = ImageNeeds {
        flash: usage(10),
        ram: usage(50),
        stack: usage(100),
        roots: vec![
            root("safe", None, None),
            root("panics", Some("core::panicking::panic"), None),
            root("logs", None, Some("_defmt_acquire")),
        ],
        tasks: vec![Task {
            name: "module::task".into(),
            stack_bytes: 100,
            deepest: Vec::new(),
        }],
    };
    assert_eq!(passed(&needs, &["safe"]), [true; 6]);
    assert_eq!(passed(&needs, &["panics"])[4..], [false, true]);
    assert_eq!(passed(&needs, &["logs"])[4..], [true, false]);
    (needs.flash, needs.stack) = (usage(9), usage(101));
    assert_eq!(passed(&needs, &[]), [false, true, false, true]);
    needs.tasks[0].stack_bytes = 101;
    assert!(!passed(&needs, &[])[3]);
}
