//! Whether the host still sends.

use crate::control::ticks;
use crate::settings::Limits;
use crate::supervisor::{Fault, FaultSet};

/// Watches the host's line: its silence and the frames that could not be decoded.
#[derive(Clone, Copy, Debug)]
pub struct LinkWatch {
    silent_ticks: u32,
    silent_ticks_max: u32,
    bad_frames: u16,
    bad_frames_max: u16,
}

impl LinkWatch {
    /// With the limits of the settings.
    pub fn new(limits: &Limits) -> Self {
        Self {
            silent_ticks: 0,
            silent_ticks_max: ticks(limits.command_time_s),
            bad_frames: 0,
            bad_frames_max: ceiling(limits.bad_frames),
        }
    }

    /// A command has come.
    pub fn heard(&mut self) {
        self.silent_ticks = 0;
        self.bad_frames = 0;
    }

    /// A frame could not be decoded.
    pub fn note_decode_error(&mut self) {
        self.bad_frames = self.bad_frames.saturating_add(1);
    }

    /// The silence counts from now on.
    pub fn restart_silence(&mut self) {
        self.silent_ticks = 0;
    }

    /// No frame counts as bad any more.
    pub fn clear_bad_frames(&mut self) {
        self.bad_frames = 0;
    }

    /// One tick: what is wrong with the line. Silence counts only while the leg follows its host.
    #[inline(always)]
    pub fn step(&mut self, follows: bool) -> FaultSet {
        self.silent_ticks = if follows {
            self.silent_ticks.saturating_add(1)
        } else {
            0
        };
        let mut faults = FaultSet::NONE;
        faults.add(
            Fault::CommandTimeout,
            self.silent_ticks > self.silent_ticks_max,
        );
        faults.add(Fault::BadFrame, self.bad_frames >= self.bad_frames_max);
        faults
    }
}

/// The first whole number that is not below.
fn ceiling(number: f32) -> u16 {
    let whole = number as u16;
    whole.saturating_add(u16::from(f32::from(whole) < number))
}

#[cfg(test)]
mod tests {
    use super::LinkWatch;
    use crate::settings::Limits;
    use crate::supervisor::{Fault, FaultSet};

    fn bad_frames_until_a_fault(watch: &mut LinkWatch) -> usize {
        let fault = FaultSet::single(Fault::BadFrame);
        let mut count = 0;
        while watch.step(true) != fault {
            watch.note_decode_error();
            count += 1;
        }
        count
    }

    #[test]
    fn bad_frames_count_anew_from_a_good_one_and_from_a_clear() {
        let limits = Limits::DEFAULT;
        for bad_frames in [1.0, 2.5, 3.0] {
            let mut watch = LinkWatch::new(&Limits {
                bad_frames,
                ..limits
            });
            let expected = bad_frames.ceil() as usize;
            assert_eq!(bad_frames_until_a_fault(&mut watch), expected);
            watch.clear_bad_frames();
            assert_eq!(bad_frames_until_a_fault(&mut watch), expected);
            watch.heard();
            assert_eq!(bad_frames_until_a_fault(&mut watch), expected);
        }
    }
}
