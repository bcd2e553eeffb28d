//! What the sensors of a leg read, raw and in a user's units.

use leg_firmware::control::Measurement;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::Settings;
use serde::Serialize;

/// What all sensors read in one tick.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SensorReport {
    /// The three axes.
    pub axes: [AxisReport; 3],
    /// Supply voltage, 0 to [`leg_firmware::sensors::CODE_MAX`].
    pub supply_code: u16,
    /// Supply voltage, V.
    pub supply_v: f64,
    /// Temperature of the drivers, 0 to [`leg_firmware::sensors::CODE_MAX`].
    pub temperature_code: u16,
    /// Temperature of the drivers, °C.
    pub temperature_c: f64,
    /// Whether the emergency stop is pressed.
    pub emergency_stop: bool,
    /// Whether the last tick ended too late.
    pub late: bool,
    /// Whether the stored settings were not whole at the start, so that others are used.
    pub settings_corrupt: bool,
}

/// What the sensors of one axis read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AxisReport {
    /// Counter of the motor's encoder; it wraps.
    pub encoder_counts: u16,
    /// Load cell, 0 to [`leg_firmware::sensors::CODE_MAX`].
    pub cell_code: u16,
    /// Tension by the calibration of the settings, N: without the tare that homing takes.
    pub tension_n: f64,
    /// Whether the load cell was converted since the last tick.
    pub cell_fresh: bool,
    /// Motor current, 0 to [`leg_firmware::sensors::CODE_MAX`]; half of it is none.
    pub current_code: u16,
    /// Motor current, A; above zero it pulls in.
    pub current_a: f64,
    /// Whether the motor's driver raises its fault line.
    pub driver_fault: bool,
}

impl SensorReport {
    /// Converts codes by the calibration of the leg's settings.
    #[must_use]
    pub fn new(sensors: &Sensors, settings: &Settings) -> Self {
        let measured = Measurement::<f64>::new(settings).convert(sensors);
        let axis = |i: usize| AxisReport {
            encoder_counts: sensors.encoder_counts[i],
            cell_code: sensors.cell_codes[i],
            tension_n: measured.tensions_n[i],
            cell_fresh: sensors.cell_fresh[i],
            current_code: sensors.current_codes[i],
            current_a: measured.currents_a[i],
            driver_fault: sensors.driver_fault[i],
        };
        Self {
            axes: [0, 1, 2].map(axis),
            supply_code: sensors.supply_code,
            supply_v: measured.supply_v,
            temperature_code: sensors.temperature_code,
            temperature_c: measured.temperature_c,
            emergency_stop: sensors.emergency_stop,
            late: sensors.late,
            settings_corrupt: sensors.settings_corrupt,
        }
    }

    /// The rows of a table for people.
    #[must_use]
    pub fn rows(&self) -> String {
        let mut rows =
            String::from("axis  encoder   cell   tension N  current   current A  driver\n");
        for (axis, number) in self.axes.iter().zip(1..) {
            rows += &format!(
                "{number:4}  {:7}  {:5}  {:10.2}  {:7}  {:10.3}  {}{}\n",
                axis.encoder_counts,
                axis.cell_code,
                without_minus_zero(axis.tension_n, 2),
                axis.current_code,
                without_minus_zero(axis.current_a, 3),
                either(axis.driver_fault, "fault", "ready"),
                either(axis.cell_fresh, "", ", no fresh code of the cell"),
            );
        }
        rows + &format!(
            "\nsupply          {:5}  {:7.2} V\n\
             temperature     {:5}  {:7.1} °C\n\
             emergency stop  {}\n\
             last tick       {}\n\
             stored settings {}\n",
            self.supply_code,
            self.supply_v,
            self.temperature_code,
            self.temperature_c,
            either(self.emergency_stop, "pressed", "released"),
            either(self.late, "late", "in time"),
            either(self.settings_corrupt, "not whole", "whole"),
        )
    }
}

const fn either(is: bool, yes: &'static str, no: &'static str) -> &'static str {
    if is { yes } else { no }
}

/// Rounded, without the sign of a zero.
fn without_minus_zero(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    (value * scale).round() / scale + 0.0
}
