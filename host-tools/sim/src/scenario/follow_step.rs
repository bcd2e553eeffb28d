//! Paths in time that a scenario has the leg follow.

use crate::range;
use leg_base::timed_path::{PathRow, TimedPath};
use leg_firmware::set_point::StreamTension;
use serde::{Deserialize, Deserializer, de::Error};

/// The most rows of a path.
const ROWS_MAX: usize = 10_000;

/// The longest path, s.
const LONGEST_S: f64 = 300.0;

/// The highest pretension of a row, N: above every leg's.
const PRETENSION_MAX_N: f64 = 10_000.0;

/// A path, streamed as set-points.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FollowStep {
    /// Rows of time (s), azimuth and tilt (degrees), and a pretension (N), if it changes.
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
    let rows = Vec::<Vec<f64>>::deserialize(deserializer)?;
    if !(2..=ROWS_MAX).contains(&rows.len()) {
        let sentence = format!("rows has {} rows, not 2 to {ROWS_MAX}", rows.len());
        return Err(D::Error::custom(sentence));
    }
    let mut last_s = f64::NEG_INFINITY;
    let mut path = Vec::with_capacity(rows.len());
    for (number, row) in (1..).zip(&rows) {
        let row = path_row(row).map_err(|what| D::Error::custom(format!("row {number}{what}")))?;
        if row.time_s <= last_s {
            let sentence = format!(
                "row {number}: time_s = {} is not after {last_s}",
                row.time_s
            );
            return Err(D::Error::custom(sentence));
        }
        last_s = row.time_s;
        path.push(row);
    }
    Ok(TimedPath::new(&path))
}

/// One row, or what is wrong with it.
fn path_row(row: &[f64]) -> Result<PathRow, String> {
    let (time_s, azimuth_deg, tilt_deg, pretension_n) = match *row {
        [time_s, azimuth_deg, tilt_deg] => (time_s, azimuth_deg, tilt_deg, None),
        [time_s, azimuth_deg, tilt_deg, n] => (time_s, azimuth_deg, tilt_deg, Some(n)),
        _ => return Err(format!(" has {} numbers, not 3 or 4", row.len())),
    };
    for (key, value, least, most) in [
        ("time_s", time_s, -LONGEST_S, LONGEST_S),
        ("azimuth_deg", azimuth_deg, -3600.0, 3600.0),
        ("tilt_deg", tilt_deg, -90.0, 90.0),
        (
            "pretension_n",
            pretension_n.unwrap_or(0.0),
            0.0,
            PRETENSION_MAX_N,
        ),
    ] {
        if !(least..=most).contains(&value) {
            return Err(format!(": {key} = {value} is not from {least} to {most}"));
        }
    }
    Ok(PathRow {
        tension: pretension_n.map(|n| StreamTension::Pretension(n as f32)),
        ..PathRow::from_angles(time_s, azimuth_deg, tilt_deg)
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::FollowStep;

    fn step(rows: &str) -> Result<FollowStep, String> {
        toml::from_str(&format!("rows = {rows}")).map_err(|error| error.message().into())
    }

    #[test]
    fn a_row_has_a_pretension_or_none() {
        assert!(step("[[0, 0, 3], [1, 0, 3.5]]").is_ok());
        assert!(step("[[0, 0, 3], [1, 0, 3.5, 70]]").is_ok());
        assert_ne!(
            step("[[0, 0, 3], [1, 0, 3.5, 70]]").unwrap(),
            step("[[0, 0, 3], [1, 0, 3.5]]").unwrap()
        );
    }

    #[test]
    fn a_row_that_is_refused_is_named() {
        for (rows, what) in [
            ("[[0, 0, 3]]", "rows has 1 rows, not 2 to 10000"),
            ("[[0, 0, 3], [1, 0]]", "row 2 has 2 numbers, not 3 or 4"),
            ("[[0, 0, 3], [0, 0, 3]]", "row 2: time_s = 0 is not after 0"),
            (
                "[[0, 0, 91], [1, 0, 3]]",
                "row 1: tilt_deg = 91 is not from -90 to 90",
            ),
            (
                "[[0, 0, 3], [1, 0, 3, -1]]",
                "row 2: pretension_n = -1 is not from 0 to 10000",
            ),
            (
                "[[0, 0, 3], [1, 0, 3, nan]]",
                "row 2: pretension_n = NaN is not from 0 to 10000",
            ),
        ] {
            let refused = step(rows).unwrap_err();
            assert!(refused.contains(what), "{refused}");
        }
    }
}
