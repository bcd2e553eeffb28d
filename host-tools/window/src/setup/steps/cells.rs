//! A load cell by known weights: each is hung on it, read, and in the end a line is drawn through them.

use crate::shown_leg::ShownLeg;
use leg_firmware::settings::Settings;
use leg_rig::cell_fit::{CellFit, KnownWeight, fit};
use leg_rig::number::exact;

/// Readings that are averaged for a weight.
const READINGS: u32 = 100;

/// The heaviest weight, kg, and the most of them.
const KG_MAX: f64 = 1000.0;
const WEIGHTS_MAX: usize = 16;

/// How far it has come.
#[derive(Clone, Debug, PartialEq)]
pub enum CellStep {
    /// Cell and weights are chosen.
    Choose,
    /// The next weight is to be hung.
    Hang,
    /// It is read: sum of the codes, and how many.
    Read(f64, u32),
    /// The line, or why there is none.
    Done(Result<CellFit, String>),
}

/// The calibration of one cell.
#[derive(Clone, Debug)]
pub struct Cells {
    /// From 0.
    pub cell: usize,
    /// The weights as they are typed, kg.
    pub typed: String,
    weights_kg: Vec<f64>,
    gravity_m_per_s2: f64,
    weighings: Vec<KnownWeight>,
    step: CellStep,
}

impl Default for Cells {
    fn default() -> Self {
        Self {
            cell: 0,
            typed: "0,2,5,10".into(),
            weights_kg: Vec::new(),
            gravity_m_per_s2: 0.0,
            weighings: Vec::new(),
            step: CellStep::Choose,
        }
    }
}

/// The weights that were typed.
///
/// # Errors
/// What is wrong with them, and what to do.
pub fn weights(typed: &str) -> Result<Vec<f64>, String> {
    let parse = |text: &str| -> Result<f64, String> {
        let kg: f64 = text
            .trim()
            .parse()
            .map_err(|_| format!("`{text}` is no weight: write kilograms as 0,2,5"))?;
        if (0.0..=KG_MAX).contains(&kg) {
            Ok(kg)
        } else {
            Err(format!("{text} kg is no weight: give 0 to {KG_MAX}"))
        }
    };
    let found: Vec<f64> = typed.split(',').map(parse).collect::<Result<_, _>>()?;
    if found.len() > WEIGHTS_MAX {
        return Err(format!("give {WEIGHTS_MAX} weights at most"));
    }
    if found.iter().all(|kg| Some(kg) == found.first()) {
        return Err("two different weights are needed at least: 0 is the empty hook".into());
    }
    Ok(found)
}

impl Cells {
    /// How far it has come.
    #[must_use]
    pub const fn step(&self) -> &CellStep {
        &self.step
    }

    /// Begins with the first weight, under a gravity, m/s².
    ///
    /// # Errors
    /// Weights that are none.
    pub fn start(&mut self, gravity_m_per_s2: f64) -> Result<(), String> {
        self.weights_kg = weights(&self.typed)?;
        self.gravity_m_per_s2 = gravity_m_per_s2;
        self.weighings.clear();
        self.step = CellStep::Hang;
        Ok(())
    }

    /// Ends it without a result.
    pub fn cancel(&mut self, leg: &mut ShownLeg) {
        self.step = CellStep::Choose;
        self.put_back(leg);
    }

    /// The weight that is to be hung, or is read, kg.
    #[must_use]
    pub fn weight_kg(&self) -> Option<f64> {
        self.weights_kg.get(self.weighings.len()).copied()
    }

    /// Which one that is, and of how many.
    #[must_use]
    pub fn place(&self) -> [usize; 2] {
        [self.weighings.len() + 1, self.weights_kg.len()]
    }

    /// The part of its readings that have come.
    #[must_use]
    pub fn progress(&self) -> f32 {
        match self.step {
            CellStep::Read(_, count) => count as f32 / READINGS as f32,
            _ => 0.0,
        }
    }

    /// The weights with their codes.
    #[must_use]
    pub fn weighings(&self) -> &[KnownWeight] {
        &self.weighings
    }

    /// The weight hangs still: reads it. On a simulated leg it is hung by that.
    pub fn read(&mut self, leg: &mut ShownLeg) {
        let Some(kg) = self.weight_kg() else { return };
        let newtons = kg * self.gravity_m_per_s2;
        if let Some(simulation) = leg.simulated_mut() {
            simulation.hang_on_cell(self.cell, Some(newtons));
        }
        // What was asked before is of another weight.
        leg.take_sensors();
        self.step = CellStep::Read(0.0, 0);
    }

    /// Takes the codes that have come, and asks for more.
    pub(super) fn advance(&mut self, leg: &mut ShownLeg) {
        let CellStep::Read(sum, count) = self.step else {
            return;
        };
        if leg.failure().is_some() || leg.locked().is_some() {
            self.step = CellStep::Hang;
            return;
        }
        if let Some(sensors) = leg.take_sensors() {
            let code = sensors.cell_codes.get(self.cell).copied();
            self.step = CellStep::Read(sum + code.map_or(0.0, f64::from), count + 1);
            if count + 1 == READINGS {
                self.take_mean();
            }
        }
        if matches!(self.step, CellStep::Read(..)) {
            leg.ask_sensors();
        } else if matches!(self.step, CellStep::Done(_)) {
            self.put_back(leg);
        }
    }

    fn take_mean(&mut self) {
        let (CellStep::Read(sum, count), Some(kg)) = (&self.step, self.weight_kg()) else {
            return;
        };
        self.weighings.push(KnownWeight {
            newtons: kg * self.gravity_m_per_s2,
            code: sum / f64::from(*count),
        });
        self.step = if self.weight_kg().is_some() {
            CellStep::Hang
        } else {
            CellStep::Done(self.result())
        };
    }

    fn result(&self) -> Result<CellFit, String> {
        let words = |failure: leg_base::failure::Failure| failure.render(false);
        let found = fit(&self.weighings).map_err(words)?;
        let number = u8::try_from(self.cell + 1).unwrap_or_default();
        found
            .require_straight(number, &self.weighings)
            .map_err(words)?;
        Ok(found)
    }

    fn put_back(&self, leg: &mut ShownLeg) {
        if let Some(simulation) = leg.simulated_mut() {
            simulation.hang_on_cell(self.cell, None);
        }
    }

    /// The result as values of `[calibration]`: keys, and all three cells as they are set with this one changed.
    #[must_use]
    pub fn values(&self, found: &CellFit, settings: &Settings) -> [(&'static str, String); 2] {
        let mut axes = settings.axes;
        if let Some(axis) = axes.get_mut(self.cell) {
            axis.cell_n_per_code = found.n_per_code as f32;
            axis.cell_zero_code = found.zero_code as f32;
        }
        let list = |values: [f32; 3]| format!("[{}]", values.map(exact).join(", "));
        [
            (
                "cell_n_per_code",
                list(axes.map(|axis| axis.cell_n_per_code)),
            ),
            ("cell_zero_code", list(axes.map(|axis| axis.cell_zero_code))),
        ]
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{CellStep, Cells, weights};
    use crate::setup::editor::Editor;
    use crate::shown_leg::ShownLeg;
    use crate::simulation::Simulation;

    #[test]
    fn weights_are_read_or_refused_with_what_to_do() {
        assert_eq!(weights("0, 1.5,2").unwrap(), [0.0, 1.5, 2.0]);
        for typed in ["", "2", "2,2", "0,x", "0,-1", "0,inf", "0,1e9"] {
            let words = weights(typed).unwrap_err();
            assert!(
                words.contains("give") || words.contains("write") || words.contains("needed"),
                "{words}"
            );
        }
        let many = vec!["1"; 17].join(",") + ",2";
        assert!(weights(&many).is_err());
    }

    #[test]
    fn a_cell_is_rehearsed_on_the_simulated_leg_and_its_result_fits_the_settings() {
        let mut leg = ShownLeg::Simulated(Box::new(Simulation::new().unwrap()));
        let mut cells = Cells {
            cell: 1,
            ..Cells::default()
        };
        cells.start(9.81).unwrap();
        for place in 1..=4 {
            assert_eq!(cells.place(), [place, 4]);
            cells.read(&mut leg);
            for _ in 0..500 {
                leg.advance(0.02, 0.0);
                cells.advance(&mut leg);
            }
        }
        let CellStep::Done(Ok(found)) = cells.step() else {
            panic!("{:?}", cells.step());
        };
        let mut editor = Editor::new(leg.source()).unwrap();
        let settings = editor.settings();
        // The simulated cell is as its data sheet says.
        let configured = f64::from(settings.axes[1].cell_n_per_code);
        assert!(
            (found.n_per_code / configured - 1.0).abs() < 1e-3,
            "{found:?}"
        );
        for (key, value) in cells.values(found, &settings) {
            assert!(editor.set("calibration", key, &value), "{value}");
        }
        let axes = editor.settings().axes;
        assert_eq!(axes[1].cell_n_per_code, found.n_per_code as f32);
        assert_eq!(axes[0].cell_n_per_code, settings.axes[0].cell_n_per_code);
    }
}
