//! The kit of BOARD.md, computed from the values in its tables: ranges, time constants, and what a broken wire reads.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_boards::image::workspace_root;
use leg_firmware::sensors::{CODE_MAX, TICK_HZ};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::FAULT_TABLE;
use leg_rig::actuator::Actuator;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use std::f64::consts::TAU;

/// What the converter takes as its highest code, V.
const FULL_V: f64 = 3.3;

/// A load cell's code this near to an end of its range is a fault: see `SATURATED` in the supervisor.
const SATURATED: f64 = 64.0;

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

/// The highest supply of the LM7705, V.
const NEGATIVE_SUPPLY_V: f64 = 5.25;

/// From one pulse of the motors to the next, s.
const PULSE_S: f64 = 1.0 / 40e3;

/// What a driver's input that floats may take or give, A.
const LEAK_A: f64 = 10e-6;

/// INA826: largest offsets of input and output, V; bias current, A; how near its output comes to its supplies, V.
const AMPLIFIER_OFFSET_V: [f64; 2] = [150e-6, 700e-6];
const AMPLIFIER_BIAS_A: f64 = 65e-9;
const AMPLIFIER_REACH_V: [f64; 2] = [0.1, 0.15];

/// INA240: how near its output comes to its supply, V.
const SENSOR_REACH_V: f64 = 0.2;

/// The values of the page, in SI units.
struct Page(String);

impl Page {
    fn read() -> Self {
        Self(std::fs::read_to_string(workspace_root().join("firmware/BOARD.md")).unwrap())
    }

    /// The value of a name: it stands in one table alone.
    fn value(&self, name: &str) -> f64 {
        let start = format!("| {name} |");
        let rows: Vec<&str> = self
            .0
            .lines()
            .filter(|row| row.starts_with(&start))
            .collect();
        let [row] = rows.as_slice() else {
            panic!("{name} stands in {} rows", rows.len());
        };
        let text = row.split('|').nth(2).unwrap().trim().replace('−', "-");
        let (number, unit) = text.split_once(' ').unwrap();
        let scale = match unit {
            "Ω" | "V" | "A" | "N" | "V/V" | "lines" => 1.0,
            "kΩ" | "kHz" => 1e3,
            "MΩ" => 1e6,
            "mΩ" | "mV/V" | "mV/K" => 1e-3,
            "µF" => 1e-6,
            "nF" => 1e-9,
            "pF" => 1e-12,
            _ => panic!("{name}: {unit}"),
        };
        number.parse::<f64>().unwrap() * scale
    }

    fn values<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        names.map(|name| self.value(name))
    }

    /// The table of broken wires.
    fn broken_rows(&self) -> impl Iterator<Item = &str> {
        let (_, table) = self
            .0
            .split_once("| broken | volts at the pin | found as |")
            .unwrap();
        table.lines().skip(2).take_while(|row| row.starts_with('|'))
    }

    /// What the table of broken wires says of one: volts, and what it is found as.
    fn broken(&self, wire: &str) -> [&str; 2] {
        let start = format!("| {wire} |");
        let row = self
            .broken_rows()
            .find(|row| row.starts_with(&start))
            .unwrap();
        let mut cells = row.split('|').skip(2).map(str::trim);
        [cells.next().unwrap(), cells.next().unwrap()]
    }
}

fn settings() -> Settings {
    Settings::for_table_1().unwrap()
}

fn code(volts: f64) -> f64 {
    (volts / FULL_V * f64::from(CODE_MAX)).clamp(0.0, f64::from(CODE_MAX))
}

#[track_caller]
fn near(found: f64, expected: f64, part: f64) {
    assert!(
        (found - expected).abs() <= part * expected.abs(),
        "{found} is not {expected} within {part}"
    );
}

/// The load cell with its amplifier.
struct Cell {
    /// V at the pin for each N.
    v_per_n: f64,
    gain: f64,
    /// V at the pin without a tension.
    zero_v: f64,
    /// The same without the cell's supply.
    unsupplied_v: f64,
    /// What the amplifier reaches, V.
    reach_v: [f64; 2],
}

impl Cell {
    fn of(page: &Page) -> Self {
        let [supply, signal, rated, r1] = page.values(["VE", "S1", "F1", "R1"]);
        let [positive, negative, r4, r5] = page.values(["VP", "VN", "R4", "R5"]);
        let gain = 1.0 + 49.4e3 / r1;
        let reference = |sense: f64| (sense * r5 + negative * r4) / (r4 + r5);
        let [low, high] = AMPLIFIER_REACH_V;
        Self {
            v_per_n: gain * supply * signal / rated,
            gain,
            zero_v: reference(supply),
            unsupplied_v: reference(0.0),
            reach_v: [negative + low, positive - high],
        }
    }

    fn range_n(&self) -> [f64; 2] {
        [0.0, FULL_V].map(|volts| (volts - self.zero_v) / self.v_per_n)
    }

    /// Largest offset at the pin, V.
    fn offset_v(&self) -> f64 {
        let [input, output] = AMPLIFIER_OFFSET_V;
        self.gain * input + output
    }

    /// What the pin sees of what the amplifier should give, V.
    fn limited(&self, volts: f64) -> f64 {
        let [low, high] = self.reach_v;
        volts.clamp(low, high)
    }
}

#[test]
fn the_load_cell_covers_the_tensions_and_reaches_both_ends_of_the_range() {
    let (page, settings) = (Page::read(), settings());
    let cell = Cell::of(&page);
    let [low, high] = cell.range_n();
    let [default_low, default_high] = Actuator::DEFAULT.cell_range_n;
    near(high - low, default_high - default_low, 0.02);
    near(
        cell.zero_v / FULL_V,
        -default_low / (default_high - default_low),
        0.03,
    );
    // The fault for too much tension comes before the end of the range.
    let most_n = f64::from(settings.f_max_n) * (1.0 + f64::from(settings.limits.over_tension_part));
    assert!(
        most_n + f64::from(settings.homing.tare_max_n) < high,
        "{most_n} N of {high} N"
    );
    // What homing takes for a zero is no end of the range, and the amplifier's offset is taken for one.
    let tare_n = f64::from(settings.homing.tare_max_n);
    assert!(code((tare_n.mul_add(-cell.v_per_n, cell.zero_v)).max(0.0)) > SATURATED);
    assert!(cell.offset_v() / cell.v_per_n < tare_n);
    assert!(cell.reach_v[0] < 0.0 && cell.reach_v[1] > FULL_V);
    // The inputs stay a volt below the supply.
    let [supply, positive] = page.values(["VE", "VP"]);
    assert!(supply <= positive - 1.0 && positive < NEGATIVE_SUPPLY_V);
    // The low pass is faster than the firmware's, and slower than the converter samples 16 times.
    let [r6, r7, c1] = page.values(["R6", "R7", "C1"]);
    assert!(c1 > 1e3 * SAMPLED_F);
    // What the amplifier drives, and what the clamp takes at a diode's 0.3 V.
    let most_v = cell.reach_v[1];
    assert!(most_v / r6 < OUTPUT_A && (most_v - FULL_V - 0.3) / r7 < OUTPUT_A);
    assert!(r7 * c1 < 0.1 * f64::from(settings.estimation.tension_time_s));
    // The resistors at the inputs disturb the zero by less than is tared, were one of them 1 % off.
    let [r2] = page.values(["R2"]);
    let bridge_v = supply / 2.0 / r2 * 0.01 * 350.0 / 2.0;
    assert!(bridge_v * cell.gain / cell.v_per_n < 0.5);
}

#[test]
fn a_broken_wire_of_a_load_cell_is_an_end_of_its_range() {
    let (page, settings) = (Page::read(), settings());
    let cell = Cell::of(&page);
    let [r2, r6, r7, c1] = page.values(["R2", "R6", "R7", "C1"]);
    let saturated = |wire: &str| {
        let [volts, fault] = page.broken(wire);
        assert!(fault.starts_with("saturated load cell"), "{wire}: {fault}");
        volts.to_owned()
    };
    // From the highest tension down to the end of the range.
    assert_eq!(saturated("amplifier to board"), "0");
    let most_v = cell.zero_v + f64::from(settings.f_max_n) * 1.1 * cell.v_per_n;
    let end_v = SATURATED / f64::from(CODE_MAX) * FULL_V;
    let time_s = (r6 + r7) * c1 * (most_v / end_v).ln();
    assert!(time_s < 1e-3, "{time_s} s");
    // No signal is left, but the amplifier's offset, to whichever side.
    assert_eq!(saturated("supply of the cell"), "below 0");
    let worst_v = cell.limited(cell.unsupplied_v + cell.offset_v());
    assert!(worst_v < 0.0, "{worst_v} V");
    // The signal is left, and its zero falls.
    let fall_v = cell.zero_v - page.value("VN");
    let fall_n = fall_v / cell.v_per_n;
    let told = format!("{fall_v:.2} lower, which is {fall_n:.1} N");
    assert_eq!(
        page.broken("sense wire"),
        [told.as_str(), "jump of a tension"]
    );
    assert!(fall_n > 1.2 * f64::from(settings.limits.jump_n));
    // A signal wire that is broken is at ground, but for the amplifier's bias; the other one is at half the supply.
    let [supply] = page.values(["VE"]);
    assert!(AMPLIFIER_BIAS_A * r2 < 0.1 * supply / 2.0);
    let apart_v = supply / 2.0 - AMPLIFIER_BIAS_A * r2;
    assert_eq!(saturated("signal + of the cell"), "below 0");
    assert!(code(cell.limited(cell.zero_v - cell.gain * apart_v)) < SATURATED);
    assert_eq!(saturated("signal − of the cell"), "above 3.3");
    assert!(
        code(cell.limited(cell.zero_v + cell.gain * apart_v)) > f64::from(CODE_MAX) - SATURATED
    );
}

#[test]
fn the_current_sensor_covers_the_limits_in_both_directions() {
    let (page, settings) = (Page::read(), settings());
    let [shunt, gain, r8, r9, c2] = page.values(["RS", "GS", "R8", "R9", "C2"]);
    let range_a = FULL_V / 2.0 / (gain * shunt);
    near(range_a, Actuator::DEFAULT.current_range_a, 0.02);
    let limit_a = f64::from(settings.limits.current_a);
    let reached_a = (FULL_V / 2.0 - SENSOR_REACH_V) / (gain * shunt);
    assert!(limit_a < reached_a, "{reached_a} A");
    assert!(limit_a.powi(2) * shunt < 1.0, "the shunt bears 1 W");
    // By the built-in settings it reads wrong by less than counts as a disagreement.
    let wrong_a = limit_a * (Actuator::DEFAULT.current_range_a / range_a - 1.0).abs();
    assert!(wrong_a < 0.2 * f64::from(settings.limits.disagreement_a));
    let [volts, fault] = page.broken("current sensor to board");
    assert_eq!(volts, format!("0, which is −{range_a:.1} A"));
    assert_eq!(fault, "too much current, within 3 ms");
    assert!(range_a > limit_a);
    // From no current to the limit, and 2 ms for the fault.
    let limit_v = FULL_V / 2.0 - limit_a * gain * shunt;
    let time_s = (r8 + r9) * c2 * (FULL_V / 2.0 / limit_v).ln() + 2e-3;
    assert!(time_s < 3e-3, "{time_s} s");
    assert!(r9 * c2 < 0.2 / f64::from(TICK_HZ));
    assert!(c2 > 1e3 * SAMPLED_F && FULL_V / r8 < OUTPUT_A);
}

#[test]
fn the_encoder_is_fast_enough_and_an_open_collector_is_not() {
    let (page, settings) = (Page::read(), settings());
    let [lines, most_hz, cable] = page.values(["N1", "FE", "CW"]);
    let actuator = Actuator::DEFAULT;
    near(4.0 * lines, actuator.counts_per_turn, 1e-9);
    let speed_m_per_s = f64::from(settings.servo.speed_m_per_s);
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
    near(range_v, Actuator::DEFAULT.supply_range_v, 0.02);
    near(supply, Actuator::DEFAULT.supply_v, 1e-9);
    let bounds_v = [limits.supply_min_v, limits.supply_max_v].map(f64::from);
    assert!(bounds_v[0] < supply && supply < bounds_v[1] && bounds_v[1] < range_v);
    let mean_s = r18 * r19 / (r18 + r19) * c4;
    assert!(mean_s > 10.0 * PULSE_S && mean_s < 2e-3, "{mean_s} s");
    assert_eq!(page.broken("resistor R18"), ["0", "supply too low"]);
    assert_eq!(
        page.broken("resistor R19"),
        ["above 3.3, clamped", "supply too high"]
    );
    assert!(supply / r18 < 1e-3, "through the clamp");
    // Fuses: above what is driven, below what the wires and the contactor bear.
    let [main, each, contactor, wire] = page.values(["F2", "F3", "AK", "AW"]);
    let driven_a = f64::from(settings.servo.current_a);
    assert!(driven_a * 1.5 < each && 3.0 * driven_a < main);
    assert!(each < main && main < wire && main < contactor);
    // A motor that stops from its fastest gives all that turns in it to its capacitor.
    let [capacitor, highest_v, bleeder] = page.values(["C5", "VD", "R21"]);
    let actuator = Actuator::DEFAULT;
    let turning = f64::from(settings.servo.speed_m_per_s) / actuator.lead_m * actuator.gear_ratio;
    let energy_j = 0.5 * actuator.inertia_kg_m2 * (TAU * turning).powi(2);
    let risen_v = (supply.powi(2) + 2.0 * energy_j / capacitor).sqrt();
    assert!(
        risen_v < bounds_v[1] && bounds_v[1] < highest_v,
        "{risen_v} V"
    );
    // What the pages say of the time after the emergency stop.
    let down_s = 3.0 * capacitor * bleeder * (supply / 5.0).ln();
    assert!((14.0..16.0).contains(&down_s), "{down_s} s");
    assert!(page.0.contains("falls below 5 V within 16 s"));
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
    near(cold_c + (hot_c - cold_c) * limit_v / FULL_V, limit_c, 0.02);
    // The sensor drives 100 µA.
    assert!(FULL_V / r20 < 100e-6 && r20 * c6 > 100.0 * PULSE_S && r20 * c6 < 0.1);
    let [volts, fault] = page.broken("temperature sensor");
    assert_eq!(volts, format!("0, which is −{:.1} °C", zero_v / v_per_k));
    assert!(fault.starts_with("not found: "));
}

/// The section for the rig file is what the values give.
#[test]
fn the_section_of_the_page_is_that_of_the_kit() {
    let page = Page::read();
    let (_, section) = page.0.split_once("```toml\n").unwrap();
    let (section, _) = section.split_once("```").unwrap();
    let text = [READY_RIGS[0].text, "\n", section].concat();
    let actuator = RigFile::parse("kit", &text).unwrap().actuator;
    for (given, computed) in actuator
        .cell_range_n
        .into_iter()
        .zip(Cell::of(&page).range_n())
    {
        near(given, computed, 0.003);
    }
    let [shunt, gain, r18, r19] = page.values(["RS", "GS", "R18", "R19"]);
    near(
        actuator.current_range_a,
        FULL_V / 2.0 / (gain * shunt),
        0.001,
    );
    near(actuator.supply_range_v, FULL_V * (1.0 + r18 / r19), 0.001);
    let [zero_v, v_per_k] = page.values(["V0", "ST"]);
    for (given, volts) in actuator.temperature_range_c.into_iter().zip([0.0, FULL_V]) {
        near(given, (volts - zero_v) / v_per_k, 0.003);
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
