//! The kit of BOARD.md, computed from the values in its tables: ranges, time constants, and what a broken wire reads.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod load_cell;
mod page;

use crate::common::require_said;
use leg_firmware::sensors::{CURRENT_ZERO_PART, TICK_HZ};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::FAULT_TABLE;
use leg_rig::actuator::Actuator;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigText;
use load_cell::Cell;
use page::Page;
use std::f64::consts::TAU;

/// What the converter takes as its highest code, V.
const FULL_V: f64 = 3.3;

/// The chip's own pull-ups, Ω: the least and the usual.
const PULL_UP: [f64; 2] = [25e3, 40e3];

/// What is low, and what is high, for an input of the chip, V.
const LOW_V: f64 = 0.3 * FULL_V;
const HIGH_V: f64 = 0.7 * FULL_V;

/// What is low for a driver's inputs, V.
const DRIVER_LOW_V: f64 = 0.8;

/// What a pin of the chip drives, A.
const PIN_A: f64 = 8e-3;

/// What the converter takes in to sample, F: what it is taken from has a thousand times as much.
const SAMPLED_F: f64 = 5e-12;

/// What an amplifier's output and a clamp are asked for at most, A.
const OUTPUT_A: f64 = 2e-3;

/// From one pulse of the motors to the next, s.
const PULSE_S: f64 = 1.0 / 40e3;

/// What a driver's input that floats may take or give, A.
const LEAK_A: f64 = 10e-6;

/// INA240: how near its output comes to its supply, V.
const SENSOR_REACH_V: f64 = 0.2;

fn settings() -> Settings {
    Settings::table_1().unwrap()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, part: f64) {
    assert!(
        (found - expected).abs() <= part * expected.abs(),
        "{found} is not {expected} within {part}"
    );
}

/// How far a current sensor is from the 25 °C of its data sheet, K.
const HEATED_K: f64 = 60.0;

#[test]
fn the_current_sensor_covers_the_limits_in_both_directions() {
    let (page, settings) = (Page::read(), settings());
    let [shunt, gain, r8, r9, c2] = page.values(["RS", "GS", "R8", "R9", "C2"]);
    let range_a = FULL_V / 2.0 / (gain * shunt);
    assert_near(range_a, Actuator::DEFAULT.current_range_a, 0.02);
    let limit_a = f64::from(settings.limits.current_a);
    let reached_a = (FULL_V / 2.0 - SENSOR_REACH_V) / (gain * shunt);
    assert!(limit_a < reached_a, "{reached_a} A");
    assert!(limit_a.powi(2) * shunt < 1.0, "the shunt bears 1 W");
    // By the built-in settings it reads wrong by less than counts as a disagreement.
    let wrong_a = limit_a * (Actuator::DEFAULT.current_range_a / range_a - 1.0).abs();
    assert!(wrong_a < 0.2 * f64::from(settings.limits.disagreement_a));
    let [volts, fault] = page.broken("current sensor to board");
    assert_eq!(volts, format!("0, which is −{range_a:.1} A"));
    assert_eq!(
        fault,
        "too much current, within 3 ms while the drivers are on"
    );
    assert!(range_a > limit_a);
    // From no current to the limit, and 2 ms for the fault.
    let limit_v = FULL_V / 2.0 - limit_a * gain * shunt;
    let time_s = (r8 + r9) * c2 * (FULL_V / 2.0 / limit_v).ln() + 2e-3;
    assert!(time_s < 3e-3, "{time_s} s");
    assert!(r9 * c2 < 0.2 / f64::from(TICK_HZ));
    assert!(c2 > 1e3 * SAMPLED_F && FULL_V / r8 < OUTPUT_A);
}

/// All errors of the zero at once, in a sensor that has a supply of its own: the start takes it. What the kit's own may have is an
/// eighth of that.
#[test]
fn the_zero_of_a_current_is_within_what_is_taken() {
    let page = Page::read();
    let [shunt, gain, divider, other, steps] = page.values(["RS", "GS", "OR", "OV", "OC"]);
    let [offset_v, drift_v_per_k] = page.values(["OS", "OD"]);
    let input_v = offset_v + drift_v_per_k * HEATED_K;
    let kit_v = gain * input_v + divider * FULL_V / 2.0 + steps * FULL_V / 4095.0;
    let part = |volts: f64| volts / (FULL_V / 2.0);
    assert!(part(kit_v) < 0.125 * f64::from(CURRENT_ZERO_PART));
    let most_v = kit_v + other * FULL_V / 2.0;
    let sentence = format!(
        "All of the above together is {:.1} %, and {:.1} % with the kit.",
        100.0 * part(most_v),
        100.0 * part(kit_v)
    );
    assert!(page.0.contains(&sentence), "{sentence}");
    assert!(part(most_v) < f64::from(CURRENT_ZERO_PART), "{most_v} V");
    // A broken wire is none, nor a driver's output that is at an end of its range.
    assert!(f64::from(CURRENT_ZERO_PART) < 0.5);
    let taken_a = f64::from(CURRENT_ZERO_PART) * FULL_V / 2.0 / (gain * shunt);
    let sentence = format!("up to {taken_a:.2} A");
    assert!(page.0.contains(&sentence), "{sentence}");
}

#[test]
fn the_encoder_is_fast_enough_and_an_open_collector_is_not() {
    let (page, settings) = (Page::read(), settings());
    let [lines, most_hz, cable] = page.values(["N1", "FE", "CW"]);
    let actuator = Actuator::DEFAULT;
    assert_near(4.0 * lines, actuator.counts_per_turn, 1e-9);
    let speed_m_per_s = f64::from(settings.servos[0].speed_m_per_s);
    let turns_per_s = speed_m_per_s / actuator.lead_m * actuator.gear_ratio;
    let track_hz = turns_per_s * lines;
    assert!(track_hz < 0.8 * most_hz, "{track_hz} Hz");
    // The counter's filter takes 0.4 µs: eight samples at an eighth of 170 MHz.
    let half_s = 0.5 / track_hz;
    assert!(8.0 * 8.0 / 170e6 < 0.1 * half_s);
    // Differences of 16 bits are taken every tick.
    assert!(4.0 * track_hz / f64::from(TICK_HZ) < 1e3);
    let [between] = page.values(["R10"]);
    assert!(
        (100.0..=130.0).contains(&between),
        "no end of a line: {between} Ω"
    );
    let rise_s = PULL_UP[1] * cable * (FULL_V / (FULL_V - HIGH_V)).ln();
    assert!(
        rise_s > half_s,
        "an open collector rises in {rise_s} s of {half_s} s"
    );
}

#[test]
fn fault_and_stop_lines_are_low_and_high_by_a_margin() {
    let page = Page::read();
    let [r11, r12, r13, r14, c3] = page.values(["R11", "R12", "R13", "R14", "C3"]);
    let [diode_v, output_v] = page.values(["VF", "VO"]);
    for pull_up in [r11, r12, r13] {
        assert!((2.2e3..=4.7e3).contains(&pull_up), "{pull_up} Ω");
        let rise_s = pull_up * c3 * (FULL_V / (FULL_V - HIGH_V)).ln();
        assert!(rise_s < 0.1 / f64::from(TICK_HZ), "{rise_s} s");
    }
    let both = |pull_up: f64| 1.0 / (1.0 / pull_up + 1.0 / PULL_UP[0]);
    // The diode's voltage is given at 1 mA.
    assert!(FULL_V / both(r12) <= 1e-3, "through the diode");
    assert!(output_v + diode_v < LOW_V);
    assert!(FULL_V * r14 / (r14 + both(r13)) < 0.5 * LOW_V);
    assert_eq!(page.broken("emergency stop"), ["3.3", "emergency stop"]);
    for wire in ["one wire of a fault line", "shared fault line"] {
        assert!(page.broken(wire)[1].starts_with("not found: "));
    }
}

#[test]
fn drivers_are_off_while_the_chip_is_in_reset() {
    let page = Page::read();
    let [enable, pulse, pulled_up] = page.values(["R15", "R16", "R17"]);
    assert!(FULL_V * enable / (enable + pulled_up) < DRIVER_LOW_V);
    // Three drivers are at one pin.
    assert!(3.0 * FULL_V / enable < PIN_A && 3.0 * FULL_V / pulse < PIN_A);
    assert!(LEAK_A * pulse < 0.5 * DRIVER_LOW_V);
}

#[test]
fn the_motor_supply_is_measured_fused_and_takes_what_the_motors_give_back() {
    let (page, settings) = (Page::read(), settings());
    let limits = &settings.limits;
    let [supply, r18, r19, c4] = page.values(["VM", "R18", "R19", "C4"]);
    let range_v = FULL_V * (1.0 + r18 / r19);
    assert_near(range_v, Actuator::DEFAULT.supply_range_v, 0.02);
    assert_near(supply, Actuator::DEFAULT.supply_v, 1e-9);
    let bounds_v = [limits.supply_min_v, limits.supply_max_v].map(f64::from);
    assert!(bounds_v[0] < supply && supply < bounds_v[1] && bounds_v[1] < range_v);
    let mean_s = r18 * r19 / (r18 + r19) * c4;
    assert!(mean_s > 10.0 * PULSE_S && mean_s < 2e-3, "{mean_s} s");
    assert_eq!(
        page.broken("resistor R18"),
        ["0", "supply too low, while the drivers are on"]
    );
    assert_eq!(
        page.broken("resistor R19"),
        ["above 3.3, clamped", "supply too high"]
    );
    assert!(supply / r18 < 1e-3, "through the clamp");
    // Fuses: above what is driven, below what the wires and the contactor bear.
    let [main, each, contactor, wire] = page.values(["F2", "F3", "AK", "AW"]);
    let driven_a = f64::from(settings.servos[0].current_a);
    assert!(driven_a * 1.5 < each && 3.0 * driven_a < main);
    assert!(each < main && main < wire && main < contactor);
    // A motor that stops from its fastest gives all that turns in it to its capacitor.
    let [capacitor, highest_v, bleeder] = page.values(["C5", "VD", "R21"]);
    let actuator = Actuator::DEFAULT;
    let turning =
        f64::from(settings.servos[0].speed_m_per_s) / actuator.lead_m * actuator.gear_ratio;
    let energy_j = 0.5 * actuator.inertia_kg_m2 * (TAU * turning).powi(2);
    let risen_v = (supply.powi(2) + 2.0 * energy_j / capacitor).sqrt();
    assert!(
        risen_v < bounds_v[1] && bounds_v[1] < highest_v,
        "{risen_v} V"
    );
    // What the pages say of the time after the emergency stop.
    let down_s = 3.0 * capacitor * bleeder * (supply / 5.0).ln();
    const WITHIN_S: f64 = 16.0;
    assert!((14.0..WITHIN_S).contains(&down_s), "{down_s} s");
    require_said(
        "firmware/BOARD.md",
        &[format!("falls below 5 V within {WITHIN_S} s")],
    );
    require_said(
        "firmware/SAFETY.md",
        &[format!("above 5 V for up to {WITHIN_S} s")],
    );
    assert!(supply.powi(2) / bleeder < 1.0, "it bears 2 W");
}

#[test]
fn the_temperature_sensor_shows_its_limit_by_either_settings() {
    let (page, settings) = (Page::read(), settings());
    let [zero_v, v_per_k, r20, c6] = page.values(["V0", "ST", "R20", "C6"]);
    let limit_c = f64::from(settings.limits.temperature_c);
    let limit_v = zero_v + limit_c * v_per_k;
    assert!(limit_v < 0.8 * FULL_V);
    let [cold_c, hot_c] = Actuator::DEFAULT.temperature_range_c;
    // Whoever forgets to set the kit's range is told the limit to 2 K.
    assert_near(cold_c + (hot_c - cold_c) * limit_v / FULL_V, limit_c, 0.02);
    // The sensor drives 100 µA.
    assert!(FULL_V / r20 < 100e-6 && r20 * c6 > 100.0 * PULSE_S && r20 * c6 < 0.1);
    let [volts, fault] = page.broken("temperature sensor");
    assert_eq!(volts, format!("0, which is −{:.1} °C", zero_v / v_per_k));
    assert!(fault.starts_with("not found: "));
}

/// The fastest that the kit's gear turns at its input, 1/min.
const GEAR_PER_MIN: f64 = 8000.0;

/// The section for the rig file is what the values give.
#[test]
fn the_section_of_the_page_is_that_of_the_kit() {
    let page = Page::read();
    let (_, section) = page.0.split_once("```toml\n").unwrap();
    let (section, _) = section.split_once("```").unwrap();
    let text = [READY_RIGS[0].text, "\n", section].concat();
    let name = "kit".into();
    let (file, notes) = RigText { name, text }.read().unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let actuator = file.actuators[0];
    assert_near(actuator.gear_ratio, 57.0 / 13.0, 1e-5);
    let turns_per_min = 60.0 * f64::from(settings().servos[0].speed_m_per_s) / actuator.lead_m
        * actuator.gear_ratio;
    assert!(turns_per_min < GEAR_PER_MIN, "{turns_per_min} / min");
    for (given, computed) in actuator
        .cell_range_n
        .into_iter()
        .zip(Cell::new(&page).range_n())
    {
        assert_near(given, computed, 0.003);
    }
    let [shunt, gain, r18, r19] = page.values(["RS", "GS", "R18", "R19"]);
    assert_near(
        actuator.current_range_a,
        FULL_V / 2.0 / (gain * shunt),
        0.001,
    );
    assert_near(actuator.supply_range_v, FULL_V * (1.0 + r18 / r19), 0.001);
    let [zero_v, v_per_k] = page.values(["V0", "ST"]);
    for (given, volts) in actuator.temperature_range_c.into_iter().zip([0.0, FULL_V]) {
        assert_near(given, (volts - zero_v) / v_per_k, 0.003);
    }
}

/// What the table of broken wires names is a fault, or is said not to be found.
#[test]
fn broken_wires_are_found_as_faults_that_there_are() {
    let page = Page::read();
    let rows: Vec<&str> = page.broken_rows().collect();
    assert_eq!(rows.len(), 14);
    for row in rows {
        let found = row.split('|').nth(3).unwrap().trim();
        let known = FAULT_TABLE
            .iter()
            .any(|entry| found.starts_with(entry.name));
        assert!(known || found.starts_with("not found: "), "{row}");
    }
}
