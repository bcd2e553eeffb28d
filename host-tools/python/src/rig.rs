//! The class `Rig`: a rig file, read and checked, and what the model says of it.

use crate::arguments::{self, Numbers};
use crate::errors::{model_error, rig_error};
use crate::evaluation::{
    self, Argument, NoResult, Poses, Put, Varying, put_demand, put_demand_towards,
};
use crate::map_quantities::MAP_QUANTITIES;
use crate::outputs::{self, FEASIBLE, NONLINEAR, OUTPUTS, Output};
use leg_base::failure::Failure;
use leg_model::{Elasticity, Query};
use leg_model_tools::jsonl::PoseLine;
use leg_model_tools::workspace_map::{Grid, WorkspaceMap};
use leg_rig::rig_convert::{self, RigFormat};
use leg_rig::rig_file::{RigFile, RigText};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};

/// Most poses of one call: their outputs have to fit into memory.
const POSES_MAX: usize = 100_000_000;

/// Most poses of a map along each side.
const GRID_MAX: u32 = 10_000;

/// See `_native.pyi`.
#[pyclass(frozen, module = "tendon_leg")]
pub struct Rig {
    text: RigText,
    notes: Vec<String>,
    /// As it is read.
    pub file: RigFile,
}

impl Rig {
    fn read(text: RigText) -> Result<Self, Failure> {
        let (file, notes) = text.read()?;
        Ok(Self { text, notes, file })
    }

    /// The rig of a name or a file; the paper's rig when neither is given.
    pub fn load(path: Option<&std::path::Path>) -> PyResult<Self> {
        let loaded = RigText::load(path).and_then(Self::read);
        loaded.map_err(|failure| rig_error(&failure))
    }

    /// The rig that a text describes, by a name.
    pub fn read_text(name: &str, text: String) -> PyResult<Self> {
        let name = name.to_owned();
        Self::read(RigText { name, text }).map_err(|failure| rig_error(&failure))
    }

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
    #[new]
    #[pyo3(signature = (rig = None))]
    fn new(rig: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        Self::load(
            rig.map(|rig| arguments::path_of("rig", rig))
                .transpose()?
                .as_deref(),
        )
    }

    #[staticmethod]
    #[pyo3(signature = (text, name = "rig"))]
    fn parse(text: &str, name: &str) -> PyResult<Self> {
        Self::read_text(name, text.to_owned())
    }

    #[staticmethod]
    #[pyo3(signature = (values, name = "rig"))]
    fn from_dict(values: &Bound<'_, PyDict>, name: &str) -> PyResult<Self> {
        let text = arguments::to_json("values", values)?;
        let name = name.to_owned();
        let source = RigText {
            name: name.clone(),
            text,
        };
        let converted = rig_convert::convert(&source, RigFormat::Toml);
        let read = converted.and_then(|(text, _)| Self::read(RigText { name, text }));
        read.map_err(|failure| rig_error(&failure))
    }

    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let converted = rig_convert::convert(&self.text, RigFormat::Json);
        let (text, _) = converted.map_err(|failure| rig_error(&failure))?;
        arguments::loads(py, &text)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.text.name
    }

    #[getter]
    fn text(&self) -> &str {
        &self.text.text
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    #[getter]
    fn support(&self) -> &'static str {
        self.file.support_name.word()
    }

    #[getter]
    fn pretension_n(&self) -> f64 {
        self.file.pretension_n
    }

    #[getter]
    fn tilt_max_deg(&self) -> f64 {
        self.file.tilt_deg
    }

    #[getter]
    fn tension_bounds_n(&self) -> (f64, f64) {
        (self.file.f_min_n, self.file.f_max_n)
    }

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
        stiffness_n_per_m: Option<f64>,
        stiffness_at: Option<String>,
        leg_mass_kg: Option<f64>,
        l_upper_m: Option<f64>,
        support: Option<String>,
        outputs: Option<Vec<String>>,
        raises: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
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
        let (arrays, failed) = py.detach(|| {
            let room = |output: &&Output| vec![0.0; count * evaluation::width(output)];
            let mut arrays: Vec<_> = poses.outputs.iter().map(room).collect();
            let failed = poses.evaluate(&mut arrays);
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

    #[pyo3(signature = (payload_kg = 0.0, *, azimuths = 360, tilts = 31, nonlinear = false))]
    fn workspace_map<'py>(
        &self,
        py: Python<'py>,
        payload_kg: f64,
        azimuths: u32,
        tilts: u32,
        nonlinear: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let payload_kg = arguments::bounded("payload_kg", payload_kg, 0.0, 1e6)?;
        for (name, count, least) in [("azimuths", azimuths, 3), ("tilts", tilts, 2)] {
            if !(least..=GRID_MAX).contains(&count) {
                let sentence = format!("{name} = {count} is not from {least} to {GRID_MAX}");
                return Err(PyValueError::new_err(sentence));
            }
        }
        let grid = Grid { azimuths, tilts };
        let map =
            py.detach(|| WorkspaceMap::compute(&self.file, payload_kg, grid, nonlinear, || ()));
        let arrays = PyDict::new(py);
        let shape = [tilts as usize, azimuths as usize];
        let first_azimuths = map.poses().skip(1).take(shape[1]);
        let azimuths_deg = first_azimuths.map(|(azimuth_deg, ..)| azimuth_deg);
        arrays.set_item("azimuth_deg", PyArray1::from_iter(py, azimuths_deg))?;
        let rows = map.poses().filter(|(azimuth_deg, ..)| *azimuth_deg == 0.0);
        arrays.set_item(
            "tilt_deg",
            PyArray1::from_iter(py, rows.map(|(_, tilt_deg, _)| tilt_deg)),
        )?;
        for (name, value) in MAP_QUANTITIES {
            if name == "deviation_nonlinear_mm" && !nonlinear {
                continue;
            }
            // The vertical is one pose, and a row here.
            let numbers: Vec<f64> = map
                .poses()
                .flat_map(|(_, tilt_deg, cell)| {
                    let number = cell.as_ref().ok().and_then(value).unwrap_or(f64::NAN);
                    let times = if tilt_deg == 0.0 { shape[1] } else { 1 };
                    std::iter::repeat_n(number, times)
                })
                .collect();
            arrays.set_item(name, PyArray1::from_vec(py, numbers).reshape(shape)?)?;
        }
        Ok(arrays)
    }

    #[pyo3(signature = (tensions_n, *, tendon = 1))]
    fn tendon_curve<'py>(
        &self,
        py: Python<'py>,
        tensions_n: &Bound<'py, PyAny>,
        tendon: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let curve = tendon
            .checked_sub(1)
            .and_then(|index| self.file.tendons.get(index));
        let Some(curve) = curve else {
            let sentence = format!("tendon = {tendon} is none of 1, 2 and 3");
            return Err(PyValueError::new_err(sentence));
        };
        let Numbers { values, shape } = arguments::numbers("tensions_n", tensions_n)?;
        let of = |read: &dyn Fn(f64) -> Option<f64>| {
            let numbers = values.iter().map(|n| read(*n).unwrap_or(f64::NAN));
            PyArray1::from_iter(py, numbers).reshape(shape.clone())
        };
        let arrays = PyDict::new(py);
        arrays.set_item("elongation_m", of(&|n| curve.elongation(n).ok())?)?;
        arrays.set_item("stiffness_n_per_m", of(&|n| curve.stiffness(n).ok())?)?;
        Ok(arrays)
    }

    fn __repr__(&self) -> String {
        format!(
            "Rig({:?}, support {})",
            self.text.name,
            self.file.support_name.word()
        )
    }
}

fn put_azimuth(query: &mut Query<f64>, deg: f64) {
    query.azimuth_rad = deg.to_radians();
}

fn put_tilt(query: &mut Query<f64>, deg: f64) {
    query.tilt_rad = deg.to_radians();
}
