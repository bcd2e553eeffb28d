//! The steps of BOARD.md that need no board, typed as they stand there.

use super::board::BoardUnderTest;
use super::page::{PageStep, board_page, one_line, typed};

const TURNS: &[&str] = &[
    r#"{"turn":{"motor":1,"turns":1}}"#,
    r#"{"turn":{"motor":2,"turns":1}}"#,
    r#"{"turn":{"motor":3,"turns":1}}"#,
];

const WEIGHTS: &[&str] = &[
    r#"{"hang":{"cell":1,"newtons":0}}"#,
    r#"{"hang":{"cell":1,"newtons":49.05}}"#,
    r#"{"hang":{"cell":1,"newtons":98.1}}"#,
    r#"{"hang":{"cell":1,"newtons":147.15}}"#,
];

#[test]
fn from_the_rig_file_to_the_first_moves_each_step_shows_what_the_page_says() {
    let page = board_page();
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
