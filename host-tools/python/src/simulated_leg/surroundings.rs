//! What is done to the leg from outside.

use super::SimulatedLeg;
use crate::{arguments, named};
use leg_sim::action::Action;
use pyo3::prelude::*;

#[pymethods]
impl SimulatedLeg {
    /// Changes the mass at the tip, at once or over a time, kg, s.
    #[pyo3(signature = (kg, over_s = 0.0))]
    fn payload(
        &self,
        #[pyo3(from_py_with = named::kg)] kg: f64,
        #[pyo3(from_py_with = named::over_s)] over_s: f64,
    ) -> PyResult<()> {
        self.act(&arguments::action(
            "payload",
            &[("kg", kg), ("over_s", over_s)],
        )?)
    }

    /// Pushes at the tip, across the leg, for a time: degrees, N, s. The force rises within 20 ms.
    fn push(
        &self,
        #[pyo3(from_py_with = named::azimuth_deg)] azimuth_deg: f64,
        #[pyo3(from_py_with = named::force_n)] force_n: f64,
        #[pyo3(from_py_with = named::for_s)] for_s: f64,
    ) -> PyResult<()> {
        let numbers = [
            ("azimuth_deg", azimuth_deg),
            ("force_n", force_n),
            ("for_s", for_s),
        ];
        self.act(&arguments::action("push", &numbers)?)
    }

    /// Lets a defect begin: a name of `DEFECTS`, and which tendon (1 to 3) has it unless the whole leg does.
    #[pyo3(signature = (fault, tendon = None))]
    fn fault(
        &self,
        #[pyo3(from_py_with = named::fault)] fault: String,
        #[pyo3(from_py_with = named::tendon)] tendon: Option<i128>,
    ) -> PyResult<()> {
        self.act(&arguments::defect_action("fault", &fault, tendon)?)
    }

    /// Ends a defect.
    #[pyo3(signature = (fault, tendon = None))]
    fn repair(
        &self,
        #[pyo3(from_py_with = named::fault)] fault: String,
        #[pyo3(from_py_with = named::tendon)] tendon: Option<i128>,
    ) -> PyResult<()> {
        self.act(&arguments::defect_action("repair", &fault, tendon)?)
    }

    /// Presses or releases the emergency stop.
    fn emergency_stop(&self, #[pyo3(from_py_with = named::pressed)] pressed: bool) -> PyResult<()> {
        self.act(&Action::EmergencyStop(pressed))
    }

    /// Lets the host send no more signs of life, or again.
    ///
    /// Without them a leg that homes or follows commands is held by itself, one that jogs is switched off; one that keeps
    /// station goes on and moves by itself.
    fn silence(&self, #[pyo3(from_py_with = named::silent)] silent: bool) -> PyResult<()> {
        self.session()?.leg_mut().host_mut().silent = silent;
        Ok(())
    }
}
