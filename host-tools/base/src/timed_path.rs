//! A path in time, given row by row, as a stream of set-points: rates from the rows beside each other, a run-up to its start.

use crate::angles;
use leg_firmware::control::{Knot, MotionState, Quintic, Stream, StreamLimits};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::set_point::{MotionLimit, PointRefusal, SetPoint, StreamPart, StreamTension};
use leg_firmware::settings::Settings;
use std::ops::RangeInclusive;

/// First and longest run-up that is tried, s, and by how much each is longer than the one before. A leg with 1 kg that is at
/// speed in less than 0.6 s swings; see scenario `circle`.
const RUN_UP_S: [f64; 2] = [0.6, 10.0];
const RUN_UP_LONGER: f64 = 1.1;

/// Where the leg shall point at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathRow {
    /// s; the first row's may be any.
    pub time_s: f64,
    /// Horizontal components.
    pub direction: [f64; 2],
    /// What the pretension is made for on the way to it; none for what it was.
    pub tension: Option<StreamTension>,
}

impl PathRow {
    /// A row of angles in degrees.
    #[must_use]
    pub fn from_angles(time_s: f64, azimuth_deg: f64, tilt_deg: f64) -> Self {
        Self {
            time_s,
            direction: angles::direction(azimuth_deg, tilt_deg),
            tension: None,
        }
    }
}

/// How the leg shall move at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedPoint {
    /// s since the first row; negative before it.
    pub time_s: f64,
    /// The motion of the direction's horizontal components.
    pub motion: MotionState<f64>,
    /// What the pretension is made for on the way to it; none for what it was.
    pub tension: Option<StreamTension>,
}

impl TimedPoint {
    /// The point as a leg takes it, where the path begins at the tick `start`: at the nearest tick, and where the leg is then.
    #[must_use]
    pub fn set_point(&self, start: u32, part: StreamPart) -> SetPoint {
        let ticks = (self.time_s * f64::from(TICK_HZ)).round();
        let later_s = ticks / f64::from(TICK_HZ) - self.time_s;
        let MotionState {
            position: p,
            rate: v,
            acceleration: a,
        } = self.motion;
        let later = |from: f64, by: f64| (from + by * later_s) as f32;
        SetPoint {
            part,
            tick: start.wrapping_add(ticks as i64 as u32),
            direction: [0, 1].map(|i| later(p[i], v[i] + a[i] * later_s / 2.0)),
            rate: [0, 1].map(|i| later(v[i], a[i])),
            acceleration: Some(a.map(|a| a as f32)),
            tension: self.tension,
        }
    }
}

impl TimedPoint {
    /// Speed and acceleration of the direction along the sphere, rad/s and rad/s².
    fn angular(&self) -> [f64; 2] {
        let MotionState {
            position: p,
            rate: v,
            acceleration: a,
        } = self.motion;
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        // z² + p² = 1, twice differentiated.
        let z = (1.0 - dot(p, p)).sqrt();
        let z_rate = -dot(p, v) / z;
        let speed_square = dot(v, v) + z_rate * z_rate;
        let z_acceleration = -(speed_square + dot(p, a)) / z;
        let towards_centre = speed_square * speed_square;
        let along_square = dot(a, a) + z_acceleration * z_acceleration - towards_centre;
        [speed_square.sqrt(), along_square.max(0.0).sqrt()]
    }
}

/// Longest time between two points that are sent, s: over a longer one the leg's check of the limits, by control points, refuses
/// more than it has to.
const SPACING_MAX_S: f64 = 0.02;

/// The points on the way from one to the next, and that one: the path of fifth degree between them, cut into short pieces.
#[must_use]
pub fn way(from: &TimedPoint, to: &TimedPoint) -> Vec<TimedPoint> {
    let span_s = to.time_s - from.time_s;
    let pieces = (span_s / SPACING_MAX_S).ceil().max(1.0) as u32;
    let path = Quintic::connect(&from.motion, &to.motion, span_s);
    let between = |i: u32| {
        let part = f64::from(i) / f64::from(pieces);
        TimedPoint {
            time_s: from.time_s + part * span_s,
            motion: path.motion(part),
            tension: to.tension,
        }
    };
    let mut points: Vec<_> = (1..pieces).map(between).collect();
    points.push(*to);
    points
}

/// Rows that a point is made of: two on each side. With fewer the rates would be off by the third derivative, and the jerk
/// between the points by twenty times that.
const ROWS: usize = 5;

/// Makes points of rows that come one after the other: each point when the second row after it is known.
#[derive(Clone, Debug, Default)]
pub struct PathBuilder {
    first_s: f64,
    /// The last rows.
    rows: Vec<PathRow>,
    /// Whether there were more.
    begun: bool,
}

impl PathBuilder {
    /// Takes a row; the points that are known now.
    pub fn push(&mut self, row: PathRow) -> Vec<TimedPoint> {
        if self.rows.is_empty() {
            self.first_s = row.time_s;
        }
        if self.rows.len() == ROWS {
            self.rows.remove(0);
        }
        self.rows.push(row);
        let first = if self.begun { ROWS / 2 } else { 0 };
        if self.rows.len() < ROWS {
            return Vec::new();
        }
        self.begun = true;
        self.points(first..=ROWS / 2)
    }

    /// The points that no other row changes, after the last row. Of two rows or less, each is a rest.
    #[must_use]
    pub fn finish(&self) -> Vec<TimedPoint> {
        let first = if self.begun { ROWS / 2 + 1 } else { 0 };
        self.points(first..=self.rows.len().saturating_sub(1))
    }

    /// The motion of the polynomial through the last rows, at some of them.
    fn points(&self, at: RangeInclusive<usize>) -> Vec<TimedPoint> {
        let rows = self.rows.get(at).unwrap_or_default();
        let motion = |row: &PathRow| TimedPoint {
            time_s: row.time_s - self.first_s,
            motion: self.motion(row),
            tension: row.tension,
        };
        rows.iter().map(motion).collect()
    }

    fn motion(&self, at: &PathRow) -> MotionState<f64> {
        if self.rows.len() < 3 {
            return MotionState::resting(at.direction);
        }
        let [[_, x_rate, x_bend], [_, y_rate, y_bend]] = [0, 1].map(|i| {
            // Newton's form: its coefficients are divided differences.
            let mut coefficients: Vec<_> = self.rows.iter().map(|row| row.direction[i]).collect();
            for order in 1..self.rows.len() {
                for k in (order..self.rows.len()).rev() {
                    let span_s = self.rows[k].time_s - self.rows[k - order].time_s;
                    coefficients[k] = (coefficients[k] - coefficients[k - 1]) / span_s;
                }
            }
            let pairs = self.rows.iter().zip(coefficients).rev();
            pairs.fold([0.0; 3], |[value, rate, bend], (row, coefficient)| {
                let x = at.time_s - row.time_s;
                [
                    coefficient + x * value,
                    value + x * rate,
                    2.0 * rate + x * bend,
                ]
            })
        });
        MotionState {
            position: at.direction,
            rate: [x_rate, y_rate],
            acceleration: [x_bend, y_bend],
        }
    }
}

/// A path whose rows are all known.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedPath {
    points: Vec<TimedPoint>,
}

impl TimedPath {
    /// The path through rows in the order of their times.
    #[must_use]
    pub fn new(rows: &[PathRow]) -> Self {
        let mut builder = PathBuilder::default();
        let mut points: Vec<_> = rows.iter().flat_map(|row| builder.push(*row)).collect();
        points.extend(builder.finish());
        Self { points }
    }

    /// What is streamed of the path: a rest from which a leg gets to its start, and points that are near enough to each other.
    ///
    /// # Errors
    /// The time of the point that is refused, s, and why.
    pub fn streamed(&self, settings: &Settings) -> Result<Vec<TimedPoint>, (f64, PointRefusal)> {
        let limits = StreamLimits::<f32>::new(settings);
        for point in &self.points {
            let motion = limits.motion(&point.set_point(0, StreamPart::Next));
            motion.map_err(|refusal| (point.time_s, refusal))?;
        }
        let points = self.with_run_up(settings);
        points.map_err(|refused| match refused {
            // It bulges out of the reach, or comes to rest out of it, because it is too fast: all its points are in reach.
            (_, PointRefusal::OutOfReach) => self.first_beyond(settings).unwrap_or(refused),
            _ => refused,
        })
    }

    fn with_run_up(&self, settings: &Settings) -> Result<Vec<TimedPoint>, (f64, PointRefusal)> {
        let Some(first) = self.points.first() else {
            return Err((0.0, PointRefusal::NoStream));
        };
        let mut points = run_up(first, settings).map_err(|refusal| (first.time_s, refusal))?;
        for (from, to) in self.points.iter().zip(self.points.iter().skip(1)) {
            points.extend(way(from, to));
        }
        check(&points, settings)?;
        Ok(points)
    }

    /// The first point that asks for more than the speed or the acceleration of the settings: its time, s, and for which.
    fn first_beyond(&self, settings: &Settings) -> Option<(f64, PointRefusal)> {
        let limits = &settings.motion;
        self.points.iter().find_map(|point| {
            let [speed, acceleration] = point.angular();
            let limit = if speed > limits.speed_rad_per_s.into() {
                MotionLimit::Speed
            } else if acceleration > limits.acceleration_rad_per_s2.into() {
                MotionLimit::Acceleration
            } else {
                return None;
            };
            Some((point.time_s, PointRefusal::Limit(limit)))
        })
    }

    /// Its points.
    #[must_use]
    pub fn points(&self) -> &[TimedPoint] {
        &self.points
    }

    /// The motion at a time in s; none before the first point and after the last.
    #[must_use]
    pub fn motion(&self, time_s: f64) -> Option<MotionState<f64>> {
        let next = self.points.partition_point(|point| point.time_s < time_s);
        let (from, to) = (
            self.points.get(next.checked_sub(1)?)?,
            self.points.get(next)?,
        );
        let span_s = to.time_s - from.time_s;
        let path = Quintic::connect(&from.motion, &to.motion, span_s);
        Some(path.motion((time_s - from.time_s) / span_s))
    }
}

/// A rest before a start, and the points from there to it within the limits: the way to rest from that start, gone backwards.
///
/// # Errors
/// Why there is none.
pub fn run_up(first: &TimedPoint, settings: &Settings) -> Result<Vec<TimedPoint>, PointRefusal> {
    if first.motion == MotionState::resting(first.motion.position) {
        let before = TimedPoint {
            time_s: first.time_s - SPACING_MAX_S,
            ..*first
        };
        return Ok(vec![before, *first]);
    }
    let mut refusal = PointRefusal::OutOfReach;
    let longer = std::iter::successors(Some(RUN_UP_S[0]), |time_s| {
        Some(time_s * RUN_UP_LONGER).filter(|time_s| *time_s < RUN_UP_S[1])
    });
    // At the edge of the workspace a shorter one may be all there is room for.
    let shorter = std::iter::successors(Some(RUN_UP_S[0]), |time_s| {
        Some(time_s / RUN_UP_LONGER).filter(|time_s| *time_s > SPACING_MAX_S)
    });
    for time_s in longer.chain(shorter) {
        match run_up_lasting(time_s, first, settings) {
            Ok(points) => return Ok(points),
            // That a limit is left says more than that a long run-up leads too far, or that a short one is short.
            Err(error @ PointRefusal::Limit(_)) if time_s >= RUN_UP_S[0] => refusal = error,
            Err(_) => {}
        }
    }
    Err(refusal)
}

fn run_up_lasting(
    time_s: f64,
    first: &TimedPoint,
    settings: &Settings,
) -> Result<Vec<TimedPoint>, PointRefusal> {
    let backwards = MotionState {
        rate: first.motion.rate.map(|rate| -rate),
        ..first.motion
    };
    let rest = TimedPoint {
        time_s: first.time_s - time_s,
        motion: backwards.rest_after(time_s),
        tension: first.tension,
    };
    let mut points = vec![rest];
    points.extend(way(&rest, first));
    check(&points, settings).map_err(|(_, refusal)| refusal)?;
    Ok(points)
}

/// Whether a leg at rest at the first point may follow the others to their end.
///
/// # Errors
/// The time of the point that is refused, s, and why.
pub fn check(points: &[TimedPoint], settings: &Settings) -> Result<(), (f64, PointRefusal)> {
    let mut stream = Stream::new(StreamLimits::<f32>::new(settings));
    // Any will do: far from where the count of ticks begins again.
    let start = u32::MAX / 2;
    let mut before = None;
    for point in points {
        let set_point = point.set_point(start, StreamPart::Next);
        let taken = match before.replace(set_point.tick) {
            None => stream.limits.motion(&set_point).and_then(|motion| {
                let tick = set_point.tick.wrapping_sub(u32::from(TICK_HZ));
                stream.begin(Knot { tick, motion }, &set_point)
            }),
            Some(now) => {
                // Otherwise there is no room for it.
                let _ = stream.next_segment();
                stream.extend(now, &set_point)
            }
        };
        taken.map_err(|refusal| (point.time_s, refusal))?;
    }
    Ok(())
}
