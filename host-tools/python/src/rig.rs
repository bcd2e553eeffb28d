//! The class `Rig`: a rig file, read and checked, and what the model says of it.

mod evaluate;

use crate::arguments::{self, Numbers};
use crate::cores;
use crate::errors::rig_error;
use crate::interpreter::Call;
use crate::map_quantities::MAP_QUANTITIES;
use crate::named;
use leg_base::failure::Failure;
use leg_model::Elasticity;
use leg_model_tools::workspace_map::{Grid, WorkspaceMap};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_convert::{self, RigFormat};
use leg_rig::rig_file::{RigFile, RigText};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// Most poses of a map along each side.
const GRID_MAX: u32 = 10_000;

/// A rig file, read and checked: a leg with its tendons, support, motors, sensors, gains and limits.
///
/// To edit one, change what `to_dict` gives and read it again: `Rig.from_dict`.
///
/// rig: a rig file or the name of a ready rig (`READY_RIGS`); the paper's rig if left out.
///
/// Raises RigError with file, line, column and remedy where the file is refused.
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
    pub fn load(path: Option<&Path>) -> PyResult<Self> {
        let path = path.unwrap_or(Path::new(READY_RIGS[0].name));
        let loaded = RigText::load(Some(path)).and_then(|text| {
            Self::read(RigText {
                name: path.display().to_string(),
                ..text
            })
        });
        loaded.map_err(|failure| rig_error(&failure))
    }

    /// The rig that a text describes, by a name.
    pub fn read_text(name: String, text: String) -> PyResult<Self> {
        Self::read(RigText { name, text }).map_err(|failure| rig_error(&failure))
    }
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

    /// The rig of a TOML text; `name` stands in messages.
    #[staticmethod]
    #[pyo3(signature = (text, name = "rig".into()), text_signature = "(text, name=\"rig\")")]
    fn parse(
        #[pyo3(from_py_with = named::text)] text: String,
        #[pyo3(from_py_with = named::name)] name: String,
    ) -> PyResult<Self> {
        Self::read_text(name, text)
    }

    /// The rig of a dictionary with the keys of a rig file. The lines of a RigError are those of the TOML made of it.
    #[staticmethod]
    #[pyo3(signature = (values, name = "rig".into()), text_signature = "(values, name=\"rig\")")]
    fn from_dict(
        #[pyo3(from_py_with = named::values)] values: Bound<'_, PyDict>,
        #[pyo3(from_py_with = named::name)] name: String,
    ) -> PyResult<Self> {
        let text = arguments::to_json("values", &values)?;
        let source = RigText {
            name: name.clone(),
            text,
        };
        let converted = rig_convert::convert(&source, RigFormat::Toml);
        let read = converted.and_then(|(text, _)| Self::read(RigText { name, text }));
        read.map_err(|failure| rig_error(&failure))
    }

    /// The keys of its file. What the file leaves out is left out.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let converted = rig_convert::convert(&self.text, RigFormat::Json);
        let (text, _) = converted.map_err(|failure| rig_error(&failure))?;
        arguments::loads(py, &text)
    }

    /// Its name in messages; of a ready rig that by which `READY_RIGS` has it.
    #[getter]
    fn name(&self) -> &str {
        &self.text.name
    }

    /// Its TOML text.
    #[getter]
    fn text(&self) -> &str {
        &self.text.text
    }

    /// What the file should say otherwise, though it is understood.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Its central support.
    #[getter]
    fn support(&self) -> &'static str {
        self.file.support_name.word()
    }

    /// Its pretension, N per tendon at the vertical pose.
    #[getter]
    fn pretension_n(&self) -> f64 {
        self.file.pretension_n
    }

    /// How far the leg leans at most, degrees.
    #[getter]
    fn tilt_max_deg(&self) -> f64 {
        self.file.tilt_deg
    }

    /// Lowest and highest tension allowed, N.
    #[getter]
    fn tension_bounds_n(&self) -> (f64, f64) {
        (self.file.f_min_n, self.file.f_max_n)
    }

    /// The quantities of `leg map` over the workspace: `azimuth_deg`, `tilt_deg`, and arrays with a row for each tilt.
    ///
    /// What is not known at a pose is not a number; `feasible` and `pretension_keeps_bounds` are 0 or 1. `nonlinear` adds
    /// `deviation_nonlinear_mm`, which takes far longer than all the rest.
    #[pyo3(signature = (payload_kg = 0.0, *, azimuths = 360, tilts = 31, nonlinear = false))]
    fn workspace_map<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::payload_kg)] payload_kg: f64,
        #[pyo3(from_py_with = named::azimuths)] azimuths: i128,
        #[pyo3(from_py_with = named::tilts)] tilts: i128,
        #[pyo3(from_py_with = named::nonlinear)] nonlinear: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let payload_kg = arguments::bounded("payload_kg", payload_kg, 0.0, 1e6)?;
        let azimuths = arguments::whole("azimuths", azimuths, 3..=GRID_MAX)?;
        let tilts = arguments::whole("tilts", tilts, 2..=GRID_MAX)?;
        let grid = Grid { azimuths, tilts };
        let call = Call::begin(py)?;
        let cores = cores::threads(py)?;
        let compute = || WorkspaceMap::compute(&self.file, payload_kg, grid, nonlinear, || ());
        let map = call.detached(|| cores.install(compute));
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

    /// `elongation_m` and `stiffness_n_per_m` of a tendon under tensions, N; not a number beyond what its curve knows.
    #[pyo3(signature = (tensions_n, *, tendon = 1))]
    fn tendon_curve<'py>(
        &self,
        py: Python<'py>,
        tensions_n: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::tendon)] tendon: i128,
    ) -> PyResult<Bound<'py, PyDict>> {
        let curve = &self.file.tendons[arguments::place("tendon", tendon)?];
        let Numbers { values, shape } = arguments::not_negative("tensions_n", tensions_n)?;
        let of = |read: &dyn Fn(f64) -> Option<f64>| {
            let numbers = values.iter().map(|n| read(*n).unwrap_or(f64::NAN));
            PyArray1::from_iter(py, numbers).reshape(shape.clone())
        };
        let arrays = PyDict::new(py);
        arrays.set_item("elongation_m", of(&|n| curve.elongation(n).ok())?)?;
        arrays.set_item("stiffness_n_per_m", of(&|n| curve.stiffness(n).ok())?)?;
        Ok(arrays)
    }

    /// Whether both describe the same leg, in whatever words.
    fn __eq__(&self, other: &Self) -> bool {
        self.file == other.file
    }

    fn __hash__(&self) -> u64 {
        // Equal numbers have equal words, but for the sign of zero.
        let words = format!("{:?}", self.file).replace("-0.0", "0.0");
        let mut hasher = DefaultHasher::new();
        words.hash(&mut hasher);
        hasher.finish()
    }

    /// Its text and its name, read again where it comes to.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let Self { text, .. } = slf.get();
        let words = ("parse", text.text.as_str(), text.name.as_str());
        let read = py.import("operator")?.call_method1("methodcaller", words)?;
        let class = (slf.get_type(),).into_pyobject(py)?;
        (read, class).into_pyobject(py)
    }

    fn __repr__(&self) -> String {
        format!(
            "Rig({:?}, support {})",
            self.text.name,
            self.file.support_name.word()
        )
    }
}
