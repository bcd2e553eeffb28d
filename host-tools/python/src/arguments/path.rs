//! Paths as arrays of numbers.

use super::LONGEST_S;
use super::array::{Numbers, numbers};
use leg_base::timed_path::{PathRow, TimedPath};
use leg_firmware::set_point::StreamTension;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Most points of a path: three hours at 100 Hz.
const POINTS_MAX: usize = 1_000_000;

/// What is read as a pretension, N, and as a stiffness, N·m/rad: the leg says what it can reach.
const PRETENSION_N: [f64; 2] = [0.0, 1e5];
const STIFFNESS_NM_PER_RAD: [f64; 2] = [1e-3, 1e6];

/// What a path asks of the tendons: a number for all of its rows, or one for each.
#[derive(Clone, Copy)]
pub struct TensionArguments<'a, 'py> {
    pub pretension_n: Option<&'a Bound<'py, PyAny>>,
    pub stiffness_nm_per_rad: Option<&'a Bound<'py, PyAny>>,
}

/// What each row asks of the tendons.
struct RowTensions {
    values: Vec<f64>,
    make_tension: fn(f32) -> StreamTension,
}

impl RowTensions {
    /// For so many rows.
    fn read(arguments: TensionArguments<'_, '_>, rows: usize) -> PyResult<Option<Self>> {
        let (name, argument, range, make_tension): (_, _, _, fn(f32) -> _) =
            match (arguments.pretension_n, arguments.stiffness_nm_per_rad) {
                (Some(_), Some(_)) => {
                    return Err(PyValueError::new_err(
                        "pretension_n and stiffness_nm_per_rad are given; give one of them",
                    ));
                }
                (Some(argument), None) => (
                    "pretension_n",
                    argument,
                    PRETENSION_N,
                    StreamTension::Pretension,
                ),
                (None, Some(argument)) => (
                    "stiffness_nm_per_rad",
                    argument,
                    STIFFNESS_NM_PER_RAD,
                    StreamTension::Stiffness,
                ),
                (None, None) => return Ok(None),
            };
        let Numbers { values, shape } = numbers(name, argument)?;
        let refuse = |what: String| Err(PyValueError::new_err(format!("{name} {what}")));
        let values = match shape[..] {
            [] => vec![values[0]; rows],
            [count] if count == rows => values,
            _ => {
                return refuse(format!(
                    "has the shape {shape:?}: give one number, or one for each of the {rows} rows"
                ));
            }
        };
        let [least, most] = range;
        if let Some(index) = values
            .iter()
            .position(|value| !(least..=most).contains(value))
        {
            return refuse(format!(
                "holds {} at index {index}, which is not from {least} to {most}",
                values[index]
            ));
        }
        Ok(Some(Self {
            values,
            make_tension,
        }))
    }

    fn row_tension(&self, row: usize) -> StreamTension {
        (self.make_tension)(self.values[row] as f32)
    }
}

/// A path: rows of time in s, azimuth and tilt in degrees.
pub fn path(
    name: &str,
    argument: &Bound<'_, PyAny>,
    tensions: TensionArguments<'_, '_>,
) -> PyResult<TimedPath> {
    let Numbers { values, shape } = numbers(name, argument)?;
    let refuse = |what: String| Err(PyValueError::new_err(format!("{name} {what}")));
    if !matches!(shape[..], [2..=POINTS_MAX, 3]) {
        return refuse(format!(
            "has the shape {shape:?}, not (n, 3) with 2 to {POINTS_MAX} rows of time_s, azimuth_deg, tilt_deg"
        ));
    }
    let tensions = RowTensions::read(tensions, shape[0])?;
    let mut rows = Vec::with_capacity(shape[0]);
    let mut last_s = f64::NEG_INFINITY;
    for (index, row) in values.chunks_exact(3).enumerate() {
        let [time_s, azimuth_deg, tilt_deg] = [row[0], row[1], row[2]];
        if time_s <= last_s || time_s - values[0] > LONGEST_S {
            return refuse(format!(
                "has the time {time_s} s at index {index}, which is not after {last_s} s and within a day"
            ));
        }
        if azimuth_deg.abs() > 1e6 || tilt_deg.abs() > 90.0 {
            return refuse(format!(
                "leads to azimuth {azimuth_deg}°, tilt {tilt_deg}° at index {index}; a tilt is from -90 to 90"
            ));
        }
        last_s = time_s;
        rows.push(PathRow {
            tension: tensions
                .as_ref()
                .map(|tensions| tensions.row_tension(index)),
            ..PathRow::from_angles(time_s, azimuth_deg, tilt_deg)
        });
    }
    Ok(TimedPath::new(&rows))
}
