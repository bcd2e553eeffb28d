//! The control law in f64 on the same sensors, and how far the one in f32 gets from it.

use leg_firmware::drive::Drive;
use leg_firmware::host_link::BoardKind;
use leg_firmware::linked_leg::LinkedLeg;
use leg_firmware::recorder::Recorder;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::TickReply;
use leg_firmware_bench::server::emulated;
use serde::Serialize;

/// The control law in f64, beside a leg.
#[derive(Clone, Debug)]
pub struct Shadow {
    leg: LinkedLeg<f64>,
    /// What a host asks of it, it answers from here: nothing is recorded in f64.
    recorder: Box<Recorder>,
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
}

/// For so many ticks the two may differ in state or faults: rounded otherwise, a limit is passed a little sooner or later.
/// One that stays in another state has left it.
pub const OTHER_TICKS_MAX: u64 = 8;

impl Shadow {
    /// With a leg's settings, before its first tick.
    ///
    /// # Errors
    /// Settings that are refused.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        Ok(Self {
            leg: LinkedLeg::new(emulated(BoardKind::InProcess), settings)?,
            recorder: Box::default(),
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
    }
}

impl Divergence {
    /// Whether the two came to the same states and faults.
    #[must_use]
    pub const fn stays(&self) -> bool {
        self.stays_within(OTHER_TICKS_MAX)
    }

    /// The same with so many ticks in a row in which they may differ.
    #[must_use]
    pub const fn stays_within(&self, other_ticks: u64) -> bool {
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
