//! The page's table of what the recorder keeps.

use leg_firmware::settings::{RECORDED_SIGNALS, RecordedSignal, Settings, SignalSet};
use leg_rig::recorded_signals::word;
use std::fmt::Write;

/// The three numbers of a signal, and the step of each, in words and in these settings.
fn numbers(
    signal: RecordedSignal,
    settings: &Settings,
) -> [(&'static str, &'static str, [f32; 3]); 3] {
    let [a, b, c] = &settings.axes;
    let of_each = |quantity, step, steps| [(quantity, step, steps); 3];
    let cells = [a, b, c].map(|axis| 2.0 * axis.cell_n_per_code);
    let counts = [a, b, c].map(|axis| axis.m_per_count.abs());
    let currents = [a, b, c].map(|axis| 2.0 * axis.current_a_per_code);
    let board = &settings.board;
    let board_steps = [
        2.0 * board.supply_v_per_code,
        2.0 * board.temperature_c_per_code,
        1.0,
    ];
    let pose_steps = [1e-4, 1e-4, 1e-6];
    match signal {
        RecordedSignal::Tensions => of_each("measured tension, N", "2 `cell_n_per_code`", cells),
        RecordedSignal::TargetTensions => {
            of_each("tension of the target, N", "2 `cell_n_per_code`", cells)
        }
        RecordedSignal::Pulled => of_each("pulled in, m", "\\|`m_per_count`\\|", counts),
        RecordedSignal::References => of_each(
            "reference of it, m",
            "4 \\|`m_per_count`\\|",
            counts.map(|step| 4.0 * step),
        ),
        RecordedSignal::Currents => {
            of_each("measured current, A", "2 `current_a_per_code`", currents)
        }
        RecordedSignal::Duties => of_each("part of the supply", "1e-4", [1e-4; 3]),
        RecordedSignal::Pose => [
            ("x of the direction", "1e-4", pose_steps),
            ("y", "1e-4", pose_steps),
            ("residual, m", "1e-6", pose_steps),
        ],
        RecordedSignal::Board => [
            ("supply, V", "2 `supply_v_per_code`", board_steps),
            ("temperature, °C", "2 `temperature_c_per_code`", board_steps),
            ("number of the state", "1", board_steps),
        ],
    }
}

/// As Markdown, by bits.
pub fn table() -> String {
    let settings = Settings::table_1().unwrap();
    let mut text = String::from("| bit | signal | numbers | steps |\n|---|---|---|---|\n");
    for (bit, signal) in RECORDED_SIGNALS.into_iter().enumerate() {
        let mut room = [0; 4];
        let bits = postcard::to_slice(&SignalSet::new(&[signal]), &mut room).unwrap();
        assert_eq!(*bits, [1 << bit], "{signal:?}");
        let [first, second, third] = numbers(signal, &settings);
        assert_eq!(signal.steps(&settings), first.2, "{signal:?}");
        let list = |quantities: [&str; 3]| match quantities {
            [a, b, c] if a == b && b == c => format!("{a}, of each"),
            quantities => quantities.join("; "),
        };
        writeln!(
            text,
            "| {bit} | `{}` | {} | {} |",
            word(signal),
            list([first.0, second.0, third.0]),
            list([first.1, second.1, third.1])
        )
        .unwrap();
    }
    text
}
