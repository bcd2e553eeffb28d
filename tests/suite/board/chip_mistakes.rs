//! The board's image with one mistake at a time, on the emulated chip: each has to be reported by name.
//!
//! A campaign of minutes, so it is left out unless it is asked for: `cargo test --test suite -- --ignored mistakes`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod can_bus;
mod clocks;
mod guards;
mod hangs;
mod links;
mod power;
mod program;
mod runs;
mod sensing;
mod settings;
mod tree;
mod update;

use leg_boards::image::workspace_root;
use std::fs;
use std::path::Path;

/// A mistake.
#[derive(Clone, Copy)]
struct Mistake {
    /// The file, from the root of the workspace.
    file: &'static str,
    /// The piece of it that is replaced, which it has exactly once.
    right: &'static str,
    /// What it is replaced by.
    wrong: &'static str,
    /// The run that shows it: gives what is reported.
    run: fn(&Path) -> String,
    /// What the report has to contain.
    report: &'static str,
}

impl Mistake {
    const fn new(
        file: &'static str,
        right: &'static str,
        wrong: &'static str,
        run: fn(&Path) -> String,
        report: &'static str,
    ) -> Self {
        Self {
            file,
            right,
            wrong,
            run,
            report,
        }
    }

    /// How often a file has the piece that is replaced.
    fn count_in(&self, text: &str) -> usize {
        text.matches(self.right).count()
    }

    fn has_to_be_found(&self, name: &str) {
        let image = tree::image_with(self, name);
        let report = (self.run)(&image);
        println!("{name}: {report}");
        assert!(
            report.contains(self.report),
            "{name} is not reported by `{}`, but so: {report}",
            self.report
        );
    }
}

/// A test for each mistake, and the list of them.
macro_rules! mistakes {
    ($($name:ident: $mistake:expr;)*) => {
        pub const ALL: &[(&str, Mistake)] = &[$((stringify!($name), $mistake)),*];
        $(
            #[test]
            #[ignore = "builds an image: run with --ignored"]
            fn $name() {
                $mistake.has_to_be_found(stringify!($name));
            }
        )*
    };
}
use mistakes;

/// A change of the firmware that moves one is found at once, and not by the campaign.
#[test]
fn each_mistake_has_its_place() {
    let all = [
        clocks::ALL,
        guards::ALL,
        hangs::ALL,
        links::ALL,
        power::ALL,
        program::ALL,
        sensing::ALL,
        settings::ALL,
        update::ALL,
    ];
    let mut without_place = Vec::new();
    for (name, mistake) in all.concat() {
        let text = fs::read_to_string(workspace_root().join(mistake.file)).unwrap();
        let count = mistake.count_in(&text);
        if count != 1 {
            without_place.push(format!("{name}: {count} times in {}", mistake.file));
        }
    }
    assert_eq!(without_place, [""; 0]);
}

/// Without a mistake nothing is reported.
#[test]
#[ignore = "builds an image: run with --ignored"]
fn none() {
    let board_layer = "firmware/stm32g474/src/main.rs";
    let all = [
        runs::losing_its_crystal,
        runs::losing_its_supply,
        runs::moving,
        runs::saving,
        runs::answering_on_can,
        runs::latest,
    ];
    let none = Mistake {
        file: board_layer,
        right: "    hot::load();\n",
        wrong: "    hot::load();\n",
        run: runs::moving,
        report: "",
    };
    let image = tree::image_with(&none, "none");
    assert_eq!(all.map(|run| run(&image)), [runs::NOTHING; 6]);
}
