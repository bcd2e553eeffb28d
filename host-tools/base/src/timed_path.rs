//! A path in time, given row by row, as a stream of set-points: rates from the rows beside each other, a run-up to its start.

use crate::angles;
use leg_firmware::control::{Knot, Stream, StreamLimits};
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::set_point::{PointRefusal, SetPoint, StreamPart};
use leg_firmware::settings::Settings;
use leg_model::HalfTangent;

/// Shortest and longest run-up that is tried, s, and by how much each is longer than the one before.
const RUN_UP_S: [f64; 2] = [0.05, 10.0];
const RUN_UP_LONGER: f64 = 1.1;

/// Where the leg shall point at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// s; the first row's may be any.
    pub time_s: f64,
    /// Horizontal components.
    pub direction: [f64; 2],
}

impl Row {
    /// A row of angles in degrees.
    #[must_use]
    pub fn from_angles(time_s: f64, azimuth_deg: f64, tilt_deg: f64) -> Self {
        Self {
            time_s,
            direction: angles::direction(azimuth_deg, tilt_deg),
        }
    }
}

/// How the leg shall move at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedPoint {
    /// s since the first row; negative before it.
    pub time_s: f64,
    /// Horizontal components of the direction, their rates (1/s) and the changes of these (1/s²).
    pub derivatives: [[f64; 2]; 3],
}

impl TimedPoint {
    /// The point as a leg takes it, where the path begins at the tick `start`.
    #[must_use]
    pub fn set_point(&self, start: u32, part: StreamPart) -> SetPoint {
        let [direction, rate, acceleration] = self
            .derivatives
            .map(|pair| pair.map(|number| number as f32));
        let ticks = (self.time_s * f64::from(TICK_HZ)).round() as i64;
        SetPoint {
            part,
            tick: start.wrapping_add(ticks as u32),
            direction,
            rate,
            acceleration: Some(acceleration),
        }
    }
}

/// Makes points of rows that come one after the other: each point when the row after it is known, and the first with the
/// third row.
#[derive(Clone, Debug, Default)]
pub struct PathBuilder {
    rows: Vec<Row>,
    first_s: f64,
}

impl PathBuilder {
    /// Takes a row; the points that are known now.
    pub fn push(&mut self, row: Row) -> Vec<TimedPoint> {
        if self.rows.is_empty() {
            self.first_s = row.time_s;
        }
        self.rows.push(row);
        match self.rows.len() {
            0..3 => Vec::new(),
            3 => vec![self.point(0), self.point(1)],
            _ => {
                self.rows.remove(0);
                vec![self.point(1)]
            }
        }
    }

    /// The points that no other row changes, after the last row. Of two rows or less, each is a rest.
    #[must_use]
    pub fn finish(&self) -> Vec<TimedPoint> {
        if let [_, _, _] = *self.rows {
            return vec![self.point(2)];
        }
        let rest = |row: &Row| TimedPoint {
            time_s: row.time_s - self.first_s,
            derivatives: [row.direction, [0.0; 2], [0.0; 2]],
        };
        self.rows.iter().map(rest).collect()
    }

    /// The motion of the parabola through the three rows, at one of them.
    fn point(&self, at: usize) -> TimedPoint {
        let [a, b, c] = [self.rows[0], self.rows[1], self.rows[2]];
        let here = self.rows[at];
        let derivatives = [0, 1].map(|i| {
            let slope = |from: Row, to: Row| {
                (to.direction[i] - from.direction[i]) / (to.time_s - from.time_s)
            };
            let (before, after) = (slope(a, b), slope(b, c));
            let bend = 2.0 * (after - before) / (c.time_s - a.time_s);
            let middle = before + bend * 0.5 * (b.time_s - a.time_s);
            [middle + bend * (here.time_s - b.time_s), bend]
        });
        let [[x_rate, x_bend], [y_rate, y_bend]] = derivatives;
        TimedPoint {
            time_s: here.time_s - self.first_s,
            derivatives: [here.direction, [x_rate, y_rate], [x_bend, y_bend]],
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
    pub fn new(rows: &[Row]) -> Self {
        let mut builder = PathBuilder::default();
        let mut points: Vec<_> = rows.iter().flat_map(|row| builder.push(*row)).collect();
        points.extend(builder.finish());
        Self { points }
    }

    /// The points of the path, after the rest from which a leg gets to its start.
    ///
    /// # Errors
    /// Why there is no such rest.
    pub fn with_run_up(&self, settings: &Settings) -> Result<Vec<TimedPoint>, PointRefusal> {
        let first = self.points.first().ok_or(PointRefusal::NoStream)?;
        let mut points = vec![run_up(first, settings)?];
        points.extend_from_slice(&self.points);
        Ok(points)
    }

    /// Its points.
    #[must_use]
    pub fn points(&self) -> &[TimedPoint] {
        &self.points
    }

    /// The direction, as horizontal components, and its rate at a time in s: the cubic between the points beside it; none
    /// before the first and after the last.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Option<[[f64; 2]; 2]> {
        let next = self.points.partition_point(|point| point.time_s < time_s);
        let (from, to) = (
            self.points.get(next.checked_sub(1)?)?,
            self.points.get(next)?,
        );
        let span_s = to.time_s - from.time_s;
        let part = (time_s - from.time_s) / span_s;
        let ([p, v, _], [q, w, _]) = (from.derivatives, to.derivatives);
        let at = [0, 1].map(|i| {
            let (d, v, w) = (q[i] - p[i], v[i] * span_s, w[i] * span_s);
            let (square, cube) = (3.0 * d - 2.0 * v - w, v + w - 2.0 * d);
            let position = p[i] + part * (v + part * (square + part * cube));
            let rate = (v + part * (2.0 * square + part * 3.0 * cube)) / span_s;
            [position, rate]
        });
        let [[x, x_rate], [y, y_rate]] = at;
        Some([[x, y], [x_rate, y_rate]])
    }
}

/// Where a leg has to rest before a moving start, so that it comes there within its limits: the way to rest from that start,
/// gone backwards.
///
/// # Errors
/// Why there is none.
pub fn run_up(first: &TimedPoint, settings: &Settings) -> Result<TimedPoint, PointRefusal> {
    let mut refusal = PointRefusal::OutOfReach;
    let mut time_s = RUN_UP_S[0];
    while time_s < RUN_UP_S[1] {
        match run_up_lasting(time_s, first, settings) {
            Ok(rest) => return Ok(rest),
            Err(error) => refusal = error,
        }
        time_s *= RUN_UP_LONGER;
    }
    Err(refusal)
}

fn run_up_lasting(
    time_s: f64,
    first: &TimedPoint,
    settings: &Settings,
) -> Result<TimedPoint, PointRefusal> {
    let limits = StreamLimits::<f32>::new(settings);
    let ticks = (time_s * f64::from(TICK_HZ)).round() as u32;
    let start = TimedPoint {
        time_s: 0.0,
        ..*first
    };
    let start = start.set_point(ticks, StreamPart::First);
    let backwards = SetPoint {
        rate: start.rate.map(|rate| -rate),
        ..start
    };
    let time_s = f64::from(ticks) / f64::from(TICK_HZ);
    let motion = limits.rest_after(&limits.motion(&backwards)?, time_s as f32);
    // In f32 the leg checks once more: the same path from the same rest.
    Stream::new(limits).begin(Knot { tick: 0, motion }, &start)?;
    let [x, y] = motion.position;
    let direction = HalfTangent::new(x, y).direction().vector();
    let rest = TimedPoint {
        time_s: first.time_s - time_s,
        derivatives: [
            [direction.x, direction.y].map(f64::from),
            [0.0; 2],
            [0.0; 2],
        ],
    };
    limits.motion(&rest.set_point(0, StreamPart::First))?;
    Ok(rest)
}

/// Whether a leg at rest at the first point may follow a path to its end.
///
/// # Errors
/// The point that is refused, counted from 0, and why.
pub fn check(points: &[TimedPoint], settings: &Settings) -> Result<(), (usize, PointRefusal)> {
    let mut stream = Stream::new(StreamLimits::<f32>::new(settings));
    let mut before = None;
    for (number, point) in points.iter().enumerate() {
        let set_point = point.set_point(u32::MAX / 2, StreamPart::Next);
        let taken = match before.replace(set_point.tick) {
            None => stream.limits.motion(&set_point).and_then(|motion| {
                let tick = set_point.tick.wrapping_sub(u32::from(TICK_HZ));
                stream.begin(Knot { tick, motion }, &set_point)
            }),
            Some(now) => stream.extend(now, &set_point).map(|()| {
                // Otherwise there is no room for the next.
                let _ = stream.next_segment();
            }),
        };
        taken.map_err(|refusal| (number, refusal))?;
    }
    Ok(())
}
