//! A smooth path from one motion to another: a polynomial of fifth degree in each coordinate.

use leg_model::Scalar;

/// Position, rate and its change, in two coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionState<T> {
    /// Position.
    pub position: [T; 2],
    /// Its change, 1/s.
    pub rate: [T; 2],
    /// The change of that, 1/s².
    pub acceleration: [T; 2],
}

impl<T: Scalar> MotionState<T> {
    /// At rest.
    pub fn resting(position: [T; 2]) -> Self {
        Self {
            position,
            rate: [T::zero(); 2],
            acceleration: [T::zero(); 2],
        }
    }

    /// Where the leg comes to rest from this motion, rate v and acceleration a, after a time T in s: by the rate
    /// (1 − s)³((1 + 3s)v + s·aT) at the part s of it, which never changes the sign of what either asks for, and ends without
    /// acceleration and jerk.
    pub fn rest_after(&self, time_s: T) -> Self {
        let coordinate = |i: usize| {
            let braked =
                T::from(0.4) * self.rate[i] + T::from(0.05) * time_s * self.acceleration[i];
            self.position[i] + time_s * braked
        };
        Self::resting([coordinate(0), coordinate(1)])
    }

    /// The acceleration that a cubic path from this motion has at `end`, where position and rate are given: the third
    /// derivative is then constant, and points of a smooth motion that are `time_s` apart give its acceleration to the second
    /// order.
    #[inline(always)]
    pub fn acceleration_at_end(&self, end: &Self, time_s: T) -> [T; 2] {
        let per_second = T::one() / time_s;
        let coordinate = |i: usize| {
            let mean = (end.position[i] - self.position[i]) * per_second;
            let rates = T::TWO * end.rate[i] + self.rate[i];
            T::TWO * (rates - T::from(3.0) * mean) * per_second
        };
        [coordinate(0), coordinate(1)]
    }
}

/// The path, over a time that goes from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quintic<T> {
    coefficients: [[T; 6]; 2],
    duration_s: T,
}

/// The largest rate, acceleration and jerk, or their squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks<T> {
    /// 1/s.
    pub rate: T,
    /// 1/s².
    pub acceleration: T,
    /// 1/s³.
    pub jerk: T,
}

impl<T: Scalar> Quintic<T> {
    /// From a motion to rest at `end` within a time in s.
    pub fn new(start: &MotionState<T>, end: [T; 2], duration_s: T) -> Self {
        let number = |value: f32| T::from(value);
        let coordinate = |i: usize| {
            let distance = end[i] - start.position[i];
            let rate = start.rate[i] * duration_s;
            let half = T::HALF * start.acceleration[i] * duration_s * duration_s;
            [
                start.position[i],
                rate,
                half,
                number(10.0) * distance - number(6.0) * rate - number(3.0) * half,
                number(8.0) * rate + number(3.0) * half - number(15.0) * distance,
                number(6.0) * distance - number(3.0) * rate - half,
            ]
        };
        Self {
            coefficients: [coordinate(0), coordinate(1)],
            duration_s,
        }
    }

    /// From one motion to another within a time in s.
    pub fn connect(start: &MotionState<T>, end: &MotionState<T>, duration_s: T) -> Self {
        let mut path = Self::new(start, end.position, duration_s);
        for (i, coefficients) in path.coefficients.iter_mut().enumerate() {
            let rate = end.rate[i] * duration_s;
            let half = T::HALF * end.acceleration[i] * duration_s * duration_s;
            let [_, _, _, c3, c4, c5] = coefficients;
            *c3 += half - T::from(4.0) * rate;
            *c4 += T::from(7.0) * rate - T::TWO * half;
            *c5 += half - T::from(3.0) * rate;
        }
        path
    }

    /// The control points of its Bézier form, for each coordinate: the path and its derivatives stay within the convex hulls
    /// of theirs.
    #[inline(always)]
    pub fn control_points(&self) -> [[T; 6]; 2] {
        let part = |share: f32| T::from(share);
        self.coefficients.map(|[c0, c1, c2, c3, c4, c5]| {
            [
                c0,
                c0 + part(0.2) * c1,
                c0 + part(0.4) * c1 + part(0.1) * c2,
                c0 + part(0.6) * c1 + part(0.3) * c2 + part(0.1) * c3,
                c0 + part(0.8) * c1 + part(0.6) * c2 + part(0.4) * c3 + part(0.2) * c4,
                c0 + c1 + c2 + c3 + c4 + c5,
            ]
        })
    }

    /// The control points that differ where it leads to rest, as points: the last three are one.
    #[inline(always)]
    pub fn hull_to_rest(&self) -> [[T; 2]; 4] {
        let [x, y] = self.control_points();
        [0, 1, 2, 5].map(|i| [x[i], y[i]])
    }

    /// Its time, s.
    #[inline(always)]
    pub fn duration_s(&self) -> T {
        self.duration_s
    }

    /// The position at a part of the time.
    #[inline(always)]
    pub fn position(&self, part: T) -> [T; 2] {
        self.coefficients.map(|[c0, c1, c2, c3, c4, c5]| {
            c0 + part * (c1 + part * (c2 + part * (c3 + part * (c4 + part * c5))))
        })
    }

    /// Position, rate and acceleration at a part of the time, by dividing the polynomial three times by its distance from there: the
    /// remainders are position, slope and half of the bend.
    #[inline(always)]
    pub fn motion(&self, part: T) -> MotionState<T> {
        let per_second = T::one() / self.duration_s;
        let bend_per_s2 = T::TWO * per_second * per_second;
        let coordinate = |[c0, c1, c2, c3, c4, c5]: [T; 6]| {
            let first4 = c4 + part * c5;
            let first3 = c3 + part * first4;
            let first2 = c2 + part * first3;
            let first1 = c1 + part * first2;
            let position = c0 + part * first1;
            let second4 = first4 + part * c5;
            let second3 = first3 + part * second4;
            let second2 = first2 + part * second3;
            let slope = first1 + part * second2;
            let third4 = second4 + part * c5;
            let third3 = second3 + part * third4;
            let half_bend = second2 + part * third3;
            (position, slope * per_second, half_bend * bend_per_s2)
        };
        let [(x, x_rate, x_acceleration), (y, y_rate, y_acceleration)] =
            self.coefficients.map(coordinate);
        MotionState {
            position: [x, y],
            rate: [x_rate, y_rate],
            acceleration: [x_acceleration, y_acceleration],
        }
    }

    /// The squares of rate, acceleration and jerk at a part of the time.
    #[inline(always)]
    pub fn squares(&self, part: T) -> Peaks<T> {
        let motion = self.motion(part);
        let per_second = T::one() / self.duration_s;
        let number = |value: f32| T::from(value);
        let jerk = self.coefficients.map(|[_, _, _, c3, c4, c5]| {
            let third = number(6.0) * c3 + part * (number(24.0) * c4 + part * number(60.0) * c5);
            third * per_second * per_second * per_second
        });
        let square = |[x, y]: [T; 2]| x * x + y * y;
        Peaks {
            rate: square(motion.rate),
            acceleration: square(motion.acceleration),
            jerk: square(jerk),
        }
    }
}

#[cfg(test)]
mod tests;
