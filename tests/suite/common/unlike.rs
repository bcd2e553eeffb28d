//! Simulated legs that are not what the settings say.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_rig::ready_rigs::{self, READY_RIGS};
use leg_rig::rig_file::RigFile;

/// What is added to a rig file: damping of joint and tendons halved and doubled, friction of the motors and of the screws halved and half more,
/// play of the gears none and double.
const UNLIKE: [(&str, &str); 8] = [
    (
        "half the damping",
        "[simulation]\njoint_damping_nm_s_per_rad = 0.015\ntendon_damping_n_s_per_m = 100\n",
    ),
    (
        "twice the damping",
        "[simulation]\njoint_damping_nm_s_per_rad = 0.06\ntendon_damping_n_s_per_m = 400\n",
    ),
    (
        "half the friction",
        "[actuator]\nfriction_nm = 0.45e-3\n[control.servo]\nfriction_a = 0.1\n",
    ),
    (
        "half more friction",
        "[actuator]\nfriction_nm = 1.35e-3\n[control.servo]\nfriction_a = 0.1\n",
    ),
    // A screw of the efficiency η loses 1/η - 1 of the force: 2.33 by the settings.
    (
        "half the friction of the screws",
        "[actuator]\nscrew_efficiency = 0.4615\n[control.servo]\npull_a_per_n = 0.006\n",
    ),
    (
        "half more friction of the screws",
        "[actuator]\nscrew_efficiency = 0.2222\n[control.servo]\npull_a_per_n = 0.006\n",
    ),
    (
        "no play",
        "[actuator]\nbacklash_rad = 0\n[control.servo]\nplay_m = 2.4e-6\n",
    ),
    (
        "twice the play",
        "[actuator]\nbacklash_rad = 0.03\n[control.servo]\nplay_m = 2.4e-6\n",
    ),
];

/// A ready rig with more lines.
fn rig(ready: &str, name: &str, more: &str) -> (String, RigFile) {
    let text = [ready_rigs::named(ready).unwrap().text, more].concat();
    (name.into(), RigFile::parse(name, &text).unwrap())
}

/// Rig files of such legs by their names: of the paper's rig.
pub fn unlike_rigs() -> impl Iterator<Item = (String, RigFile)> {
    unlike_rigs_like(READY_RIGS[0].name)
}

/// The same of any ready rig.
pub fn unlike_rigs_like(ready: &str) -> impl Iterator<Item = (String, RigFile)> {
    UNLIKE
        .into_iter()
        .map(|(name, more)| rig(ready, name, more))
}

/// The same of legs with a load cell that is 2 % off.
pub fn rigs_with_a_cell_off() -> [(String, RigFile); 2] {
    rigs_with_a_cell_off_like(READY_RIGS[0].name)
}

/// The same of any ready rig.
pub fn rigs_with_a_cell_off_like(ready: &str) -> [(String, RigFile); 2] {
    [[0.02, 0.0, 0.0], [0.0, -0.02, 0.0]].map(|cell_gain_error| {
        let (_, mut file) = rig(ready, "cell", "");
        file.plant.cell_gain_error = cell_gain_error;
        (format!("cells {cell_gain_error:?}"), file)
    })
}

/// The paper's rig with 5° of play, which its settings know.
pub fn rig_with_5_degrees_of_play() -> (String, RigFile) {
    rig(
        READY_RIGS[0].name,
        "5° of play",
        "[actuator]\nbacklash_rad = 0.087\n",
    )
}

/// Legs of a ready rig whose tendons stretch by a fifth more or less than their curve says: they have to home, and measure that then.
pub fn rigs_with_other_tendons_like(ready: &str) -> [(String, RigFile); 2] {
    [0.2, -0.2].map(|curve_error| {
        let (_, mut file) = rig(ready, "tendons", "");
        file.plant.curve_error = curve_error;
        (format!("tendons {curve_error}"), file)
    })
}

/// Whether a leg has to home, for its tendons are not as their curve says.
pub fn has_other_tendons(rig: &RigFile) -> bool {
    rig.plant.curve_error != 0.0
}
