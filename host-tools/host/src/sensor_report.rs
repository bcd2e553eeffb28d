//! What the sensors of a leg read, raw and in a user's units.

use leg_base::json_object;
use leg_base::rounding::rounded;
use leg_firmware::control::{Measured, Measurement};
use leg_firmware::sensors::{CurrentZero, SensorReading};
use leg_firmware::settings::Settings;
use leg_rig::current_output;
use serde::Serialize;

/// What all sensors read in one tick, for machines, by the calibration of the leg's settings. Codes are from 0 to
/// [`leg_firmware::sensors::CODE_MAX`].
pub fn json(reading: &SensorReading, settings: &Settings) -> impl Serialize + use<> {
    let (sensors, measured) = (&reading.codes, measured(reading, settings));
    let zero_code = |i: usize| zero_code(reading, settings, i);
    let axis = |i: usize| {
        json_object! {
            // Counter of the motor's encoder; it wraps.
            encoder_counts: sensors.encoder_counts[i],
            cell_code: sensors.cell_codes[i],
            // N, without the tare that homing takes.
            tension_n: measured.tensions_n[i],
            // Whether the load cell was converted since the last tick.
            cell_fresh: sensors.cell_fresh[i],
            current_code: sensors.current_codes[i],
            // Code of no current: as found at the start, or that of the data sheet.
            current_zero_code: zero_code(i),
            // Whether it was found: `found`, `refused` or `not_found`.
            current_zero: zero_word(reading.current_zeros[i]),
            // A; above zero it pulls in, where the output shows both directions: else how much it reads.
            current_a: measured.currents_a[i],
            // What the output shows: `bidirectional`, `magnitude` or `magnitude_when_driven`.
            current_output: current_output::word(settings.current_outputs.each()[i]),
            // Whether the motor's driver raises its fault line.
            driver_fault: sensors.driver_fault[i],
        }
    };
    json_object! {
        axes: [0, 1, 2].map(axis),
        supply_code: sensors.supply_code,
        // V.
        supply_v: measured.supply_v,
        temperature_code: sensors.temperature_code,
        // Of the drivers, °C.
        temperature_c: measured.temperature_c,
        // Whether it is pressed.
        emergency_stop: sensors.emergency_stop,
        // Whether the last tick ended too late.
        late: sensors.late,
        // Whether the stored settings were not whole at the start, so that others are used.
        settings_corrupt: sensors.settings_corrupt,
    }
}

/// The same for people, as tables.
pub fn text(reading: &SensorReading, settings: &Settings) -> String {
    let (sensors, measured) = (&reading.codes, measured(reading, settings));
    let mut rows =
        String::from("axis  encoder   cell   tension N  current   zero   current A  driver\n");
    for axis in 0..3 {
        rows += &format!(
            "{:4}  {:7}  {:5}  {:10.2}  {:7}  {:5.0}  {:10.3}  {}{}\n",
            axis + 1,
            sensors.encoder_counts[axis],
            sensors.cell_codes[axis],
            rounded(measured.tensions_n[axis], 2),
            sensors.current_codes[axis],
            zero_code(reading, settings, axis),
            rounded(measured.currents_a[axis], 3),
            choose(sensors.driver_fault[axis], "fault", "ready"),
            choose(sensors.cell_fresh[axis], "", ", no fresh code of the cell"),
        );
    }
    for (axis, &zero) in reading.current_zeros.iter().enumerate() {
        rows += &zero_finding(axis + 1, zero, zero_code(reading, settings, axis));
    }
    rows + &format!(
        "\nsupply          {:5}  {:7.2} V\n\
         temperature     {:5}  {:7.1} °C\n\
         emergency stop  {}\n\
         last tick       {}\n\
         stored settings {}\n",
        sensors.supply_code,
        measured.supply_v,
        sensors.temperature_code,
        measured.temperature_c,
        choose(sensors.emergency_stop, "pressed", "released"),
        choose(sensors.late, "late", "in time"),
        choose(sensors.settings_corrupt, "not whole", "whole"),
    )
}

/// In SI, by the calibration of the settings and the zeros that the leg uses.
fn measured(reading: &SensorReading, settings: &Settings) -> Measured<f64> {
    let mut measurement = Measurement::<f64>::new(settings);
    measurement.set_current_zeros(&reading.current_zeros);
    measurement.convert(&reading.codes)
}

/// The code of no current that is in use for an axis, from 0.
fn zero_code(reading: &SensorReading, settings: &Settings, axis: usize) -> f32 {
    reading.current_zeros[axis].code(settings.current_outputs.each()[axis].zero_code())
}

const fn zero_word(zero: CurrentZero) -> &'static str {
    match zero {
        CurrentZero::NotFound => "not_found",
        CurrentZero::Found(_) => "found",
        CurrentZero::Refused(_) => "refused",
    }
}

/// What is wrong with the zero of a motor's current, as a line; nothing where it was found.
fn zero_finding(axis: usize, zero: CurrentZero, used_code: f32) -> String {
    let used = format!("{used_code:.0} is taken for no current");
    match zero {
        CurrentZero::Found(_) => String::new(),
        CurrentZero::NotFound => {
            format!("current {axis}: no zero was found at the start: {used}\n")
        }
        CurrentZero::Refused(code) => format!(
            "current {axis}: zero refused: the output read {code:.0} while the drivers were off at the start: {used}\n"
        ),
    }
}

const fn choose(is: bool, yes: &'static str, no: &'static str) -> &'static str {
    if is { yes } else { no }
}

#[cfg(test)]
mod tests {
    use super::zero_finding;
    use leg_firmware::sensors::CurrentZero;

    /// A zero that was refused, or not found, is told with what it read and what is taken for none.
    #[test]
    fn a_zero_that_is_not_used_is_told() {
        assert_eq!(zero_finding(1, CurrentZero::Found(32_000.0), 32_000.0), "");
        for (zero, words) in [
            (CurrentZero::NotFound, "current 1: no zero was found"),
            (
                CurrentZero::Refused(40_000.0),
                "current 1: zero refused: the output read 40000",
            ),
        ] {
            let line = zero_finding(1, zero, 32_768.0);
            assert!(line.starts_with(words), "{line}");
            assert!(line.ends_with("32768 is taken for no current\n"), "{line}");
        }
    }
}
