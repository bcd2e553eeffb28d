//! Whether tensions hold a leg wherever it leans.

use crate::number::{decimal, plain};
use crate::rig_file::RigFile;
use crate::rig_file::consistency::Warning;
use crate::rig_file::derived::{two_digits_above, two_digits_below};
use crate::toml_section::Section;

/// Warns of a leg that does not lean to the edge of its workspace in every direction, or not with its pretension.
pub(super) fn warning(file: &RigFile, root: &Section<'_>) -> Option<Warning> {
    let Some([lowest_n, highest_n]) = pretensions_n(file, file.tilt_deg) else {
        return Some(tilt_warning(file, root));
    };
    let pretension_n = file.pretension_n;
    if (lowest_n..=highest_n).contains(&pretension_n) {
        return None;
    }
    let (changed, fit_n) = if pretension_n < lowest_n {
        ("raised", two_digits_above(lowest_n))
    } else {
        ("lowered", two_digits_below(highest_n))
    };
    let kept = |deg: f64| {
        let range_n = pretensions_n(file, deg);
        range_n.is_some_and(|[low_n, high_n]| (low_n..=high_n).contains(&pretension_n))
    };
    let remedy = if (lowest_n..=highest_n).contains(&fit_n) {
        format!("{} would do", plain(fit_n))
    } else if let Some(deg) = whole_degrees(file).find(|deg| kept(*deg)) {
        format!("a `tilt_deg` of {} would do", plain(deg))
    } else {
        "see the units of `[mass]` and `[geometry]`".into()
    };
    Some(Warning {
        span: root.place(&["tendon", "pretension_n"]).unwrap_or(0..0),
        text: format!(
            "`pretension_n` ({}) is {changed} where the leg leans to `tilt_deg` ({}), as `f_min_n` and `f_max_n` ask, and reported as a limit: {remedy}",
            plain(pretension_n),
            plain(file.tilt_deg)
        ),
    })
}

/// The pretensions that keep the tensions within their bounds in every direction of a tilt, N; none where no tensions hold the leg.
fn pretensions_n(file: &RigFile, tilt_deg: f64) -> Option<[f64; 2]> {
    let bands = file.gains.servos.iter();
    let band_n = bands
        .map(|servo| decimal(servo.f_max_band_n))
        .fold(0.0, f64::max);
    let mut range_n = [0.0_f64, f64::INFINITY];
    for part in 0..12 {
        let query = file.query(30.0 * f64::from(part), tilt_deg, 0.0);
        let pose = leg_model::evaluate(&file.parameters, &query).ok()?;
        if !pose.feasible {
            return None;
        }
        // A motor is slowed down within the band below the maximum tension.
        let [lowest_n, highest_n] = pose.pretension_range_n;
        range_n = [range_n[0].max(lowest_n), range_n[1].min(highest_n - band_n)];
    }
    Some(range_n)
}

/// Less tilts, the greatest first.
fn whole_degrees(file: &RigFile) -> impl Iterator<Item = f64> {
    (1..file.tilt_deg.ceil() as u32).rev().map(f64::from)
}

fn tilt_warning(file: &RigFile, root: &Section<'_>) -> Warning {
    let fit_deg = whole_degrees(file).find(|deg| pretensions_n(file, *deg).is_some());
    let remedy = fit_deg.map_or_else(
        || "see the units of `[mass]` and `[geometry]`".into(),
        |deg| format!("{} would do", plain(deg)),
    );
    Warning {
        span: root.place(&["workspace", "tilt_deg"]).unwrap_or(0..0),
        text: format!(
            "no tensions within `tendon.f_min_n` and `tendon.f_max_n` hold the leg in every direction at `tilt_deg` ({}): {remedy}",
            plain(file.tilt_deg)
        ),
    }
}
