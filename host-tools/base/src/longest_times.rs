//! How long a leg is waited for at the most. Slow settings take longer: twice what their parts take after each other.

use leg_firmware::settings::Settings;
use std::time::Duration;

/// How long a move with all that belongs to it is waited for whatever the settings are.
pub const USUAL_MOVE: Duration = Duration::from_secs(60);
/// The same of a homing.
pub const USUAL_HOMING: Duration = Duration::from_secs(120);

/// Longer than any settings ask for; of settings that give no number, too.
const DAY: Duration = Duration::from_secs(24 * 3600);

/// Time constants of a filter after which it has settled.
const FILTER_TIMES: f32 = 10.0;

/// How often a tendon is reeled in or paid out by the longest travel of homing, and how often the leg is averaged at rest meanwhile: each of three tendons
/// twice, all of them once at the begin, and one to spare.
const HOMING_TRAVELS: f32 = 8.0;
const HOMING_RESTS: f32 = 8.0;

/// Longest way of a leg to where it is commanded, by the limits on its motion, and the longest change of its pretension, before that or after it.
#[must_use]
pub fn longest_move(settings: &Settings) -> Duration {
    let motion = &settings.motion;
    let turn_rad = 2.0 * settings.tilt_max_sine.asin();
    let rise_s = motion.speed_rad_per_s / motion.acceleration_rad_per_s2
        + motion.acceleration_rad_per_s2 / motion.jerk_rad_per_s3;
    let turn_s = turn_rad / motion.speed_rad_per_s + rise_s;
    let pretension_s = settings.f_max_n / motion.pretension_rate_n_per_s;
    let filters_s = FILTER_TIMES * (motion.load_time_s + settings.estimation.load_time_s);
    longer(USUAL_MOVE, turn_s + pretension_s + filters_s)
}

/// Longest way of a leg straight down, and of its tendons until they are relaxed.
#[must_use]
pub fn longest_disarm(settings: &Settings) -> Duration {
    let limits = &settings.limits;
    let relaxing_s = limits.relax_travel_m / limits.ramp_m_per_s;
    let relaxing = Duration::try_from_secs_f32(2.0 * relaxing_s).unwrap_or(DAY);
    longest_move(settings).saturating_add(relaxing).min(DAY)
}

/// Longest homing, until the leg begins to be tensioned.
#[must_use]
pub fn longest_homing(settings: &Settings) -> Duration {
    let homing = &settings.homing;
    let travels_s = HOMING_TRAVELS * homing.travel_m / homing.speed_m_per_s;
    let rests_s =
        HOMING_RESTS * (homing.tare_time_s + homing.settle_time_s + homing.average_time_s);
    longer(USUAL_HOMING, travels_s + rests_s)
}

/// The usual time, or twice the time of the parts.
fn longer(usual: Duration, parts_s: f32) -> Duration {
    let parts = Duration::try_from_secs_f32(2.0 * parts_s).unwrap_or(DAY);
    parts.clamp(usual, DAY)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::{DAY, USUAL_HOMING, USUAL_MOVE, longest_disarm, longest_homing, longest_move};
    use leg_firmware::settings::Settings;

    #[test]
    fn slow_settings_are_given_the_time_that_they_take() {
        let mut settings = Settings::table_1().unwrap();
        assert_eq!(longest_move(&settings), USUAL_MOVE);
        assert_eq!(longest_homing(&settings), USUAL_HOMING);
        settings.motion.speed_rad_per_s = 0.01;
        // From 30° on one side to 30° on the other, 1.05 rad.
        assert!(longest_move(&settings).as_secs_f32() > 2.0 * 104.0);
        settings.motion.speed_rad_per_s = 0.8;
        settings.motion.pretension_rate_n_per_s = 0.1;
        assert!(longest_move(&settings).as_secs_f32() > 2.0 * 1_400.0);
        let relaxing = longest_disarm(&settings) - longest_move(&settings);
        assert!((relaxing.as_secs_f32() - 2.0).abs() < 1e-3, "{relaxing:?}");
        settings.limits.ramp_m_per_s = 1e-5;
        let relaxing = longest_disarm(&settings) - longest_move(&settings);
        assert!(
            (relaxing.as_secs_f32() - 1_000.0).abs() < 1.0,
            "{relaxing:?}"
        );
        settings.homing.settle_time_s = 60.0;
        settings.homing.average_time_s = 60.0;
        assert!(longest_homing(&settings).as_secs_f32() > 6.0 * 120.0);
        settings.tilt_max_sine = f32::NAN;
        assert_eq!(longest_move(&settings), DAY);
    }
}
