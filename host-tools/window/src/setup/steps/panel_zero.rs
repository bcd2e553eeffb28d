//! The zero of the tendons, as its user finds it.

use super::controls::{button, faint, payload_off, sentence};
use super::picture::{self, StepPicture};
use crate::places::place;
use crate::setup::editor::Editor;
use crate::shown_leg::ShownLeg;
use crate::theme::palette;
use egui::{Label, RichText, Spinner, Ui};
use leg_firmware::command::Command;
use leg_firmware::supervisor::{Event, State};

/// Distance of a tension from its target below which it is reached, N.
const TAUT_N: f32 = 2.0;

pub(super) fn show(ui: &mut Ui, homing: &mut bool, editor: &Editor, leg: &mut ShownLeg) {
    picture::show(
        ui,
        &StepPicture {
            slack: true,
            no_payload: true,
            ..StepPicture::default()
        },
    );
    let homing_settings = &editor.settings().homing;
    sentence(
        ui,
        1,
        "Take the payload off: with one the zero is wrong, and the tendons are taken for softer ones. Let the leg hang free.",
    );
    let words = format!(
        "This will happen: every tendon is paid out by {} mm at a time, until all are slack, and then one after the other is reeled in at {} mm/s, up to {} N. A motor that goes farther than {} mm ends it.",
        1000.0 * homing_settings.release_m,
        1000.0 * homing_settings.speed_m_per_s,
        homing_settings.f_max_n,
        1000.0 * homing_settings.travel_m,
    );
    sentence(ui, 2, &words);
    let state = leg.state();
    let possible = state.next(Event::Home).is_some();
    let homes = state == State::Homing;
    let free = payload_off(ui, leg, "the zero that is found with it is wrong.");
    // One that is hung on meanwhile is as bad.
    *homing &= free || !homes;
    let why = leg
        .locked()
        .or(homes.then_some("It homes."))
        .or((!possible).then_some("Disarm the leg first, or clear its faults."))
        .or((!free).then_some("Take the payload off first."));
    if button(ui, "Find the zero", "zero_start", why).clicked() {
        *homing = true;
        leg.command(Command::Home, "home");
    }
    let off = state.next(Event::LeadDown).is_some() || state.next(Event::Disarm).is_some();
    let why = leg
        .locked()
        .or((!off).then_some("It is off, or cannot be led down now."));
    if button(ui, "Disarm", "steps_disarm", why).clicked() {
        leg.command(Command::Disarm, "disarm");
    }
    outcome(ui, *homing, leg);
}

/// Whether every tension is what it is to be, but for a little.
fn is_taut(leg: &ShownLeg) -> bool {
    leg.telemetry().is_some_and(|report| {
        let [first, second, third] = report.tensions_n;
        let [a, b, c] = report.target_tensions_n;
        [first - a, second - b, third - c]
            .iter()
            .all(|off_n| off_n.abs() < TAUT_N)
            && !report.moving
    })
}

fn outcome(ui: &mut Ui, homing: bool, leg: &ShownLeg) {
    let palette = palette(ui.ctx());
    let faults = leg.faults().stopping();
    let (words, colour) = match leg.state() {
        State::Homing => {
            ui.add(Spinner::new());
            (
                "It homes. Space, Esc and STOP end it.".to_owned(),
                palette.target,
            )
        }
        _ if faults.any() => {
            let names: Vec<_> = faults.faults().map(|fault| fault.entry().name).collect();
            (
                format!(
                    "It has faults: {}. See their remedies beside the leg.",
                    names.join(", ")
                ),
                palette.error,
            )
        }
        State::Active if homing && !is_taut(leg) => (
            "The zero is found. The tendons are tensioned.".to_owned(),
            palette.target,
        ),
        State::Active if homing => {
            let tensions = leg.tensions_n().map(|n| format!("{n:.1}"));
            let set_n = leg.rig().pretension_n;
            let words = format!(
                "The zero is found. The tendons pull with {} N; {set_n} N is set at the vertical.",
                tensions.join(", ")
            );
            (words, palette.good)
        }
        _ => match leg.refusal() {
            Some(words) if homing => (words.to_owned(), palette.error),
            _ => {
                return faint(
                    ui,
                    "The zero holds until the board starts anew. Nothing has to be saved.",
                );
            }
        },
    };
    let words = RichText::new(words).color(colour);
    place(&ui.add(Label::new(words).wrap()), "zero_result");
}
