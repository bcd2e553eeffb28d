//! The leg on a terminal.

use super::bar::bar;
use super::view::MonitorView;
use leg_base::description;
use leg_base::tick_time::tick_s;
use leg_firmware::supervisor::{FaultSet, Reaction, State};
use leg_firmware::telemetry::Telemetry;
use leg_host::leg_report::{known_pose_words, pose_words};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout};
use ratatui::style::{Color, Stylize};
use ratatui::text::Line;
use ratatui::widgets::{Block, Paragraph, Wrap};

/// Columns that number, value and unit of a bar take, with their gaps.
const BAR_LABEL_WIDTH: u16 = 16;

/// Draws a leg on a whole screen.
pub(super) fn draw(frame: &mut Frame<'_>, view: &MonitorView) {
    let rows = [
        Constraint::Length(5),
        Constraint::Length(5),
        Constraint::Length(5),
        Constraint::Min(3),
        Constraint::Length(1),
    ];
    let [state, tensions, load, faults, keys] = Layout::vertical(rows).areas(frame.area());
    frame.render_widget(last_line(view), keys);
    let Some(telemetry) = &view.telemetry else {
        let waiting = Paragraph::new("waiting for the leg").block(titled(&view.title));
        return frame.render_widget(waiting, state);
    };
    let bars = bar_lines(view, telemetry, tensions.width);
    for (area, title, lines) in [
        (state, view.title.clone(), state_lines(telemetry)),
        (tensions, bounds_title(view), bars),
        (
            load,
            "Stiffness and load".into(),
            load_lines(view, telemetry),
        ),
    ] {
        frame.render_widget(Paragraph::new(lines).block(titled(&title)), area);
    }
    let lines = Paragraph::new(fault_lines(telemetry.faults)).wrap(Wrap { trim: false });
    frame.render_widget(lines.block(titled(&faults_title(telemetry.faults))), faults);
}

fn last_line(view: &MonitorView) -> Line<'static> {
    let keys = " q or Ctrl-C ends this; it commands nothing".dim();
    match view.damaged_frames {
        0 => Line::from(keys),
        count => {
            let damaged = format!(" {count} frames damaged;").fg(Color::Yellow);
            Line::from(vec![damaged, keys])
        }
    }
}

fn titled(title: &str) -> Block<'static> {
    Block::bordered().title(format!(" {title} "))
}

fn bounds_title(view: &MonitorView) -> String {
    let [f_min_n, f_max_n] = view.bounds_n;
    format!("Tensions, minimum {f_min_n} N, maximum {f_max_n} N")
}

fn state_lines(telemetry: &Telemetry<f32>) -> Vec<Line<'static>> {
    let colour = match telemetry.state {
        State::Active | State::Homing | State::Jogging | State::KeepingStation => Color::Green,
        State::Held | State::RampingDown => Color::Yellow,
        State::Off => Color::Red,
        State::Boot | State::Disarmed => Color::Reset,
    };
    let homed = if telemetry.homed {
        "homed"
    } else {
        "not homed"
    };
    let moving = if telemetry.moving { ", moving" } else { "" };
    let state = description::state(telemetry.state);
    let time_s = f64::from(telemetry.tick) * tick_s();
    vec![
        Line::from(vec![
            "state      ".into(),
            state.bold().fg(colour),
            format!(", {homed}{moving}, {time_s:.2} s since the board started").into(),
        ]),
        Line::from(format!("pose       {}", known_pose_words(telemetry))),
        Line::from(format!(
            "reference  {}, commanded {}",
            pose_words(telemetry.target),
            pose_words(telemetry.commanded)
        )),
    ]
}

/// The pretension or the stiffness that was commanded.
fn commanded_words(telemetry: &Telemetry<f32>) -> String {
    let pretension = telemetry.pretension_commanded_n;
    let stiffness = telemetry.stiffness_commanded_nm_per_rad;
    match (pretension, stiffness) {
        (Some(n), _) => format!(", commanded {n:.1} N"),
        (None, Some(nm_per_rad)) => format!(", commanded {nm_per_rad:.2} N·m/rad"),
        (None, None) => String::new(),
    }
}

/// By how much the tendons stretch, where the leg has found that they are not as the settings say.
fn elongation_words(factor: f32) -> String {
    if factor == 1.0 {
        String::new()
    } else {
        format!("; elongation {factor:.3} of the settings'")
    }
}

fn bar_lines(view: &MonitorView, telemetry: &Telemetry<f32>, width: u16) -> Vec<Line<'static>> {
    let width = usize::from(width.saturating_sub(BAR_LABEL_WIDTH));
    let bars = (1..).zip(telemetry.tensions_n);
    bars.map(|(number, tension)| {
        Line::from(vec![
            format!("{number} {tension:7.1} N  ").into(),
            bar(tension, view.bounds_n, width),
        ])
    })
    .collect()
}

fn load_lines(view: &MonitorView, telemetry: &Telemetry<f32>) -> Vec<Line<'static>> {
    let [x, y] = telemetry.load_nm;
    let sag = view.sag_m().map_or_else(
        || "-".into(),
        |sag_m| format!("{:.2} mm without compensation", sag_m * 1000.0),
    );
    vec![
        Line::from(format!(
            "stiffness  {:.2} N·m/rad at pretension {:.1} N{}",
            telemetry.stiffness_nm_per_rad,
            telemetry.pretension_n,
            commanded_words(telemetry)
        )),
        Line::from(format!(
            "load       {x:.3}, {y:.3} N·m beyond the leg's own, payload {:.3} kg",
            telemetry.payload_kg
        )),
        Line::from(format!(
            "sag        {sag}{}",
            elongation_words(telemetry.elongation_factor)
        )),
    ]
}

fn faults_title(faults: FaultSet) -> String {
    match faults.faults().count() {
        0 => "Faults".into(),
        count => format!("Faults: {count}"),
    }
}

fn fault_lines(faults: FaultSet) -> Vec<Line<'static>> {
    if !faults.any() {
        return vec![Line::from("none")];
    }
    let lines = faults.faults().flat_map(|fault| {
        let (entry, reaction) = (fault.entry(), fault.reaction());
        let colour = if reaction == Reaction::Limit {
            Color::Yellow
        } else {
            Color::Red
        };
        let name = format!("{} {}", fault.code(), entry.name);
        let reaction = format!(" ({}): {}", description::reaction(reaction), entry.cause);
        [
            Line::from(vec![name.bold().fg(colour), reaction.into()]),
            Line::from(format!("   remedy: {}", entry.remedy)),
        ]
    });
    lines.collect()
}
