//! A load cell with its amplifier: its range, and what a broken wire of it reads.

use super::page::Page;
use super::{FULL_V, OUTPUT_A, SAMPLED_F, assert_near, settings};
use leg_firmware::sensors::CODE_MAX;
use leg_rig::actuator::Actuator;

/// A load cell's code this near to an end of its range is a fault: see `SATURATED` in the supervisor.
const SATURATED: f64 = 64.0;

/// The highest supply of the LM7705, V.
const NEGATIVE_SUPPLY_V: f64 = 5.25;

/// INA826: largest offsets of input and output, V; bias current, A; how near its output comes to its supplies, V.
const AMPLIFIER_OFFSET_V: [f64; 2] = [150e-6, 700e-6];
const AMPLIFIER_BIAS_A: f64 = 65e-9;
const AMPLIFIER_REACH_V: [f64; 2] = [0.1, 0.15];

fn code(volts: f64) -> f64 {
    (volts / FULL_V * f64::from(CODE_MAX)).clamp(0.0, f64::from(CODE_MAX))
}

/// The load cell with its amplifier.
pub struct Cell {
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
    /// With the values of the page.
    pub fn new(page: &Page) -> Self {
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

    /// The tensions at both ends of the converter's range, N.
    pub fn range_n(&self) -> [f64; 2] {
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
    let cell = Cell::new(&page);
    let [low, high] = cell.range_n();
    let [default_low, default_high] = Actuator::DEFAULT.cell_range_n;
    assert_near(high - low, default_high - default_low, 0.02);
    assert_near(
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
    let cell = Cell::new(&page);
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
    // What is lower than the range is saturated: a tendon that pulls little, or is slack.
    let least_n = (end_v + fall_v - cell.zero_v) / cell.v_per_n;
    let found = format!(
        "jump of a tension, while the drivers are on; saturated load cell, where its tendon pulls less than {least_n:.1} N"
    );
    assert_eq!(page.broken("sense wire"), [told, found]);
    assert!(cell.limited(cell.zero_v - fall_v) < 0.0);
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
