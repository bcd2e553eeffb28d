//! Paths in time that a scenario has the leg follow.

use crate::range;
use leg_base::timed_path::{PathRow, TimedPath};
use serde::{Deserialize, Deserializer, de::Error};

/// The most rows of a path.
const ROWS_MAX: usize = 10_000;

/// The longest path, s.
const LONGEST_S: f64 = 300.0;

/// A path, streamed as set-points.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FollowStep {
    /// Rows of time (s), azimuth and tilt (degrees).
    #[serde(deserialize_with = "path")]
    pub rows: TimedPath,
    /// Whether the host says which point is the last.
    #[serde(default = "yes")]
    pub ends: bool,
}

fn yes() -> bool {
    true
}

/// A circle about the vertical, from azimuth 0.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CircleStep {
    /// Degrees.
    #[serde(deserialize_with = "range::tilt_deg")]
    pub tilt_deg: f64,
    /// Time of a turn, s.
    #[serde(deserialize_with = "range::period_s")]
    pub period_s: f64,
    /// Turns.
    #[serde(deserialize_with = "range::circle_turns")]
    pub turns: f64,
    /// Points in a second.
    #[serde(deserialize_with = "range::points_per_s")]
    pub points_per_s: f64,
}

impl CircleStep {
    /// The circle as points.
    #[must_use]
    pub fn path(&self) -> TimedPath {
        let count = (self.turns * self.period_s * self.points_per_s).round() as u32;
        let rows: Vec<_> = (0..=count.max(2))
            .map(|i| {
                let time_s = f64::from(i) / self.points_per_s;
                PathRow::from_angles(time_s, 360.0 * time_s / self.period_s, self.tilt_deg)
            })
            .collect();
        TimedPath::new(&rows)
    }
}

/// Rows in the order of their times.
fn path<'de, D: Deserializer<'de>>(deserializer: D) -> Result<TimedPath, D::Error> {
    let rows = Vec::<[f64; 3]>::deserialize(deserializer)?;
    if !(2..=ROWS_MAX).contains(&rows.len()) {
        let sentence = format!("rows has {} rows, not 2 to {ROWS_MAX}", rows.len());
        return Err(D::Error::custom(sentence));
    }
    let mut last_s = f64::NEG_INFINITY;
    for (number, row) in (1..).zip(&rows) {
        let [time_s, azimuth_deg, tilt_deg] = *row;
        for (key, value, most) in [
            ("time_s", time_s, LONGEST_S),
            ("azimuth_deg", azimuth_deg, 3600.0),
            ("tilt_deg", tilt_deg, 90.0),
        ] {
            if !(-most..=most).contains(&value) {
                let sentence =
                    format!("row {number}: {key} = {value} is not from -{most} to {most}");
                return Err(D::Error::custom(sentence));
            }
        }
        if time_s <= last_s {
            let sentence = format!("row {number}: time_s = {time_s} is not after {last_s}");
            return Err(D::Error::custom(sentence));
        }
        last_s = time_s;
    }
    let rows: Vec<_> = rows
        .into_iter()
        .map(|[time_s, azimuth_deg, tilt_deg]| PathRow::from_angles(time_s, azimuth_deg, tilt_deg))
        .collect();
    Ok(TimedPath::new(&rows))
}
