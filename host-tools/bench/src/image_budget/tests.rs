#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::call_graph::{CallGraph, PANICS};
use super::elf_file::{Bytes, Mapping};
use super::error::ImageBudgetError;
use super::function::Function;
use super::program::Program;
use super::vector_table;
use super::{
    BudgetCheck, ByteBounds, ImageBudget, ImageNeeds, Root, RootKind, Task, Usage, checks,
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
    assert!(matches!(moved, Err(ImageBudgetError::UnknownStack { .. })));
    let cut_off = read(&[0xf000]); // the first half of `bl`
    assert!(matches!(cut_off, Err(ImageBudgetError::CutOff { .. })));
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

/// The deepest stack from the first function, and the names on it.
fn stack(program: &Program) -> Result<(u32, String), ImageBudgetError> {
    let stack = CallGraph::new(program)?.stack(0)?;
    Ok((stack.bytes, stack.functions.join(" ")))
}

#[test]
fn the_deepest_chain_counts() {
    let graph = program(
        &[
            ("a", 8, &[1, 2], 0),
            ("b", 100, &[], 0),
            ("c", 16, &[3], 0),
            ("d", 90, &[], 0),
        ],
        &[],
    );
    assert_eq!(stack(&graph).unwrap(), (8 + 16 + 90, "a c d".into()));
}

#[test]
fn a_recursion_is_an_error_that_names_its_circle() {
    for (last_calls, wanted) in [(&[1_u32] as &[u32], "b c"), (&[2], "c"), (&[0], "a b c")] {
        let sketches = [
            ("a", 8, &[1_u32][..], 0),
            ("b", 8, &[2], 0),
            ("c", 8, last_calls, 0),
        ];
        let Err(ImageBudgetError::Recursion { circle }) = stack(&program(&sketches, &[])) else {
            panic!("{wanted} is a circle");
        };
        assert_eq!(circle.join(" "), wanted);
    }
}

#[test]
fn an_undeclared_call_by_address_reaches_all_that_is_taken() {
    let sketches: [Sketch<'_>; 3] = [("a", 8, &[], 1), ("b", 100, &[], 0), ("c", 200, &[], 0)];
    assert_eq!(
        stack(&program(&sketches, &[1])).unwrap(),
        (108, "a b".into())
    );
    assert_eq!(
        stack(&program(&sketches, &[1, 2])).unwrap(),
        (208, "a c".into())
    );
    let circle = stack(&program(&sketches, &[0, 1]));
    assert!(matches!(circle, Err(ImageBudgetError::Recursion { .. })));
}

#[test]
fn a_declared_call_by_address_reaches_what_is_declared_or_named_nowhere() {
    let waker = "embassy_executor::raw::waker::wake";
    let poll = "embassy_executor::raw::TaskStorage<F>::poll";
    let sketches: [Sketch<'_>; 4] = [
        ("TIMER1", 8, &[], 2),
        (waker, 16, &[], 0),
        (poll, 500, &[], 0),
        ("other", 100, &[], 0),
    ];
    assert_eq!(stack(&program(&sketches, &[1, 2])).unwrap().0, 8 + 16);
    assert_eq!(stack(&program(&sketches, &[1, 2, 3])).unwrap().0, 8 + 100);
    let without_waker = CallGraph::new(&program(&sketches, &[2])).err();
    assert!(matches!(
        without_waker,
        Some(ImageBudgetError::NoTarget { .. })
    ));
}

#[test]
fn more_calls_by_address_than_are_declared_are_an_error() {
    let graph = program(&[("TIMER1", 8, &[], 3)], &[]);
    assert!(matches!(
        CallGraph::new(&graph).err(),
        Some(ImageBudgetError::MoreCalls {
            found: 3,
            declared: 2,
            ..
        })
    ));
}

#[test]
fn formatting_nests_as_often_as_is_declared() {
    let value = "<u32 as core::fmt::Display>::fmt";
    let graph = program(
        &[("core::fmt::write", 10, &[], 1), (value, 1, &[0], 0)],
        &[1],
    );
    assert_eq!(stack(&graph).unwrap().0, 10 + 8 * 11);
}

#[test]
fn a_second_panic_is_the_last_on_a_stack() {
    let handler = "__rustc::rust_begin_unwind";
    let graph = program(
        &[
            ("a", 1, &[1], 0),
            ("core::panicking::panic_fmt", 10, &[2], 0),
            (handler, 100, &[1], 0),
        ],
        &[],
    );
    assert_eq!(stack(&graph).unwrap().0, 1 + 2 * 110 + 10);
}

#[test]
fn a_panic_is_found_by_the_shortest_path_directly_or_by_address() {
    let panic = "core::panicking::panic";
    let cases: [(&[Sketch<'_>], &[u32], Option<&str>); 3] = [
        (
            &[
                ("a", 8, &[1, 2], 0),
                ("b", 8, &[2], 0),
                ("c", 8, &[3], 0),
                (panic, 8, &[], 0),
            ],
            &[],
            Some("a c core::panicking::panic"),
        ),
        (
            &[("a", 8, &[], 1), ("b", 8, &[2], 0), (panic, 8, &[], 0)],
            &[1],
            Some("a b core::panicking::panic"),
        ),
        (
            &[("a", 8, &[1], 0), ("b", 8, &[], 0), (panic, 8, &[], 0)],
            &[],
            None,
        ),
    ];
    for (sketches, taken, wanted) in cases {
        let program = program(sketches, taken);
        let path = CallGraph::new(&program).unwrap().shortest_path(&PANICS, 0);
        assert_eq!(path.map(|path| path.join(" ")).as_deref(), wanted);
    }
}

#[test]
fn the_vector_table_gives_each_handler_once() {
    let program = program(
        &[
            ("Reset", 0, &[], 0),
            ("DefaultHandler", 0, &[], 0),
            ("ADC1_2", 0, &[], 0),
        ],
        &[],
    );
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
        Err(ImageBudgetError::Vector { number: 19, .. })
    ));
}

#[test]
fn an_interrupt_without_a_handler_is_no_root() {
    let mut program = program(&[("Reset", 0, &[], 0), ("DefaultHandler", 0, &[], 0)], &[]);
    program.names.insert("ADC1_2".into(), 16);
    let table = [0x2002_0000, 0x01, 0x11];
    let named = |name| vector_table::named(name, &table, &program);
    assert!(matches!(
        named("ADC1_2"),
        Err(ImageBudgetError::NoRoot { .. })
    ));
    assert_eq!(named("DefaultHandler").unwrap().kind, RootKind::Exception);
}

fn usage(used: u32) -> Usage {
    Usage { used, size: 100 }
}

fn passed(needs: &ImageNeeds, hot: &'static [&'static str]) -> Vec<bool> {
    let bounds = ByteBounds {
        lowest: 10,
        highest: 120,
    };
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

const TASKS: &[(&str, ByteBounds)] = &[(
    "module::task",
    ByteBounds {
        lowest: 10,
        highest: 100,
    },
)];

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
