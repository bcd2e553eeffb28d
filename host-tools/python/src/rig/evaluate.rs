//! The model at one pose or at many.

use super::Rig;
use crate::arguments;
use crate::cores;
use crate::errors::model_error;
use crate::evaluation::{
    self, Argument, NoResult, Poses, Put, Varying, put_demand, put_demand_towards,
};
use crate::interpreter::Call;
use crate::named;
use crate::outputs::{self, FEASIBLE, NONLINEAR, OUTPUTS, Output};
use leg_model::Query;
use leg_model_tools::jsonl::PoseLine;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};

/// Most poses of one call: their outputs have to fit into memory.
const POSES_MAX: usize = 100_000_000;

impl Rig {
    /// The mechanism and the query with what a call changes of them for all poses, by the names of `leg eval`.
    fn changed(&self, changes: &[(&str, Option<Value>)]) -> PyResult<PoseLine> {
        let mut line = json!({"azimuth_deg": 0, "tilt_deg": 0, "payload_kg": 0});
        for (key, value) in changes {
            if let Some(value) = value {
                line[*key] = value.clone();
            }
        }
        let parsed = PoseLine::parse(line.to_string().as_bytes(), &self.file);
        parsed.map_err(|error| PyValueError::new_err(error.to_string()))
    }
}

/// A number for all poses.
fn one(name: &str, value: Option<f64>) -> PyResult<Option<Value>> {
    let checked = value.map(|value| arguments::finite(name, value));
    Ok(checked.transpose()?.map(|value| json!(value)))
}

/// The outputs of some names; all but the slow one where none are named.
fn outputs_of(names: Option<Vec<String>>) -> PyResult<Vec<&'static Output>> {
    let Some(names) = names else {
        let quick = OUTPUTS.iter().filter(|output| output.name != NONLINEAR);
        return Ok(quick.collect());
    };
    let found = names.iter().map(|name| {
        outputs::named(name).ok_or_else(|| {
            let sentence = format!("outputs holds {name:?}, which is none; OUTPUTS lists them");
            PyValueError::new_err(sentence)
        })
    });
    found.collect()
}

/// An array of a shape for the poses and one for each of them; a plain number for one pose.
fn shaped<'py>(
    py: Python<'py>,
    output: &Output,
    numbers: Vec<f64>,
    poses: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let shape = [poses, output.shape].concat();
    if output.name == FEASIBLE {
        let truths = numbers.into_iter().map(|number| number == 1.0);
        if shape.is_empty() {
            let [truth] = truths.collect::<Vec<_>>()[..] else {
                return Err(PyValueError::new_err("one pose has one answer"));
            };
            return Ok(truth.into_pyobject(py)?.to_owned().into_any());
        }
        return Ok(PyArray1::from_iter(py, truths).reshape(shape)?.into_any());
    }
    match numbers[..] {
        [number] if shape.is_empty() => Ok(number.into_pyobject(py)?.into_any()),
        _ => Ok(PyArray1::from_vec(py, numbers).reshape(shape)?.into_any()),
    }
}

/// Why poses have no result: by their numbers, or the first of them raised.
fn refusals<'py>(
    py: Python<'py>,
    failed: &[NoResult],
    raises: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let errors = PyDict::new(py);
    for (pose, error) in failed {
        if raises {
            let words = evaluation::words(*error);
            return Err(model_error(*error, format!("pose {pose}: {words}")));
        }
        errors.set_item(pose, evaluation::words(*error))?;
    }
    Ok(errors)
}

#[pymethods]
impl Rig {
    /// The whole model in f64 at one pose or at many: what `leg eval` answers, to the last bit, on all cores.
    ///
    /// azimuth_deg, tilt_deg: where the leg leans; a tilt is within 60°, a negative one is the opposite azimuth.
    /// payload_kg: mass at the tip; 0 if left out. Whatever else is left out is the rig's:
    /// level_n: pretension, N per tendon at the vertical pose.
    /// f_min_n, f_max_n: lowest and highest tension allowed.
    /// demand_nm_per_rad, demand_towards_deg: a bending stiffness to find the pretension for: of the softest tilt, or against
    ///     a push at an azimuth. `commanded_level_n` is the pretension that gives it, or the nearest within the bounds, each tendon's stiffness
    ///     at its own tension.
    /// stiffness_n_per_m: a constant stiffness of every tendon. stiffness_at: "pretension" or "tension".
    /// leg_mass_kg, l_upper_m, support: as in `leg eval`.
    /// outputs: those that are wanted, of `OUTPUTS`; all but `deviation_nonlinear_m`, which is much slower, if left out. Few
    ///     are faster than many; those that a map has (`tensions_n`, `level_range_n`, `feasible`, `bending_stiffness_nm_per_rad`,
    ///     `deviation_m`) are fastest alone.
    /// raises: whether a pose without a result raises ValueError, or NoResult where no argument is to blame. Otherwise its
    ///     outputs are not a number (`feasible` false), and `errors` in the result says why, by the pose's number.
    ///
    /// Arrays go together by numpy's rules. Of an array of shape s an output has the shape s, or s and its own 2, 3 or 3 × 3
    /// (rows first). SI units, frame {A}: x and y horizontal, z upwards from the joint's centre.
    #[pyo3(signature = (azimuth_deg, tilt_deg, payload_kg = None, *, level_n = None, f_min_n = None, f_max_n = None, demand_nm_per_rad = None, demand_towards_deg = None, stiffness_n_per_m = None, stiffness_at = None, leg_mass_kg = None, l_upper_m = None, support = None, outputs = None, raises = true))]
    #[allow(clippy::too_many_arguments, reason = "they have names in Python")]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        azimuth_deg: &Bound<'py, PyAny>,
        tilt_deg: &Bound<'py, PyAny>,
        payload_kg: Option<&Bound<'py, PyAny>>,
        level_n: Option<&Bound<'py, PyAny>>,
        f_min_n: Option<&Bound<'py, PyAny>>,
        f_max_n: Option<&Bound<'py, PyAny>>,
        demand_nm_per_rad: Option<&Bound<'py, PyAny>>,
        demand_towards_deg: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = named::stiffness_n_per_m)] stiffness_n_per_m: Option<f64>,
        #[pyo3(from_py_with = named::stiffness_at)] stiffness_at: Option<String>,
        #[pyo3(from_py_with = named::leg_mass_kg)] leg_mass_kg: Option<f64>,
        #[pyo3(from_py_with = named::l_upper_m)] l_upper_m: Option<f64>,
        #[pyo3(from_py_with = named::support)] support: Option<String>,
        #[pyo3(from_py_with = named::outputs)] outputs: Option<Vec<String>>,
        #[pyo3(from_py_with = named::raises)] raises: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let call = Call::begin(py)?;
        let PoseLine { rig, query } = self.changed(&[
            (
                "stiffness_n_per_m",
                one("stiffness_n_per_m", stiffness_n_per_m)?,
            ),
            ("stiffness_at", stiffness_at.map(Value::from)),
            ("leg_mass_kg", one("leg_mass_kg", leg_mass_kg)?),
            ("l_upper_m", one("l_upper_m", l_upper_m)?),
            ("support", support.map(Value::from)),
        ])?;
        if demand_nm_per_rad.is_none() && demand_towards_deg.is_some() {
            return Err(PyValueError::new_err(
                "demand_towards_deg is given without demand_nm_per_rad",
            ));
        }
        // The demanded stiffness stands before its azimuth.
        let arguments = [
            ("azimuth_deg", Some(azimuth_deg), put_azimuth as Put),
            ("tilt_deg", Some(tilt_deg), put_tilt),
            ("payload_kg", payload_kg, |query, kg| query.payload_kg = kg),
            ("level_n", level_n, |query, n| query.pretension_n = n),
            ("f_min_n", f_min_n, |query, n| query.f_min_n = n),
            ("f_max_n", f_max_n, |query, n| query.f_max_n = n),
            ("demand_nm_per_rad", demand_nm_per_rad, put_demand),
            ("demand_towards_deg", demand_towards_deg, put_demand_towards),
        ];
        let mut given = Vec::with_capacity(arguments.len());
        for (name, argument, put) in arguments {
            if let Some(argument) = argument {
                given.push((name, arguments::numbers(name, argument)?, put));
            }
        }
        let shapes: Vec<_> = given
            .iter()
            .map(|(name, numbers, _)| (*name, numbers))
            .collect();
        let shape = arguments::common_shape(&shapes)?;
        let count: usize = shape.iter().product();
        if count > POSES_MAX {
            let sentence =
                format!("azimuth_deg and tilt_deg make {count} poses, more than {POSES_MAX}");
            return Err(PyValueError::new_err(sentence));
        }
        let mut varying = Vec::with_capacity(given.len());
        for (_, numbers, put) in given {
            let argument = match numbers.values[..] {
                [value] => Argument::One(value),
                _ => Argument::Each(arguments::broadcast(py, numbers, &shape)?),
            };
            varying.push(Varying { argument, put });
        }
        let poses = Poses {
            parameters: rig,
            query,
            varying,
            outputs: outputs_of(outputs)?,
            count,
        };
        let cores = cores::threads(py)?;
        let (arrays, failed) = call.detached(|| {
            let room = |output: &&Output| vec![0.0; count * evaluation::width(output)];
            let mut arrays: Vec<_> = poses.outputs.iter().map(room).collect();
            let failed = cores.install(|| poses.evaluate(&mut arrays));
            (arrays, failed)
        });
        let failed = failed.map_err(|error| model_error(error, evaluation::words(error)))?;
        let errors = refusals(py, &failed, raises)?;
        let results = PyDict::new(py);
        for (output, numbers) in poses.outputs.iter().zip(arrays) {
            results.set_item(output.name, shaped(py, output, numbers, &shape)?)?;
        }
        if !raises {
            results.set_item("errors", errors)?;
        }
        Ok(results)
    }
}

fn put_azimuth(query: &mut Query<f64>, deg: f64) {
    query.azimuth_rad = deg.to_radians();
}

fn put_tilt(query: &mut Query<f64>, deg: f64) {
    query.tilt_rad = deg.to_radians();
}
