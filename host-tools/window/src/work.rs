//! How long the window works for a frame: the leg's ticks, and everything that is laid out. What draws it comes after that, a
//! graphics card or the processor in its place, and is not of the window.

use serde::Serialize;
use std::collections::VecDeque;
use std::time::Duration;

/// Frames that are looked at: two seconds of 60.
const FRAMES: usize = 120;

/// The times of the last frames.
#[derive(Clone, Debug, Default)]
pub struct Work {
    /// Of the leg in the present frame, ms.
    leg_ms: f64,
    /// All of it, and what of it was the leg's, ms.
    frames: VecDeque<[f64; 2]>,
}

/// The same in few numbers, ms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WorkSummary {
    /// Half of the frames took less.
    pub median_ms: f64,
    /// The longest one.
    pub most_ms: f64,
    /// The median of what the leg's ticks took.
    pub leg_median_ms: f64,
}

fn ms(time: Duration) -> f64 {
    1000.0 * time.as_secs_f64()
}

/// Half of the numbers are below it.
pub(crate) fn median(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or_default()
}

impl Work {
    /// Notes what the leg's ticks took in this frame.
    pub fn note_leg(&mut self, time: Duration) {
        self.leg_ms = ms(time);
    }

    /// What the leg's ticks took in the present frame, ms.
    #[must_use]
    pub const fn leg_ms(&self) -> f64 {
        self.leg_ms
    }

    /// Notes what the frame took, its ticks included.
    pub fn note_frame(&mut self, time: Duration) {
        if self.frames.len() == FRAMES {
            self.frames.pop_front();
        }
        self.frames.push_back([ms(time), self.leg_ms]);
    }

    /// The last frames; none before the first.
    #[must_use]
    pub fn summary(&self) -> Option<WorkSummary> {
        let all = || self.frames.iter().map(|[frame_ms, _]| *frame_ms);
        Some(WorkSummary {
            most_ms: all().reduce(f64::max)?,
            median_ms: median(all()),
            leg_median_ms: median(self.frames.iter().map(|[_, leg_ms]| *leg_ms)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{FRAMES, Work, WorkSummary};
    use std::time::Duration;

    #[test]
    fn the_last_frames_are_summed_up() {
        let mut work = Work::default();
        assert_eq!(work.summary(), None);
        for number in 0..2 * FRAMES as u64 {
            let slow = if number.is_multiple_of(10) { 20 } else { 4 };
            work.note_leg(Duration::from_millis(if number < FRAMES as u64 {
                9
            } else {
                1
            }));
            work.note_frame(Duration::from_millis(slow));
        }
        let expected = WorkSummary {
            median_ms: 4.0,
            most_ms: 20.0,
            leg_median_ms: 1.0,
        };
        assert_eq!(work.summary(), Some(expected));
    }
}
