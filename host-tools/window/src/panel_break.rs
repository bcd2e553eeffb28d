//! What can be broken of a simulated leg.

use crate::places::place;
use crate::simulation::Simulation;
use crate::text::left;
use crate::theme::palette;
use egui::{Align, Button, Layout, RichText, Ui, vec2};
use leg_sim::plant::Defect;

/// A push of a finger: N and s.
const PUSH_N: f64 = 3.0;
const PUSH_S: f64 = 0.4;

/// What each of the three can have.
struct Kind {
    /// What its row says.
    text: &'static str,
    defect: fn(usize) -> Defect,
    /// Names of its buttons for tests.
    names: [&'static str; 3],
}

const OF_THREE: [Kind; 4] = [
    Kind {
        text: "Cut a tendon",
        defect: Defect::TendonCut,
        names: ["cut_1", "cut_2", "cut_3"],
    },
    Kind {
        text: "Tear a cell's wire",
        defect: Defect::CellWanders,
        names: ["wander_1", "wander_2", "wander_3"],
    },
    Kind {
        text: "Jam a motor",
        defect: Defect::MotorJammed,
        names: ["jam_1", "jam_2", "jam_3"],
    },
    Kind {
        text: "Lose an encoder",
        defect: Defect::EncoderLost,
        names: ["encoder_1", "encoder_2", "encoder_3"],
    },
];

/// What is seen only while the leg moves.
const SEEN_IN_A_MOVE: &str = "Jam and encoder: found in a move. Drag the target.";

/// How a defect ends.
const REMEDY: &str = "Another press repairs it; the fault that it raised stays until Clear.";

/// What the leg as a whole can have: what its button says, and its name for tests.
const OF_THE_LEG: [(&str, Defect, &str); 2] = [
    ("Supply at 11 V", Defect::SupplySag, "supply_sag"),
    ("Supply dips 5 ms", Defect::SupplyDip, "supply_dip"),
];

/// Where a push is directed to, degrees; what its button says, and its name for tests.
const PUSHES: [(f64, &str, &str); 4] = [
    (0.0, "0°", "push_0"),
    (90.0, "90°", "push_90"),
    (180.0, "180°", "push_180"),
    (270.0, "270°", "push_270"),
];

/// Shows what can be broken; what is broken is lit, and repaired by another press.
pub fn show(ui: &mut Ui, simulation: &mut Simulation) {
    ui.horizontal(|ui| {
        ui.heading("Break it");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            repair(ui, simulation);
        });
    });
    for kind in &OF_THREE {
        row(ui, kind.text, |ui| {
            for (tendon, name) in kind.names.into_iter().enumerate() {
                let number = (tendon + 1).to_string();
                toggle(ui, simulation, &number, (kind.defect)(tendon), name, 34.0);
            }
        });
    }
    let words = RichText::new(SEEN_IN_A_MOVE).small();
    ui.label(words.color(palette(ui.ctx()).faint));
    row(ui, "Push at the tip", |ui| {
        for (azimuth_deg, text, name) in PUSHES {
            let button = ui.add(Button::new(text).min_size(vec2(34.0, 26.0)));
            place(&button, name);
            let hint = format!("{PUSH_N} N towards {text} for {PUSH_S} s");
            if button.on_hover_text(hint).clicked() {
                simulation.push(azimuth_deg, PUSH_N, PUSH_S);
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        for (text, defect, name) in OF_THE_LEG {
            toggle(ui, simulation, text, defect, name, 0.0);
        }
    });
}

fn repair(ui: &mut Ui, simulation: &mut Simulation) {
    let broken = simulation.defects().next().is_some();
    let button = ui.add_enabled(broken, Button::new("Repair everything"));
    place(&button, "repair");
    if button.clicked() {
        simulation.repair();
    }
}

fn row(ui: &mut Ui, text: &str, buttons: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        left(ui, 112.0, text);
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.spacing_mut().button_padding.x = 3.0;
        buttons(ui);
    });
}

fn toggle(
    ui: &mut Ui,
    simulation: &mut Simulation,
    text: &str,
    defect: Defect,
    name: &'static str,
    width: f32,
) {
    let on = simulation.has(defect);
    let mut button = Button::new(text).min_size(vec2(width, 26.0));
    if on {
        button = button.fill(palette(ui.ctx()).error.gamma_multiply(0.55));
    }
    let response = ui.add(button);
    place(&response, name);
    let hint = format!("{} {REMEDY}", describe(defect));
    if response.on_hover_text(hint).clicked() {
        simulation.set_defect(defect, !on);
    }
}

/// What a defect does, as a sentence.
fn describe(defect: Defect) -> &'static str {
    let name: &'static str = defect.into();
    let found = Defect::descriptions().find(|(other, _)| *other == name);
    found.map_or("", |(_, meaning)| meaning)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{OF_THE_LEG, OF_THREE, describe};
    use crate::simulation::Simulation;
    use leg_firmware::command::Command;
    use leg_firmware::supervisor::State;
    use leg_sim::plant::Defect;

    #[test]
    fn every_defect_here_has_its_meaning() {
        let of_three = OF_THREE.iter().map(|kind| (kind.defect)(2));
        for defect in of_three.chain(OF_THE_LEG.iter().map(|(_, defect, _)| *defect)) {
            assert!(describe(defect).ends_with('.'), "{defect:?}");
        }
    }

    /// Whether a fault is found within 10 s. A leg at rest does not feel a jammed motor: it is moved to and fro.
    fn is_found(defect: Option<Defect>) -> bool {
        let mut simulation = Simulation::new().unwrap();
        if let Some(defect) = defect {
            simulation.set_defect(defect, true);
        }
        for part in 0..100_u8 {
            let x = if part % 40 < 20 { 0.0 } else { 0.3 };
            if part % 20 == 0 {
                simulation.command(Command::Move { x, y: 0.1 }, "move");
            }
            simulation.advance(0.1);
            if simulation.faults().stopping().any() {
                return true;
            }
        }
        false
    }

    #[test]
    fn the_supervisor_finds_what_is_broken_here_and_nothing_in_a_sound_leg() {
        assert!(!is_found(None));
        for kind in &OF_THREE {
            for tendon in 0..3 {
                let defect = (kind.defect)(tendon);
                assert!(is_found(Some(defect)), "{defect:?}");
            }
        }
        for (_, defect, _) in OF_THE_LEG {
            assert!(is_found(Some(defect)), "{defect:?}");
        }
    }

    /// Lets a leg go to and fro for so long, tenths of a second.
    fn go_about(simulation: &mut Simulation, tenths: u8) {
        for part in 0..tenths {
            let x = if part % 40 < 20 { 0.0 } else { 0.3 };
            if part % 20 == 0 {
                simulation.command(Command::Move { x, y: 0.1 }, "move");
            }
            simulation.advance(0.1);
        }
    }

    fn wait_for(simulation: &mut Simulation, state: State) {
        for _ in 0..600 {
            simulation.advance(0.1);
            if simulation.state() == state {
                return;
            }
        }
        panic!(
            "not {state:?}: {:?}, {:?}",
            simulation.state(),
            simulation.faults()
        );
    }

    /// What is broken, and then repaired by one button, is a leg that can be homed and driven again.
    #[test]
    fn a_leg_that_is_repaired_is_homed_and_follows_commands() {
        for (number, kind) in OF_THREE.iter().enumerate() {
            let defect = (kind.defect)(number % 3);
            let mut simulation = Simulation::new().unwrap();
            simulation.set_defect(defect, true);
            go_about(&mut simulation, 60);
            simulation.repair();
            simulation.advance(1.0);
            simulation.command(Command::Disarm, "disarm");
            simulation.advance(0.5);
            simulation.command(Command::Clear, "clear");
            wait_for(&mut simulation, State::Disarmed);
            simulation.command(Command::Clear, "clear");
            simulation.advance(0.1);
            assert!(
                !simulation.faults().any(),
                "{defect:?}: {:?}",
                simulation.faults()
            );
            simulation.command(Command::Home, "home");
            wait_for(&mut simulation, State::Active);
            go_about(&mut simulation, 70);
            assert!(
                !simulation.faults().any(),
                "{defect:?}: {:?}",
                simulation.faults()
            );
            let off_mm = simulation.leg().comparison().commanded_error_mm();
            assert!(off_mm < 3.0, "{defect:?}: {off_mm} mm");
        }
    }

    #[test]
    fn what_is_repaired_and_cleared_is_no_fault_any_more() {
        for (_, defect, _) in OF_THE_LEG {
            let mut simulation = Simulation::new().unwrap();
            simulation.set_defect(defect, true);
            simulation.advance(0.2);
            assert!(simulation.faults().stopping().any(), "{defect:?}");
            simulation.set_defect(defect, false);
            simulation.advance(0.2);
            assert!(simulation.faults().stopping().any(), "{defect:?}");
            simulation.command(Command::Clear, "clear");
            simulation.advance(0.2);
            assert!(!simulation.faults().stopping().any(), "{defect:?}");
        }
    }
}
