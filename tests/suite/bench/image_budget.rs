//! What the firmware images need of the board, read from their ELF files, within budgets on both sides; and that the
//! analysis can fail.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::panic_free;
use leg_bench::image_budget::{
    ImageBudget, ImageBudgetError, ImageNeeds, Root, RootKind, checks, needs, root,
};
use leg_boards::image::FirmwareImage;
use leg_boards::setup;
use std::process::Command;

/// The bytes of a board's image.
fn image_of(board: FirmwareImage) -> Vec<u8> {
    setup::ensure_target(&mut |_| {}).unwrap();
    std::fs::read(board.build().unwrap()).unwrap()
}

fn names(needs: &ImageNeeds) -> Vec<&str> {
    needs.roots.iter().map(|root| root.name.as_str()).collect()
}

fn named<'a>(needs: &'a ImageNeeds, name: &str) -> &'a Root {
    let mut roots = needs.roots.iter();
    roots.find(|root| root.name == name).unwrap()
}

/// Every check of the budget passes, and every call by address is one whose targets are declared.
fn assert_passes(board: FirmwareImage, needs: &ImageNeeds) {
    let checks = checks(needs, &ImageBudget::new(board)).unwrap();
    assert!(checks.iter().all(|check| check.passed), "{checks:#?}");
    for root in &needs.roots {
        assert!(
            root.indirect.iter().all(|caller| caller.declared),
            "{root:#?}"
        );
    }
}

#[test]
fn the_board_image_keeps_its_budget() {
    let needs = needs(&image_of(FirmwareImage::Stm32g474)).unwrap();
    assert_passes(FirmwareImage::Stm32g474, &needs);
    // memory.x
    assert_eq!(needs.flash.size, 496 * 1024);
    assert_eq!(needs.ram.size, 96 * 1024);
    assert_eq!(needs.stack.size + needs.ram.used, needs.ram.size);
    let mut names = names(&needs);
    names.sort_unstable();
    assert_eq!(
        names,
        [
            "ADC1_2",
            "DefaultHandler",
            "FDCAN2_IT0",
            "FDCAN2_IT1",
            "FLASH",
            "HardFault",
            "LPUART1",
            "NonMaskableInt",
            "Reset",
            "TIM1_BRK_TIM15",
        ]
    );
    // The tasks run in the thread's executor.
    let thread = named(&needs, "Reset");
    assert_eq!(thread.kind, RootKind::Thread);
    assert!(
        (17_000..35_000).contains(&thread.stack_bytes),
        "{thread:#?}"
    );
    assert!(
        thread
            .deepest
            .iter()
            .any(|name| name.contains("TaskStorage"))
    );
}

#[test]
fn the_image_for_qemu_keeps_its_budget() {
    let needs = needs(&image_of(FirmwareImage::Qemu)).unwrap();
    assert_passes(FirmwareImage::Qemu, &needs);
    assert_eq!(
        names(&needs),
        [
            "Reset",
            "DefaultHandler",
            "HardFault",
            "TIMER0",
            "TIMER1",
            "LINK"
        ]
    );
    // Here the tasks run in an interrupt's executor.
    let link = named(&needs, "LINK");
    assert_eq!(link.kind, RootKind::Interrupt);
    assert!((28_400..37_800).contains(&link.stack_bytes), "{link:#?}");
}

#[test]
fn a_panic_is_found_where_one_can_be_reached_and_nowhere_else() {
    let qemu = image_of(FirmwareImage::Qemu);
    // Borrowing the clock's state twice would panic.
    let way = root(&qemu, "TIMER0").unwrap().panic.unwrap();
    assert_eq!(way.first().unwrap(), "TIMER0");
    assert!(way.last().unwrap().contains("core::panicking::"), "{way:?}");
    assert!(root(&qemu, "Reset").unwrap().panic.is_some());
    // The linker has shown that this one has none, though it holds all that the server and the model do.
    let proof = root(&panic_free::image().unwrap(), "_start").unwrap();
    assert_eq!(proof.panic, None);
    // Its recorder is a local, and moved once.
    assert!((60_000..110_000).contains(&proof.stack_bytes), "{proof:#?}");
    let board = image_of(FirmwareImage::Stm32g474);
    assert_eq!(root(&board, "ADC1_2").unwrap().panic, None);
}

#[test]
fn an_interrupt_without_a_handler_of_its_own_cannot_pass_for_one_without_panic() {
    let board = image_of(FirmwareImage::Stm32g474);
    for name in ["CORDIC", "NO_SUCH_INTERRUPT"] {
        assert!(matches!(
            root(&board, name),
            Err(ImageBudgetError::NoRoot(_))
        ));
    }
}

#[test]
fn a_file_that_is_no_image_is_refused() {
    assert!(matches!(
        needs(b"not an ELF file"),
        Err(ImageBudgetError::Elf(_))
    ));
    let host = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    assert!(matches!(needs(&host), Err(ImageBudgetError::Elf(_))));
}

#[test]
fn the_command_reports_to_people_and_machines_what_the_images_need() {
    let leg = |args: &[&str]| {
        let mut leg = Command::new(env!("CARGO_BIN_EXE_leg-under-test"));
        leg.args(["cost", "--image"]).args(args).output().unwrap()
    };
    let output = leg(&[]);
    assert!(output.status.success());
    let printed = String::from_utf8(output.stdout).unwrap();
    for part in [
        "leg-stm32g474",
        "leg-qemu",
        "flash",
        "TIM1_BRK_TIM15",
        "LINK",
        "no panic from ADC1_2",
        "no log from ADC1_2",
        "stack of serial::serve",
    ] {
        assert!(printed.contains(part), "{part} in {printed}");
    }
    let output = leg(&["--json"]);
    let images: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(images[0]["image"], "leg-stm32g474");
    assert_eq!(images[0]["needs"]["flash"]["size"], 496 * 1024);
    assert!(images[1]["needs"]["roots"][0]["stack_bytes"].is_u64());
}
