//! Motors of other kinds: with nothing but their data sheets in the rig file the leg homes, moves and holds without a fault; and
//! what cannot work is refused at its key with a number that would do.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::other_legs::{HOMES_S, homed, with_stiffness};
use crate::sim::station_stand::{armed, pass, ticks};
use leg_base::failure::Failure;
use leg_bench::stand::move_to;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::derived::derived_gains;
use leg_rig::rig_file::{RigFile, RigText};
use leg_sim::link::InProcess;
use leg_sim::plant::Defect;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::Simulation;

/// A rig of the default mechanism with a section `[actuator]` and what comes after it.
fn text(actuator: &str) -> String {
    [READY_RIGS[0].text, "[actuator]\n", actuator].concat()
}

const WORK: &str = "title = \"other motors\"\nseed = 6\nsteps = [ { await = { state = \"disarmed\", timeout_s = 1 } }, \"home\", \
                    { await = { state = \"active\", timeout_s = 300 } }, { wait_s = 3 }, \
                    { move = { azimuth_deg = 30, tilt_deg = 15 } }, { arrive = { then_s = 2, timeout_s = 60 } }, \
                    { measure = { name = \"tip\", quantity = \"tip_error_mm\", between = [0, 0.1] } }, \
                    { pretension_n = 100 }, { wait_s = 2 }, \
                    { move = { azimuth_deg = 210, tilt_deg = 10 } }, { arrive = { then_s = 2, timeout_s = 60 } }, \
                    { measure = { name = \"tip\", quantity = \"tip_error_mm\", between = [0, 0.1] } } ]\n\
                    [start.slack]\nslack_mm = 1\n";

/// Data sheets of motors between 10 and 150 W, and of poor ones.
const MOTORS: [(&str, &str); 11] = [
    ("no gear", "gear_ratio = 1\n"),
    ("a slow gear", "gear_ratio = 14\n"),
    ("a slower gear", "gear_ratio = 30\n"),
    (
        "48 V, flat, brushless, Hall sensors with 4096 lines added",
        "resistance_ohm = 1.03\ninductance_h = 0.57e-3\ntorque_constant_nm_per_a = 0.0705\ninertia_kg_m2 = 1.21e-5\n\
         friction_nm = 4e-3\nviscous_nm_s_per_rad = 3e-6\ngear_ratio = 3.5\ncounts_per_turn = 16384\nsupply_v = 48\n\
         supply_range_v = 72\ncontinuous_a = 2.3\nthermal_time_s = 30\n",
    ),
    (
        "12 V, small",
        "resistance_ohm = 1.4\ninductance_h = 0.1e-3\ntorque_constant_nm_per_a = 0.0105\ninertia_kg_m2 = 6e-7\n\
         friction_nm = 6e-4\ngear_ratio = 8\ncounts_per_turn = 1024\nsupply_v = 12\nsupply_range_v = 20\n\
         continuous_a = 1.5\nthermal_time_s = 10\n",
    ),
    ("a coarse screw", "lead_m = 5e-3\n"),
    ("a heavy rotor", "inertia_kg_m2 = 6e-6\n"),
    (
        "a stiff gear",
        "friction_nm = 3.6e-3\ngear_efficiency = 0.7\n",
    ),
    ("a winding with much iron", "inductance_h = 4e-3\n"),
    ("few counts", "counts_per_turn = 256\n"),
    (
        "Hall sensors alone behind a slow gear",
        "gear_ratio = 30\ncounts_per_turn = 48\n",
    ),
];

/// Runs the work on a leg with this rig; what goes wrong is an error.
pub(crate) fn work(name: &str, rig: &RigFile) -> Result<(), String> {
    let simulation = Simulation::new(&Scenario::parse("work", WORK).unwrap(), rig).unwrap();
    let summary = simulation
        .run(&mut InProcess::new(), &mut |_| ())
        .map_err(|error| format!("{name}: {error}"))?;
    if summary.passes() {
        return Ok(());
    }
    let derived: Vec<_> = derived_gains(rig)
        .iter()
        .map(|gain| format!("{} {}", gain.key, gain.value))
        .collect();
    Err(format!(
        "{name}: {:?} {:?} {:?}\n  {}",
        summary.stopped,
        summary.faults,
        summary.measurements,
        derived.join(", ")
    ))
}

#[test]
fn a_leg_works_with_what_its_motors_data_sheets_say() {
    let failed: Vec<_> = MOTORS
        .iter()
        .filter_map(|(name, actuator)| {
            let rig = RigFile::parse(name, &text(actuator)).unwrap();
            work(name, &rig).err()
        })
        .collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// It starts and brakes as fast as it can all the same.
#[test]
fn a_leg_works_whose_motors_are_set_to_be_slow() {
    let slow = text("[control.servo]\nspeed_m_per_s = 1e-3\n");
    let rig = RigFile::parse("slow", &slow).unwrap();
    work("slow", &rig).unwrap();
}

/// Copper has 25 % more resistance when it is 65 °C warmer: the motor draws that much less than its voltage drives by the file.
#[test]
fn a_leg_works_with_windings_that_are_warm() {
    let failed: Vec<_> = MOTORS
        .iter()
        .filter_map(|(name, actuator)| {
            let cold = RigFile::parse(name, &text(actuator)).unwrap();
            let warm_ohm = cold.actuators[0].resistance_ohm;
            let servo = format!("[control.servo]\nresistance_ohm = {}\n", warm_ohm / 1.25);
            let rig = RigFile::parse(name, &text(&format!("{actuator}{servo}"))).unwrap();
            work(name, &rig).err()
        })
        .collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// A motor that jams in a move is found on motors without a gear, too, where what holds the maximum tension takes nearly all that the
/// servo gives; no tendon is pulled beyond the bar of a leg that is cut off.
#[test]
fn a_motor_that_jams_is_found_whatever_its_gear() {
    const NAMED_S: f64 = 0.5;
    for (name, actuator) in [MOTORS[0], MOTORS[1], MOTORS[2]] {
        let rig = RigFile::parse(name, &text(actuator)).unwrap();
        for (payload_kg, seed) in [(0.0, 1), (1.0, 2)] {
            let sound = armed(&rig, [30.0, 20.0], payload_kg, seed);
            for motor in 0..3 {
                let mut stand = sound.clone();
                stand.command(&move_to([210.0, 15.0])).unwrap();
                pass(&mut stand, 0.3);
                stand.plant().set_defect(Defect::MotorJammed(motor), true);
                let (mut named_s, mut highest_n) = (None, 0.0_f64);
                for tick in 0..ticks(1.5) {
                    stand.tick().unwrap();
                    highest_n = stand.truth.tensions_n.into_iter().fold(highest_n, f64::max);
                    if stand.faults().any() {
                        named_s.get_or_insert(tick as f64 / ticks(1.0) as f64);
                    }
                }
                let what =
                    format!("{name}, {payload_kg} kg, motor {motor}: {named_s:?}, {highest_n} N");
                assert!(named_s.is_some_and(|named_s| named_s < NAMED_S), "{what}");
                assert!(highest_n < 1.4 * rig.f_max_n, "{what}");
                assert!(!stand.state().led(), "{what}");
            }
        }
    }
}

/// What is told of a long homing is what it takes, within a fifth.
#[test]
fn a_long_homing_is_told_before() {
    for gear_ratio in [28, 40] {
        let file = RigText {
            name: "slow".into(),
            text: text(&format!("gear_ratio = {gear_ratio}\n")),
        };
        let (rig, notes) = file.read().unwrap();
        let told = notes.iter().find_map(|note| {
            let (_, rest) = note.split_once("homing takes some ")?;
            rest.split_once(" s ")?.0.parse::<f64>().ok()
        });
        let told_s = told.unwrap_or_else(|| panic!("{notes:?}"));
        let lasts_s = homed(&rig, 1.0).time_s() - HOMES_S;
        assert!(
            (told_s / lasts_s - 1.0).abs() < 0.2,
            "{told_s} s, {lasts_s} s"
        );
    }
}

/// A count of the encoder is as much as a light rotor goes in a check as it starts.
#[test]
fn coarse_counts_of_a_light_rotor_do_not_jump() {
    let motor = "resistance_ohm = 1.93415\ninductance_h = 0.000217929\ntorque_constant_nm_per_a = 0.0266031\ninertia_kg_m2 = 9.83867e-07\n\
                 friction_nm = 0.000908567\ngear_ratio = 2.64231\nlead_m = 0.0005\ncounts_per_turn = 256\nsupply_v = 12\nsupply_range_v = 18\n\
                 current_range_a = 5\nscrew_efficiency = 0.340036\nbacklash_rad = 0.0441434\n";
    let rig = RigFile::parse("coarse", &with_stiffness(&text(motor), 3.7e5)).unwrap();
    work("coarse", &rig).unwrap();
}

/// What the file is refused for: the key at the place, words of the sentence, and what the help would have.
#[test]
fn motors_that_cannot_work_are_refused_at_their_key() {
    for (actuator, place, words, help) in [
        (
            "[control.servo]\ncurrent_a = 0.6\n",
            "0.6",
            "cannot pull the maximum tension",
            "at least 1",
        ),
        (
            "current_range_a = 2\n",
            "2",
            "cannot pull the maximum tension",
            "`actuator.current_range_a` at least 2.3",
        ),
        (
            "continuous_a = 0.2\nthermal_time_s = 20\n",
            "0.2",
            "cannot pull the maximum tension",
            "`continuous_a` is at least 1",
        ),
        (
            "resistance_ohm = 30\n",
            "30",
            "cannot drive a motor at the maximum tension",
            "`supply_v` at least 48",
        ),
        (
            "[control.servo]\nspeed_m_per_s = 0.06\n",
            "0.06",
            "beyond every supply",
            "at most 0.031",
        ),
        (
            "[control.servo]\ndead_band_m = 5e-8\n",
            "5e-8",
            "narrower than a count",
            "at least 2e-7",
        ),
        (
            "[control.servo]\nposition_gain_per_s = 500\n",
            "500",
            "it rings",
            "at most 1",
        ),
        (
            "continuous_a = 1.1\nthermal_time_s = 1\n[control.servo]\ncurrent_a = 5.4\n",
            "5.4",
            "more than the winding bears",
            "at most 1.3",
        ),
    ] {
        let file = text(actuator);
        let error = RigFile::parse("refused", &file).unwrap_err();
        let shown = error.render(false);
        assert!(
            shown.contains(words) && shown.contains(help),
            "{actuator}{shown}"
        );
        let (Failure::Refused(message) | Failure::Failed(message)) = error;
        let at = &file[message.place.unwrap().span];
        assert!(at.starts_with(place), "{actuator}{at}");
    }
}

/// What follows from a motor keeps to its own limits: the file is not warned of what it did not give.
#[test]
fn derived_limits_are_not_warned_of() {
    let mut files = 0;
    for continuous_a in [1.0, 1.034, 1.05, 1.234, 1.5] {
        for thermal_time_s in [3, 7, 20, 60] {
            let text = text(&format!(
                "continuous_a = {continuous_a}\nthermal_time_s = {thermal_time_s}\n"
            ));
            let read = RigText {
                name: "derived".into(),
                text,
            }
            .read();
            let Ok((_, notes)) = read else { continue };
            files += 1;
            let beyond = notes.iter().find(|note| note.contains("winding bears for"));
            assert_eq!(beyond, None, "{continuous_a} A, {thermal_time_s} s");
        }
    }
    assert!(files > 10, "{files} files");
}

/// What is doubtful is told with its line, and does not stop anybody.
#[test]
fn what_is_doubtful_is_a_warning_with_its_line() {
    for (actuator, words) in [
        (
            "continuous_a = 0.9\nthermal_time_s = 20\n",
            "goes on pulling",
        ),
        (
            "continuous_a = 0.9\nthermal_time_s = 20\n[control.servo]\ncurrent_a = 5\n",
            "more than the winding bears for",
        ),
        (
            "[control.servo]\nspeed_m_per_s = 0.034\n",
            "give at most 0.031",
        ),
        (
            "[control.motion]\nspeed_rad_per_s = 1.6\n",
            "asks the tendons for more",
        ),
        (
            "[control.limits]\nramp_m_per_s = 2e-4\ntaut_time_s = 60\n[control.servo]\nspeed_m_per_s = 2e-4\n",
            "no slower turn than 0.01 may be given: let the tendons have at least 2.7e-4",
        ),
        (
            "[control.servo]\ndead_band_m = 1e-7\n",
            "narrower than a count",
        ),
        (
            "counts_per_turn = 16\n",
            "at the tip: `counts_per_turn` of ",
        ),
        (
            "[control.servo]\ndead_band_m = 1e-4\n",
            "at the tip: a band of 5.4e-6 would do",
        ),
        (
            "[control.homing]\nspeed_m_per_s = 0.02\n",
            "homing may fail as tendons are pulled too hard before their motors stop: give at most 0.015",
        ),
        (
            "current_output = \"magnitude_when_driven\"\n[control.homing]\nspeed_m_per_s = 0.002\n",
            "too short for its current output",
        ),
        (
            "[control.servo]\nspeed_gain_v_s_per_m = 3500\n",
            "phase margin",
        ),
        ("gear_ratio = 40\n", "homing takes some 1"),
        (
            "[simulation]\nsupply_resistance_ohm = 1\n",
            "falls as low as `control.limits.supply_min_v` (18): up to 0.86 Ω",
        ),
        (
            "lead_m = 2e-3\ngear_ratio = 2.2\nbacklash_rad = 0.08\n",
            "throws its rotor to and fro within a play of 2.5e-5 m",
        ),
        (
            "[control.limits]\nsupply_min_v = 4\n",
            "is not found between that and `control.limits.supply_min_v` (4): ",
        ),
    ] {
        let file = text(actuator);
        let line = file.lines().count();
        let name = String::from("doubtful");
        let (_, notes) = RigText { name, text: file }.read().unwrap();
        let found = notes.iter().any(|note| {
            note.starts_with("doubtful: warning: ")
                && note.contains(words)
                && (note.contains(&format!("(line {line})")) || actuator.lines().count() > 1)
        });
        assert!(found, "{actuator}{notes:?}");
    }
}
