//! What the sensors of a leg read, raw and in a user's units.

use leg_base::json_object;
use leg_firmware::control::Measurement;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use serde::Serialize;

/// What all sensors read in one tick, for machines, by the calibration of the leg's settings. Codes are from 0 to
/// [`leg_firmware::sensors::CODE_MAX`].
pub fn json(sensors: &Sensors, settings: &Settings) -> impl Serialize + use<> {
    let measured = Measurement::<f64>::new(settings).convert(sensors);
    let axis = |i: usize| {
        json_object! {
            // Counter of the motor's encoder; it wraps.
            encoder_counts: sensors.encoder_counts[i],
            cell_code: sensors.cell_codes[i],
            // N, without the tare that homing takes.
            tension_n: measured.tensions_n[i],
            // Whether the load cell was converted since the last tick.
            cell_fresh: sensors.cell_fresh[i],
            // Half of the highest code is no current.
            current_code: sensors.current_codes[i],
            // A; above zero it pulls in.
            current_a: measured.currents_a[i],
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
pub fn text(sensors: &Sensors, settings: &Settings) -> String {
    let measured = Measurement::<f64>::new(settings).convert(sensors);
    let mut rows = String::from("axis  encoder   cell   tension N  current   current A  driver\n");
    for axis in 0..3 {
        rows += &format!(
            "{:4}  {:7}  {:5}  {:10.2}  {:7}  {:10.3}  {}{}\n",
            axis + 1,
            sensors.encoder_counts[axis],
            sensors.cell_codes[axis],
            without_minus_zero(measured.tensions_n[axis], 2),
            sensors.current_codes[axis],
            without_minus_zero(measured.currents_a[axis], 3),
            choose(sensors.driver_fault[axis], "fault", "ready"),
            choose(sensors.cell_fresh[axis], "", ", no fresh code of the cell"),
        );
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

const fn choose(is: bool, yes: &'static str, no: &'static str) -> &'static str {
    if is { yes } else { no }
}

/// Rounded, without the sign of a zero.
fn without_minus_zero(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    (value * scale).round() / scale + 0.0
}
