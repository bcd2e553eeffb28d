//! Whether the load cells show what homing and the monitors look for.

use super::{RigFile, own_path, place_of};
use crate::actuator::{ACTUATOR, Actuator};
use crate::calibration::CALIBRATION;
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
pub(super) const STEP_CODES: f64 = 16.0;

/// Refuses load cells of a motor, from 0, that are saturated where something is looked for, or too coarse for it.
pub(super) fn check(file: &RigFile, motor: usize, root: &Section<'_>) -> Result<(), TomlError> {
    let n_per_code = file.calibration.cell_n_per_code[motor];
    let zero_code = file.calibration.cell_zero_code[motor];
    let (limits, homing) = (&file.gains.limits, &file.gains.homing);
    let highest_n = (f64::from(CODE_MAX - SATURATED_CODES) - zero_code) * n_per_code;
    let lowest_n = (f64::from(SATURATED_CODES) - zero_code) * n_per_code;
    let over_n = file.f_max_n * (1.0 + decimal(limits.over_tension_part));
    let touch_n = decimal(homing.touch_n);
    let touch = ["control", "homing", "touch_n"];
    let step_n = STEP_CODES * n_per_code;
    let coarsest_n = STEP_PART * touch_n;
    let cell = format!(
        "load cell {} (`{}`, `{CALIBRATION}`)",
        motor + 1,
        own_path("actuator.cell_range_n", motor, root)
    );
    let refused = |others: &[&[&str]], sentence: String, help: String| {
        let calibration = ["cell_n_per_code", "cell_zero_code"];
        let place = calibration
            .iter()
            .find_map(|key| root.place(&[CALIBRATION, key]))
            .or_else(|| place_of(&[ACTUATOR, "cell_range_n"], motor, root))
            .or_else(|| others.iter().find_map(|path| root.place(path)));
        Err(TomlError::new(place.unwrap_or(0..0), sentence, help))
    };
    if highest_n <= over_n {
        let others: [&[&str]; 2] = [
            &["control", "limits", "over_tension_part"],
            &["tendon", "f_max_n"],
        ];
        return refused(
            &others,
            format!(
                "{cell} is saturated above {} N, before its tension is found too high: `tendon.f_max_n` ({}) and \
                 `control.limits.over_tension_part` ({}) of it",
                plain(two_digits(highest_n)),
                plain(file.f_max_n),
                plain(decimal(limits.over_tension_part))
            ),
            format!("let it show more than {} N", plain(two_digits(over_n))),
        );
    }
    // An offset of so much is usual, and homing takes it; one that was measured drifts by a part of it.
    let measured = root.has(CALIBRATION) && zero_code != file.actuators[motor].cell_zero_code();
    let offset_n = if measured {
        STEP_PART * touch_n
    } else {
        touch_n
    };
    if -lowest_n < offset_n {
        return refused(
            &[&touch],
            format!(
                "{cell} is saturated below {} N, and so is a slack one with an offset of {} N, by `control.homing.touch_n` ({})",
                plain(two_digits(lowest_n)),
                plain(two_digits(-offset_n)),
                plain(touch_n)
            ),
            "let its range begin lower".into(),
        );
    }
    if step_n > coarsest_n {
        return refused(
            &[&touch, &[ACTUATOR], &["mass", "leg_kg"]],
            format!(
                "a step of {cell} is {} N, too coarse for `control.homing.touch_n` ({}), which is given or follows from the leg's weight",
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

/// A code that does not change is that of a cell that is stuck. The simulated leg has the cells of the actuators' data.
pub(super) fn check_noise(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    let noise_n = file.plant.cell_noise_n;
    let cells = file.actuators.iter().map(Actuator::cell_n_per_code);
    let n_per_code = cells.fold(0.0, f64::max);
    if noise_n >= 0.5 * n_per_code {
        return Ok(());
    }
    let place = root.place(&[SIMULATION, "cell_noise_n"]);
    let place = place.or_else(|| root.place(&[ACTUATOR, "cell_range_n"]));
    let place = place.or_else(|| root.place(&[ACTUATOR]));
    Err(TomlError::new(
        place.unwrap_or(0..0),
        format!(
            "with `{SIMULATION}.cell_noise_n` ({}) the codes of the simulated load cells do not change, as those of cells that are stuck",
            plain(noise_n)
        ),
        format!("give at least {}", plain(two_digits(n_per_code))),
    ))
}
