//! What the board reads: codes with the sensors' errors.

use super::cell_defects::CellDefects;
use super::defect::{Defect, Defects};
use super::motor::Motor;
use super::noise::gaussian;
use fastrand::Rng;
use leg_firmware::sensors::CODE_MAX;
use leg_firmware::settings::CurrentOutput;
use leg_rig::actuator::Actuator;
use leg_rig::plant_settings::PlantSettings;

/// How fast a drifting cell's offset grows, N/s.
const DRIFT_N_PER_S: f64 = 5.0;

/// The code of a value between those of code 0 and of the highest code.
pub(super) fn code(value: f64, [low, high]: [f64; 2]) -> u16 {
    let part = (value - low) / (high - low);
    // A conversion from f64 to an integer saturates, so only the upper end is left to do.
    ((part * f64::from(CODE_MAX)).round() as u16).min(CODE_MAX)
}

/// Part of the period below which a pulse ends before an output that is silent while the bridge brakes shows the current: 2 µs.
const UNSHOWN_PART: f64 = 0.08;

/// What the current output of a driver shows of its motor's current on the mean of a period, A.
pub(super) fn output_a(output: CurrentOutput, motor: &Motor) -> f64 {
    let (current_a, duty) = (motor.current_a, motor.duty);
    // The low side conducts backwards in the pulse then.
    let opposed = duty * current_a < 0.0;
    match output {
        CurrentOutput::Bidirectional => current_a,
        CurrentOutput::Magnitude if opposed => (1.0 - duty.abs()) * current_a.abs(),
        CurrentOutput::Magnitude => current_a.abs(),
        CurrentOutput::MagnitudeWhenDriven if opposed || duty.abs() < UNSHOWN_PART => 0.0,
        CurrentOutput::MagnitudeWhenDriven => duty.abs() * current_a.abs(),
    }
}

/// The load cells.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    rng: Rng,
    ranges_n: [[f64; 2]; 3],
    gains: [f64; 3],
    offsets_n: [f64; 3],
    noise_n: f64,
    drift_n_per_s: f64,
    defects: CellDefects,
    codes: [u16; 3],
}

impl Cells {
    pub fn new(actuators: &[Actuator; 3], settings: &PlantSettings, seed: u64) -> Self {
        let ranges_n = actuators.each_ref().map(|actuator| actuator.cell_range_n);
        let offsets_n = settings.cell_offset_n;
        Self {
            rng: Rng::with_seed(seed),
            ranges_n,
            gains: settings.cell_gain_error.map(|error| 1.0 + error),
            offsets_n,
            noise_n: settings.cell_noise_n,
            drift_n_per_s: settings.cell_drift_n_per_s,
            defects: CellDefects::new(ranges_n, offsets_n, seed),
            codes: std::array::from_fn(|i| code(offsets_n[i], ranges_n[i])),
        }
    }

    /// Lets `span_s`, a tick, pass.
    pub fn advance(&mut self, span_s: f64, defects: &Defects) {
        self.defects.advance(defects);
        let drifting = defects.affected(Defect::CellDrifting);
        for (offset, drifting) in self.offsets_n.iter_mut().zip(drifting) {
            let defect = if drifting { DRIFT_N_PER_S } else { 0.0 };
            *offset += (self.drift_n_per_s + defect) * span_s;
        }
    }

    /// The codes under these tensions at a tick, while the motors have these duties.
    pub fn read(
        &mut self,
        tensions_n: [f64; 3],
        duties: [f64; 3],
        defects: &Defects,
        tick: u64,
    ) -> [u16; 3] {
        let pulls_n = std::array::from_fn(|i| tensions_n[i] * self.gains[i]);
        let shown_n = self
            .defects
            .shown_n(pulls_n, self.offsets_n, duties, defects, tick);
        for (i, shown) in shown_n.into_iter().enumerate() {
            // Drawn whatever fails, so that a defect does not change the noise of the other cells.
            let noise = self.noise_n * gaussian(&mut self.rng);
            if defects.has(Defect::CellSaturated(i)) {
                self.codes[i] = CODE_MAX;
            } else if defects.has(Defect::CellDead(i)) {
                self.codes[i] = 0;
            } else if !defects.has(Defect::CellStuck(i)) && !defects.has(Defect::CellStale(i)) {
                self.codes[i] = code(shown + noise, self.ranges_n[i]);
            }
        }
        self.codes
    }
}
