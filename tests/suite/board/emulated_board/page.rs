//! BOARD.md, its steps, and lines that are typed as they stand there.

use super::board::{BoardUnderTest, PATIENT};
use leg_boards::image::workspace_root;
use std::path::Path;
use std::process::Command;

/// The page.
pub fn board_page() -> String {
    std::fs::read_to_string(workspace_root().join("firmware/BOARD.md")).unwrap()
}

/// A step of the page.
pub struct PageStep<'a>(&'a str);

impl PageStep<'_> {
    pub fn numbered(page: &str, number: u32) -> PageStep<'_> {
        let (_, from) = page.split_once(&format!("\n**{number}. ")).unwrap();
        let step = from.split("\n**").next().unwrap();
        PageStep(step.split("\n## ").next().unwrap())
    }

    /// The lines to be typed.
    pub fn commands(&self) -> Vec<&str> {
        let blocks = self.0.split("```sh\n").skip(1);
        let lines = blocks.flat_map(|block| block.split("```").next().unwrap().lines());
        lines.collect()
    }

    /// Its text.
    pub fn text(&self) -> &str {
        self.0
    }

    /// What is quoted of what is seen, but for commands and what only a board with flash says.
    pub fn seen(&self) -> Vec<String> {
        let mut seen = self.seen_on_a_board();
        seen.retain(|words| words != "kept over a reset");
        seen
    }

    /// What is quoted of what is seen, but for commands.
    pub fn seen_on_a_board(&self) -> Vec<String> {
        let (_, from) = self.0.split_once("\nYou see").unwrap();
        let sentences = from.split("\nIf not:").next().unwrap();
        let sentences = sentences.split("```").next().unwrap();
        let quoted = sentences.split('`').skip(1).step_by(2).map(one_line);
        let told = |words: &String| !words.starts_with("leg ");
        quoted.filter(told).collect()
    }
}

pub fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Types a line and does by hand what is asked for; what is printed then.
pub fn typed(board: &mut BoardUnderTest, directory: &Path, line: &str, actions: &[&str]) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    let (program, arguments) = words.split_first().unwrap();
    if *program == "cp" {
        // The file of a patient leg: the machine may have much else to do.
        let text = std::fs::read_to_string(workspace_root().join(arguments[0])).unwrap();
        std::fs::write(directory.join(arguments[1]), text + PATIENT).unwrap();
        return String::new();
    }
    assert_eq!(*program, "leg");
    let mut command = match arguments[0] {
        "rig" => {
            let mut command = Command::new(env!("CARGO_BIN_EXE_leg-under-test"));
            command.args(arguments);
            command
        }
        _ => board.command(arguments),
    };
    command.current_dir(directory);
    let output = board.run_by_hand(command, actions, 1.2);
    let told = [output.stderr, output.stdout].map(|bytes| String::from_utf8(bytes).unwrap());
    let told = told.join("\n");
    assert!(output.status.success(), "{line}: {told}");
    told
}
