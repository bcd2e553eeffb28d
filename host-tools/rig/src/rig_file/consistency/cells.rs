//! Whether the load cells show what homing and the monitors look for.

use super::{RigFile, own_path, place_of};
use crate::actuator::ACTUATOR;
use crate::number::{decimal, plain};
use crate::plant_settings::SIMULATION;
use crate::rig_file::derived::two_digits;
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::sensors::{CODE_MAX, SATURATED_CODES};

/// Part of the tension at which a tendon counts as taut that a step of the converter may be, at most: homing looks for a hundredth part of it, which
/// it gets by averaging.
const STEP_PART: f64 = 0.25;

/// Codes of a step of the 12-bit converter, whose sixteenfold sum a code is.
const STEP_CODES: f64 = 16.0;

/// Refuses load cells of a motor, from 0, that are saturated where something is looked for, or too coarse for it.
pub(super) fn check(file: &RigFile, motor: usize, root: &Section<'_>) -> Result<(), TomlError> {
    let n_per_code = file.calibration.cell_n_per_code[motor];
    let zero_code = file.calibration.cell_zero_code[motor];
    let (limits, homing) = (&file.gains.limits, &file.gains.homing);
    let highest_n = (f64::from(CODE_MAX - SATURATED_CODES) - zero_code) * n_per_code;
    let lowest_n = (f64::from(SATURATED_CODES) - zero_code) * n_per_code;
    let over_n = file.f_max_n * (1.0 + decimal(limits.over_tension_part));
    let touch_n = decimal(homing.touch_n);
    let step_n = STEP_CODES * n_per_code;
    let coarsest_n = STEP_PART * touch_n;
    let cells = own_path("actuator.cell_range_n", motor, root);
    let refused = |sentence: String, help: String| {
        let calibration = ["cell_n_per_code", "cell_zero_code"];
        let place = place_of(&[ACTUATOR, "cell_range_n"], motor, root)
            .or_else(|| {
                calibration
                    .iter()
                    .find_map(|key| root.place(&["calibration", key]))
            })
            .or_else(|| root.place(&["tendon", "f_max_n"]));
        Err(TomlError::new(place.unwrap_or(0..0), sentence, help))
    };
    if highest_n <= over_n {
        return refused(
            format!(
                "a load cell (`{cells}`, `calibration`) is saturated above {} N, before its tension is found too high: `tendon.f_max_n` ({}) and \
                 `control.limits.over_tension_part` ({}) of it",
                plain(two_digits(highest_n)),
                plain(file.f_max_n),
                plain(decimal(limits.over_tension_part))
            ),
            format!("let it show more than {} N", plain(two_digits(over_n))),
        );
    }
    // An offset of so much is usual, and homing takes it.
    if -lowest_n < touch_n {
        return refused(
            format!(
                "a load cell (`{cells}`, `calibration`) is saturated below {} N, and so is a slack one with an offset of less than \
                 `control.homing.touch_n` ({})",
                plain(two_digits(lowest_n)),
                plain(touch_n)
            ),
            "let its range begin lower".into(),
        );
    }
    if step_n > coarsest_n {
        return refused(
            format!(
                "a step of a load cell (`{cells}`, `calibration`) is {} N, too coarse for `control.homing.touch_n` ({})",
                plain(two_digits(step_n)),
                plain(touch_n)
            ),
            format!(
                "give a range in which a step is at most {} N, or a longer `release_m` and a higher `touch_n`",
                plain(two_digits(coarsest_n))
            ),
        );
    }
    Ok(())
}

/// A code that does not change is that of a cell that is stuck.
pub(super) fn check_noise(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    let noise_n = file.plant.cell_noise_n;
    let n_per_code = file
        .calibration
        .cell_n_per_code
        .into_iter()
        .fold(0.0, f64::max);
    if noise_n >= 0.5 * n_per_code {
        return Ok(());
    }
    Err(TomlError::new(
        root.place(&[SIMULATION, "cell_noise_n"]).unwrap_or(0..0),
        format!(
            "with `{SIMULATION}.cell_noise_n` ({}) the codes of the simulated load cells do not change, as those of cells that are stuck",
            plain(noise_n)
        ),
        format!("give at least {}", plain(two_digits(n_per_code))),
    ))
}
