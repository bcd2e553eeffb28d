//! Whether tendons get as far as they have to within the travels and times that are set.

use super::{RigFile, check_below};
use crate::actuator::ACTUATOR;
use crate::gains::{CONTROL, range_of};
use crate::number::{decimal, plain};
use crate::rig_file::derived::{stretch_m, two_digits, two_digits_above};
use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::leg::SLACK_M;
use leg_firmware::settings::{Limits, SERVO};

pub(super) fn check(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    let homing = &file.gains.homing;
    let release = ("control.homing.release_m", decimal(homing.release_m));
    let travel = ("control.homing.travel_m", decimal(homing.travel_m));
    let reason = "else a tendon that was paid out is not reeled in until it is taut";
    check_below(release, travel, reason, root)?;
    check_relaxed(file, root)?;
    check_taut(file, root)
}

/// A tendon is paid out until it is slack, from the maximum tension, too.
fn check_relaxed(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    let stretch_m = stretch_m(file, file.f_max_n);
    let servos = file.gains.servos.iter();
    let play_m = servos
        .map(|servo| decimal(servo.play_m))
        .fold(0.0, f64::max);
    let least_m = stretch_m + play_m + decimal(SLACK_M);
    let travel_m = decimal(file.gains.limits.relax_travel_m);
    if travel_m >= least_m {
        return Ok(());
    }
    let place = root.place(&[CONTROL, "limits", "relax_travel_m"]);
    let place = place.or_else(|| root.place(&["tendon", "stiffness_n_per_m"]));
    let place = place.or_else(|| root.place(&["tendon"]));
    Err(TomlError::new(
        place.unwrap_or(0..0),
        format!(
            "a tendon that pulls with `tendon.f_max_n` stretches by {} m, its gear has a play of {} m (`control.servo.play_m`), and \
             `control.limits.relax_travel_m` ({}) does not make it slack",
            plain(two_digits(stretch_m)),
            plain(two_digits(play_m)),
            plain(travel_m)
        ),
        format!(
            "give `relax_travel_m` at least {}",
            plain(two_digits_above(least_m))
        ),
    ))
}

/// Slack is taken up within `taut_time_s`, however the leg was left.
fn check_taut(file: &RigFile, root: &Section<'_>) -> Result<(), TomlError> {
    let (limits, homing) = (&file.gains.limits, &file.gains.homing);
    let slack_m = decimal(homing.release_m.max(limits.relax_travel_m));
    let (time_s, ramp) = (decimal(limits.taut_time_s), decimal(limits.ramp_m_per_s));
    if time_s * ramp > slack_m {
        return Ok(());
    }
    let in_limits = ["taut_time_s", "ramp_m_per_s", "relax_travel_m"].map(|key| ("limits", key));
    let in_homing = ["release_m", "speed_m_per_s"].map(|key| ("homing", key));
    let mut paths = in_limits.iter().chain(&in_homing);
    let place = paths.find_map(|(section, key)| root.place(&[CONTROL, section, key]));
    let place = place.or_else(|| root.place(&[CONTROL, SERVO, "speed_m_per_s"]));
    let place = place.or_else(|| root.place(&[ACTUATOR]));
    let needed_s = two_digits_above(1.2 * slack_m / ramp);
    let [_, longest_s] = range_of(Limits::FIELDS, "taut_time_s");
    let help = if needed_s <= longest_s {
        format!(
            "give `taut_time_s` at least {}, or a faster ramp",
            plain(needed_s)
        )
    } else {
        format!(
            "give `ramp_m_per_s` at least {}: no more than {} s may be given",
            plain(two_digits_above(1.2 * slack_m / longest_s)),
            plain(longest_s)
        )
    };
    Err(TomlError::new(
        place.unwrap_or(0..0),
        format!(
            "within `control.limits.taut_time_s` ({}) and with `control.limits.ramp_m_per_s` ({}) a leg that is armed does not take up {} m of slack, \
             the greater one of `control.homing.release_m` and `control.limits.relax_travel_m`",
            plain(time_s),
            plain(ramp),
            plain(slack_m)
        ),
        help,
    ))
}
