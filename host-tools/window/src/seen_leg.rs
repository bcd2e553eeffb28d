//! A leg at a time, as it is drawn and shown in numbers: it may be there, or recorded.

use crate::simulation::Push;
use leg_firmware::supervisor::{Fault, FaultSet};
use leg_firmware::telemetry::Telemetry;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

/// The faults in which what the leg concludes from its sensors may be wrong: a tendon, a load cell or an encoder may have failed.
const DOUBTS: FaultSet = FaultSet::OF_CELLS
    .union(FaultSet::SUSPECT_COUNTERS)
    .union(FaultSet::single(Fault::CurrentDisagrees))
    .union(FaultSet::single(Fault::PoseLost));

/// It.
pub struct SeenLeg<'a> {
    /// Its settings.
    pub rig: &'a RigFile,
    /// What it reported last.
    pub telemetry: Option<Telemetry<f32>>,
    /// Whether it is drawn as it truly is; else as its sensors have it.
    pub is_true: bool,
    /// Whether what it reported last still holds.
    pub is_heard: bool,
    /// Along it, from the joint to the tip.
    pub leg_axis: Vector3<f64>,
    /// Where its trajectory has it.
    pub reference: Vector3<f64>,
    /// Where it was sent, as horizontal components.
    pub target: [f64; 2],
    /// How far it is twisted about itself, rad.
    pub torsion_rad: f64,
    /// The tensions as they are drawn, N.
    pub tensions_n: [f64; 3],
    /// What hangs on the tip, kg, if that is known.
    pub hung_kg: Option<f64>,
    /// The tendons that are cut.
    pub cut: [bool; 3],
    /// The push that is going on.
    pub push: Option<Push>,
    /// Distance of the tip, as it is drawn, from where it was sent, mm.
    pub error_mm: f64,
}

/// The unit vector along a leg with these horizontal components.
#[must_use]
pub fn leg_axis([x, y]: [f64; 2]) -> Vector3<f64> {
    Vector3::new(x, y, -(1.0 - x * x - y * y).max(0.0).sqrt())
}

impl SeenLeg<'_> {
    /// From the joint's centre to the tip, m.
    #[must_use]
    pub fn tip_length_m(&self) -> f64 {
        self.rig.parameters.joint_length_m + self.rig.parameters.leg_length_m
    }

    /// Where its tip was sent, m.
    #[must_use]
    pub fn commanded_m(&self) -> Vector3<f64> {
        leg_axis(self.target) * self.tip_length_m()
    }

    /// Why what it concludes from its sensors is not to be trusted; none if nothing speaks against it.
    #[must_use]
    pub fn doubt(&self) -> Option<&'static str> {
        let telemetry = self.telemetry.as_ref()?;
        if self.cut.contains(&true) || telemetry.faults.overlaps(DOUBTS) {
            Some("not to be trusted")
        } else if !telemetry.homed {
            Some("not homed")
        } else {
            None
        }
    }

    /// Where the tensions are from, in a word.
    #[must_use]
    pub const fn tensions_source(&self) -> &'static str {
        if self.is_true { "true" } else { "measured" }
    }
}
