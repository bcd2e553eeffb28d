#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::call_graph::{CallGraph, PANICS};
use super::elf_file::{Bytes, Mapping};
use super::error::ImageBudgetError;
use super::function::Function;
use super::program::Program;
use super::vector_table;
use super::{Bounds, Check, ImageBudget, ImageNeeds, Root, RootKind, Task, Usage, checks};
use std::collections::BTreeSet;

/// Where hand-made code begins.
const START: u32 = 0x0800_0000;

/// Reads hand-made code that is all instructions.
fn read(bytes: &[u8]) -> Result<Function, ImageBudgetError> {
    read_mapped(bytes, &[(0, true)])
}

/// Reads hand-made code whose stretches begin so many bytes behind its start, with instructions or without.
fn read_mapped(bytes: &[u8], stretches: &[(u32, bool)]) -> Result<Function, ImageBudgetError> {
    let mappings: Vec<Mapping> = stretches
        .iter()
        .map(|&(offset, code)| Mapping {
            address: START + offset,
            code,
        })
        .collect();
    let address = START;
    let range = START..START + u32::try_from(bytes.len()).unwrap();
    Function::read(
        vec!["it".into()],
        range,
        &Bytes { address, bytes },
        &mappings,
    )
}

#[test]
fn all_that_takes_stack_is_added_up() {
    let function = read(&[
        0xf0, 0xb5, // push {r4-r7, lr}: 20
        0x2d, 0xe9, 0x00, 0x0b, // push.w {r8, r9, r11}: 12
        0x2d, 0xed, 0x04, 0x8b, // vpush {d8-d9}: 16
        0xad, 0xf5, 0x80, 0x6d, // sub.w sp, sp, #1024
        0x0d, 0xf5, 0x80, 0x6d, // add.w sp, sp, #1024: gives back, which is not taken off
        0x84, 0xb0, // sub sp, #16
        0xf0, 0xbd, // pop {r4-r7, pc}
    ]);
    assert_eq!(function.unwrap().frame, 20 + 12 + 16 + 1024 + 16);
}

#[test]
fn data_between_instructions_is_not_decoded() {
    let function = read_mapped(
        &[
            0x80, 0xb5, // push {r7, lr}: 8
            0x70, 0x47, // bx lr
            0xff, 0xb0, 0xff, 0xb0, // a word that would be `sub sp, #508` twice
            0x84, 0xb0, // sub sp, #16
            0x70, 0x47, // bx lr
        ],
        &[(0, true), (4, false), (8, true)],
    )
    .unwrap();
    assert_eq!(function.frame, 8 + 16);
    assert_eq!(function.words, BTreeSet::from([0xb0ff_b0ff]));
    assert!(function.leads_to.is_empty());
}

#[test]
fn only_branches_out_of_the_function_leave_it() {
    let function = read(&[
        0x01, 0xd0, // beq to the `bl`
        0x00, 0xf0, 0x0d, 0xf8, // bl 32 bytes on from the start
        0xff, 0xf7, 0xfb, 0xbf, // b.w to the start
        0x00, 0xf0, 0x80, 0xb8, // b.w beyond the end
        0x98, 0x47, // blx r3
        0x18, 0x47, // bx r3
    ])
    .unwrap();
    assert_eq!(
        function.leads_to,
        BTreeSet::from([START + 32, START + 10 + 4 + 256])
    );
    assert_eq!(function.indirect_calls, 2);
}

#[test]
fn code_that_goes_on_leads_to_the_next_function() {
    // movs r0, #0; nop
    let function = read(&[0x00, 0x20, 0x00, 0xbf]).unwrap();
    assert_eq!(function.leads_to, BTreeSet::from([START + 4]));
    // bx lr; nop
    let function = read(&[0x70, 0x47, 0x00, 0xbf]).unwrap();
    assert!(function.leads_to.is_empty());
}

#[test]
fn an_address_in_two_halves_is_seen() {
    // movw r3, #0x5679; movw r4, #0; movt r3, #0x0801; bx lr
    let function = read(&[
        0x45, 0xf2, 0x79, 0x63, 0x40, 0xf2, 0x00, 0x04, 0xc0, 0xf6, 0x01, 0x03, 0x70, 0x47,
    ]);
    assert_eq!(function.unwrap().words, BTreeSet::from([0x0801_5679]));
}

#[test]
fn a_veneer_leads_where_its_name_says_that_it_does() {
    let code = [
        0x40, 0xf2, 0x45, 0x2c, // movw r12, #0x245
        0xc0, 0xf6, 0x00, 0x0c, // movt r12, #0x800
        0x60, 0x47, // bx r12
    ];
    let named = |name: &str| {
        let mapping = Mapping {
            address: START,
            code: true,
        };
        let range = START..START + 10;
        let bytes = Bytes {
            address: START,
            bytes: &code,
        };
        Function::read(vec![name.into()], range, &bytes, &[mapping]).unwrap()
    };
    let veneer = named("__Thumbv7ABSLongThunk_far");
    assert_eq!(veneer.leads_to, BTreeSet::from([0x0800_0244]));
    assert_eq!((veneer.indirect_calls, veneer.words.len()), (0, 0));
    let other = named("other");
    assert!(other.leads_to.is_empty());
    assert_eq!(other.indirect_calls, 1);
    assert_eq!(other.words, BTreeSet::from([0x0800_0245]));
}

#[test]
fn code_that_is_not_understood_is_an_error() {
    // mov sp, r4
    assert!(matches!(
        read(&[0xa5, 0x46]),
        Err(ImageBudgetError::UnknownStack { .. })
    ));
    // The first half of `bl`.
    assert!(matches!(
        read(&[0x00, 0xf0]),
        Err(ImageBudgetError::CutOff { .. })
    ));
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
        let graph = program(
            &[
                ("a", 8, &[1], 0),
                ("b", 8, &[2], 0),
                ("c", 8, last_calls, 0),
            ],
            &[],
        );
        let Err(ImageBudgetError::Recursion { circle }) = stack(&graph) else {
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
fn a_panic_is_found_by_the_shortest_way_directly_or_by_address() {
    let panic = "core::panicking::panic";
    let direct = program(
        &[
            ("a", 8, &[1, 2], 0),
            ("b", 8, &[2], 0),
            ("c", 8, &[3], 0),
            (panic, 8, &[], 0),
        ],
        &[],
    );
    let way = CallGraph::new(&direct).unwrap().way_to(&PANICS, 0);
    assert_eq!(way.unwrap().join(" "), "a c core::panicking::panic");
    let by_address = program(
        &[("a", 8, &[], 1), ("b", 8, &[2], 0), (panic, 8, &[], 0)],
        &[1],
    );
    let graph = CallGraph::new(&by_address).unwrap();
    assert_eq!(
        graph.way_to(&PANICS, 0).unwrap().join(" "),
        "a b core::panicking::panic"
    );
    let apart = program(
        &[("a", 8, &[1], 0), ("b", 8, &[], 0), (panic, 8, &[], 0)],
        &[],
    );
    assert_eq!(CallGraph::new(&apart).unwrap().way_to(&PANICS, 0), None);
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

fn judged(needs: &ImageNeeds, hot: &'static [&'static str]) -> Vec<bool> {
    let bounds = Bounds {
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
    let checks: Vec<Check> = checks(needs, &budget).unwrap();
    checks.iter().map(|check| check.held).collect()
}

const TASKS: &[(&str, Bounds)] = &[(
    "module::task",
    Bounds {
        lowest: 10,
        highest: 100,
    },
)];

#[test]
fn a_budget_is_missed_below_above_beyond_the_memory_by_a_panic_and_by_a_log() {
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
    assert_eq!(judged(&needs, &["safe"]), [true; 6]);
    assert_eq!(judged(&needs, &["panics"])[4..], [false, true]);
    assert_eq!(judged(&needs, &["logs"])[4..], [true, false]);
    (needs.flash, needs.stack) = (usage(9), usage(101));
    assert_eq!(judged(&needs, &[]), [false, true, false, true]);
    needs.tasks[0].stack_bytes = 101;
    assert!(!judged(&needs, &[])[3]);
}
