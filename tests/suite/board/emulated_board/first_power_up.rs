//! The steps of BOARD.md that need no board, typed as they stand there.

use super::board::{BoardUnderTest, PATIENT};
use leg_boards::image::workspace_root;
use std::path::Path;
use std::process::Command;

/// A step of the page.
struct PageStep<'a>(&'a str);

impl PageStep<'_> {
    fn numbered(page: &str, number: u32) -> PageStep<'_> {
        let (_, from) = page.split_once(&format!("\n**{number}. ")).unwrap();
        let step = from.split("\n**").next().unwrap();
        PageStep(step.split("\n## ").next().unwrap())
    }

    /// The lines to be typed.
    fn commands(&self) -> Vec<&str> {
        let blocks = self.0.split("```sh\n").skip(1);
        let lines = blocks.flat_map(|block| block.split("```").next().unwrap().lines());
        lines.collect()
    }

    /// What is quoted of what is seen, but for commands and what only a board with flash says.
    fn seen(&self) -> Vec<String> {
        let (_, from) = self.0.split_once("\nYou see").unwrap();
        let sentences = from.split("\nIf not:").next().unwrap();
        let sentences = sentences.split("```").next().unwrap();
        let quoted = sentences.split('`').skip(1).step_by(2).map(one_line);
        let told = |words: &String| words != "kept over a reset" && !words.starts_with("leg ");
        quoted.filter(told).collect()
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Types a line and does by hand what is asked for; what is printed then.
fn typed(board: &mut BoardUnderTest, directory: &Path, line: &str, actions: &[&str]) -> String {
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

const TURNS: &[&str] = &[
    r#"{"turn":{"motor":1,"turns":1}}"#,
    r#"{"turn":{"motor":2,"turns":1}}"#,
    r#"{"turn":{"motor":3,"turns":1}}"#,
];

const WEIGHTS: &[&str] = &[
    r#"{"hang":{"cell":1,"newtons":0}}"#,
    r#"{"hang":{"cell":1,"newtons":9.81}}"#,
    r#"{"hang":{"cell":1,"newtons":19.62}}"#,
    r#"{"hang":{"cell":1,"newtons":49.05}}"#,
];

#[test]
fn from_the_rig_file_to_the_first_moves_each_step_shows_what_the_page_says() {
    let page = std::fs::read_to_string(workspace_root().join("firmware/BOARD.md")).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let mut board = BoardUnderTest::new(&["--slack"]);
    for number in [4, 8, 9, 12, 13, 14, 15] {
        let step = PageStep::numbered(&page, number);
        let actions = match number {
            8 => TURNS,
            9 => WEIGHTS,
            _ => &[],
        };
        let told: String = step
            .commands()
            .into_iter()
            .map(|line| typed(&mut board, directory.path(), line, actions))
            .collect();
        let told = one_line(&told);
        for words in step.seen() {
            assert!(told.contains(&words), "step {number}: {words}\n{told}");
        }
        if number == 9 {
            board.act(r#"{"hang":{"cell":1}}"#);
        }
    }
}
