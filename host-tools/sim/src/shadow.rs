//! The control law in f64 on the same sensors, and how far the one in f32 gets from it.

use leg_firmware::drive::Drive;
use leg_firmware::frame::Decoder;
use leg_firmware::host_link::{BoardKind, HostReply};
use leg_firmware::linked_leg::LinkedLeg;
use leg_firmware::recorder::Recorder;
use leg_firmware::sensors::{Sensors, TICK_HZ};
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::TickReply;
use leg_firmware_bench::server::emulated;
use serde::Serialize;
use std::collections::VecDeque;

/// The control law in f64, beside a leg.
#[derive(Clone, Debug)]
pub struct Shadow {
    leg: LinkedLeg<f64>,
    /// What a host asks of it, it answers from here: nothing is recorded in f64.
    recorder: Box<Recorder>,
    /// What the leg and the shadow answered a host.
    answers: [Answers; 2],
    /// How far the leg got from it.
    pub divergence: Divergence,
}

/// The largest differences over all ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Divergence {
    /// Of a duty.
    pub duty: f64,
    /// Of where a tendon shall be pulled to, m.
    pub reference_m: f64,
    /// Of the estimated pose, as a component of the direction.
    pub pose: f64,
    /// Ticks at which the two were not in the same state or had other faults.
    pub other_state: u64,
    /// The first of them: the differences above are of the other ticks alone.
    pub first_other_tick: Option<u32>,
    /// The most of them in a row.
    pub longest_other_ticks: u64,
    /// Those in a row up to now.
    #[serde(skip)]
    other_ticks: u64,
    /// Requests of a host that one of the two did and the other refused: a set-point at a limit, which is rounded otherwise. From then on they
    /// are led otherwise. And those that one of the two alone has answered, a second after it.
    #[serde(skip)]
    pub other_answers: u64,
}

/// Whether each request was done, in their order, until the other one has answered it, too.
#[derive(Clone, Debug)]
struct Answers {
    decoder: Decoder,
    waiting: VecDeque<(u16, bool)>,
    /// Ticks since the other one has answered as much.
    ticks: u16,
}

/// For so many ticks the two may differ in state or faults: rounded otherwise, a limit is passed a little sooner or later.
/// One that stays in another state has left it.
pub const OTHER_TICKS_MAX: u64 = 8;

/// Ticks for which an answer of one of the two may come alone: a second, in which a link of any board has given what waits.
const ANSWERED_TICKS: u16 = TICK_HZ;

impl Shadow {
    /// With a leg's settings, before its first tick.
    ///
    /// # Errors
    /// Settings that are refused.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        Ok(Self {
            leg: LinkedLeg::new(emulated(BoardKind::InProcess), settings)?,
            recorder: Box::default(),
            answers: Default::default(),
            divergence: Divergence::default(),
        })
    }

    /// The same tick. It then takes over the drive in f32, so that the differences do not add up.
    pub fn tick(&mut self, sensors: &Sensors, link: &[u8], reply: &TickReply) {
        self.leg.receive(link, &mut self.recorder);
        let leg = self.leg.leg();
        let drive = leg.tick(sensors);
        self.divergence.compare(reply, &drive, &leg.telemetry());
        leg.adopt_drive(&Drive {
            duty: reply.drive.duty.map(f64::from),
            enabled: reply.drive.enabled,
        });
        let sent = self.leg.sent(&mut self.recorder, |_| true);
        let [answered, shadow] = &mut self.answers;
        answered.take(&reply.link);
        shadow.take(&sent);
        self.divergence.other_answers += answered.compare(shadow);
    }
}

impl Default for Answers {
    fn default() -> Self {
        Self {
            decoder: Decoder::new(),
            waiting: VecDeque::new(),
            ticks: 0,
        }
    }
}

impl Answers {
    fn take(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let Some(Ok(frame)) = self.decoder.push(*byte) else {
                continue;
            };
            match frame.message() {
                Some(HostReply::Done) => self.waiting.push_back((frame.sequence, true)),
                Some(HostReply::Refused(_)) => self.waiting.push_back((frame.sequence, false)),
                _ => {}
            }
        }
    }

    /// A tick: forgets what both have answered, and gives how many of them otherwise, with those that one alone has answered.
    fn compare(&mut self, other: &mut Self) -> u64 {
        let both = self.waiting.len().min(other.waiting.len());
        let pairs = self.waiting.drain(..both).zip(other.waiting.drain(..both));
        let otherwise = pairs.filter(|(one, other)| one != other).count();
        if both > 0 {
            (self.ticks, other.ticks) = (0, 0);
        }
        (otherwise + self.take_unanswered() + other.take_unanswered()) as u64
    }

    /// Forgets what the other one has not answered in time, and gives how many of them.
    fn take_unanswered(&mut self) -> usize {
        self.ticks = if self.waiting.is_empty() {
            0
        } else {
            self.ticks + 1
        };
        if self.ticks <= ANSWERED_TICKS {
            return 0;
        }
        self.ticks = 0;
        self.waiting.drain(..).count()
    }
}

impl Divergence {
    /// Whether the two came to the same states and faults, and answered alike.
    #[must_use]
    pub const fn stays(&self) -> bool {
        self.stays_within(OTHER_TICKS_MAX)
    }

    /// The same with so many ticks in a row in which they may be in another state or have other faults.
    #[must_use]
    pub const fn stays_within(&self, other_ticks: u64) -> bool {
        self.other_answers == 0 && self.states_stay_within(other_ticks)
    }

    /// The same, whatever they answer: of a run that ends with the first request which one of the two refuses.
    #[must_use]
    pub const fn states_stay_within(&self, other_ticks: u64) -> bool {
        self.longest_other_ticks <= other_ticks
    }

    fn compare(&mut self, reply: &TickReply, shadow: &Drive<f64>, reported: &Telemetry<f64>) {
        let (drive, telemetry) = (&reply.drive, &reply.telemetry);
        if telemetry.state != reported.state || telemetry.faults != reported.faults {
            self.other_state += 1;
            self.other_ticks += 1;
            self.longest_other_ticks = self.longest_other_ticks.max(self.other_ticks);
            self.first_other_tick.get_or_insert(telemetry.tick);
            return;
        }
        self.other_ticks = 0;
        for (largest, difference) in [
            (&mut self.duty, largest(&drive.duty, &shadow.duty)),
            (
                &mut self.reference_m,
                largest(&telemetry.reference_m, &reported.reference_m),
            ),
            (&mut self.pose, largest(&telemetry.pose, &reported.pose)),
        ] {
            *largest = largest.max(difference);
        }
    }
}

fn largest<const N: usize>(single: &[f32; N], double: &[f64; N]) -> f64 {
    let pairs = single.iter().zip(double);
    pairs
        .map(|(single, double)| (f64::from(*single) - double).abs())
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::{ANSWERED_TICKS, Answers};

    /// Counts what is answered otherwise in some ticks.
    fn otherwise(one: &mut Answers, other: &mut Answers, ticks: u16) -> u64 {
        (0..ticks).map(|_| one.compare(other)).sum()
    }

    /// Answers are compared in their order, however late one of the two comes; one that never comes counts, whichever of them lacks it.
    #[test]
    fn an_answer_that_the_other_does_not_give_counts() {
        for swapped in [false, true] {
            let [mut one, mut other] = <[Answers; 2]>::default();
            let mut count = |answers: [Option<(u16, bool)>; 2], ticks| {
                one.waiting.extend(answers[0]);
                other.waiting.extend(answers[1]);
                if swapped {
                    otherwise(&mut other, &mut one, ticks)
                } else {
                    otherwise(&mut one, &mut other, ticks)
                }
            };
            assert_eq!(count([Some((1, true)), None], ANSWERED_TICKS), 0);
            assert_eq!(count([None, Some((1, true))], ANSWERED_TICKS + 1), 0);
            assert_eq!(count([Some((2, true)), Some((2, false))], 1), 1);
            // One of the two may be late all the time.
            for number in 10..14 {
                let late = (number > 10).then_some((number - 1, true));
                let answers = [Some((number, true)), late];
                assert_eq!(count(answers, ANSWERED_TICKS), 0);
            }
            assert_eq!(count([None, Some((13, true))], 1), 0);
            assert_eq!(count([Some((3, true)), None], ANSWERED_TICKS), 0);
            assert_eq!(count([None, None], 1), 1);
            assert_eq!(count([None, None], ANSWERED_TICKS + 1), 0);
        }
    }
}
