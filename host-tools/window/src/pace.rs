//! How many ticks of the leg a frame of the window is worth.

use leg_firmware::sensors::TICK_HZ;

/// The longest time that one frame makes up for, s. A window that was hidden, or is too slow, leaves the rest out.
const FRAME_MAX_S: f64 = 0.25;

/// Follows the clock, tick by tick.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Time of the leg in a second of the clock; 0 stands still.
    pub rate: f64,
    /// What is less than a tick, and left for the next frame, ticks.
    rest: f64,
    /// Time of the leg that was left out since the start, s.
    left_out_s: f64,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            rate: 1.0,
            rest: 0.0,
            left_out_s: 0.0,
        }
    }
}

impl Pace {
    /// The ticks of a frame that came so long after the one before it.
    pub fn ticks(&mut self, elapsed_s: f64) -> u32 {
        if !elapsed_s.is_finite() || elapsed_s <= 0.0 {
            return 0;
        }
        let taken_s = elapsed_s.min(FRAME_MAX_S);
        self.left_out_s += (elapsed_s - taken_s) * self.rate;
        let ticks = self.rest + taken_s * self.rate * f64::from(TICK_HZ);
        self.rest = ticks.fract();
        // At most those of FRAME_MAX_S, times the rate.
        ticks.floor() as u32
    }

    /// Time of the leg that was left out since the start, s: the window was hidden or too slow.
    #[must_use]
    pub const fn left_out_s(&self) -> f64 {
        self.left_out_s
    }
}

#[cfg(test)]
mod tests {
    use super::Pace;

    #[test]
    fn no_tick_is_lost_between_frames() {
        let mut pace = Pace::default();
        let ticks: u32 = (0..600).map(|_| pace.ticks(1.0 / 60.0)).sum();
        assert!((79_999..=80_000).contains(&ticks), "{ticks}");
        assert!(pace.left_out_s() < 1e-12);
    }

    #[test]
    fn a_frame_that_came_late_is_bounded() {
        let mut pace = Pace::default();
        assert_eq!(pace.ticks(60.0), 2000);
        assert!((pace.left_out_s() - 59.75).abs() < 1e-9);
    }

    #[test]
    fn a_fast_leg_ticks_so_much_more_often() {
        let mut pace = Pace {
            rate: 8.0,
            ..Pace::default()
        };
        let ticks: u32 = (0..60).map(|_| pace.ticks(1.0 / 60.0)).sum();
        assert!((63_999..=64_000).contains(&ticks), "{ticks}");
        // A frame that came late makes up for as much of the clock's time as one of a leg in real time.
        assert_eq!(pace.ticks(1.0), 16_000);
        assert!((pace.left_out_s() - 6.0).abs() < 1e-9);
    }

    #[test]
    fn a_slow_leg_ticks_seldom_and_a_stopped_one_never() {
        let mut pace = Pace {
            rate: 0.1,
            ..Pace::default()
        };
        let ticks: u32 = (0..60).map(|_| pace.ticks(1.0 / 60.0)).sum();
        assert!((799..=800).contains(&ticks), "{ticks}");
        pace.ticks(10.25);
        assert!((pace.left_out_s() - 1.0).abs() < 1e-9);
        pace.rate = 0.0;
        assert_eq!(pace.ticks(60.0), 0);
        assert!((pace.left_out_s() - 1.0).abs() < 1e-9);
        assert_eq!(pace.ticks(f64::NAN), 0);
        assert_eq!(pace.ticks(-1.0), 0);
    }
}
