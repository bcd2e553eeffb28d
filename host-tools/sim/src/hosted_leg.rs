//! An emulated leg with its host: what is commanded, what the firmware answers, and what has become of the leg after each
//! tick. A scenario runs on one, and so does a program that steps a leg itself.

mod comparison;

pub use comparison::Comparison;

use crate::emulated_leg::{EmulatedLeg, EmulationError};
use crate::host::{Answer, Host};
use crate::link::{InProcess, Link};
use crate::plant::Truth;
use leg_firmware::command::Command;
use leg_firmware::frame::FrameError;
use leg_firmware::host_link::{HostReply, HostRequest};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::protocol::{TickReply, TickRequest};
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

/// The leg, its host, and what was seen of them last.
#[derive(Clone)]
pub struct HostedLeg<L = InProcess> {
    leg: EmulatedLeg<L>,
    host: Host,
    truth: Truth,
    telemetry: Option<Telemetry<f32>>,
    /// Where the host has sent the leg, as horizontal components; none after a hold.
    commanded: Option<[f64; 2]>,
    tip_length_m: f64,
    ticks: u64,
}

impl<L: Link> HostedLeg<L> {
    /// A leg that has not had its first tick, and a host whose random bytes follow from a seed. `commanded` is where the leg
    /// starts, as horizontal components.
    #[must_use]
    pub fn new(leg: EmulatedLeg<L>, rig: &RigFile, commanded: [f64; 2], seed: u64) -> Self {
        let parameters = &rig.parameters;
        Self {
            truth: leg.plant().truth(),
            leg,
            host: Host::new(seed),
            telemetry: None,
            commanded: Some(commanded),
            tip_length_m: parameters.joint_length_m + parameters.leg_length_m,
            ticks: 0,
        }
    }

    /// One tick of host, firmware and leg. Gives what the firmware took, and what it made of it.
    ///
    /// # Errors
    /// [`EmulationError::NotFinite`] if a number of the leg is lost; a link that fails.
    pub fn tick(&mut self) -> Result<(TickRequest, TickReply), EmulationError> {
        let time_s = self.time_s();
        let link = self.host.outgoing(self.ticks);
        let (taken, reply) = self.leg.advance(link)?;
        self.host.receive(&reply.link);
        let truth = self.leg.plant().truth();
        if !truth.is_finite() {
            return Err(EmulationError::NotFinite(time_s));
        }
        self.truth = truth;
        self.telemetry = Some(reply.telemetry);
        self.ticks += 1;
        Ok((taken, reply))
    }

    /// Sends a command, which reaches the leg in the next tick, and notes where it sends the leg. Gives the number of its
    /// [`Answer`].
    ///
    /// # Errors
    /// A command that fits into no frame.
    pub fn send(&mut self, command: &Command) -> Result<u16, FrameError> {
        match *command {
            Command::Move { x, y } => self.commanded = Some([x, y].map(f64::from)),
            Command::Home => self.commanded = Some([0.0; 2]),
            Command::Hold | Command::Stop => self.commanded = None,
            _ => {}
        }
        self.host.send(command)
    }

    /// What the leg answered in the last tick.
    #[must_use]
    pub fn answers(&self) -> &[Answer] {
        self.host.answers()
    }

    /// Asks the leg for something, which reaches it in the next tick, and gives the number of the reply.
    ///
    /// # Errors
    /// A request that fits into no frame.
    pub fn ask(&mut self, request: &HostRequest) -> Result<u16, FrameError> {
        self.host.ask(request)
    }

    /// What it replied in the last tick, with the requests' numbers.
    #[must_use]
    pub fn replies(&self) -> &[(u16, HostReply)] {
        self.host.replies()
    }

    /// Where the leg is commanded to be at this time, as horizontal components: where a streamed path has it. None is where
    /// the leg itself takes its target to be.
    pub fn set_commanded(&mut self, direction: Option<[f64; 2]>) {
        self.commanded = direction;
    }

    /// Time since the start, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.leg.plant().time_s()
    }

    /// Ticks since the start.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    /// What the leg may do.
    #[must_use]
    pub fn state(&self) -> State {
        self.telemetry
            .map_or(State::Boot, |telemetry| telemetry.state)
    }

    /// What it reported after the last tick; none before the first.
    #[must_use]
    pub fn telemetry(&self) -> Option<&Telemetry<f32>> {
        self.telemetry.as_ref()
    }

    /// How it really is after the last tick.
    #[must_use]
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// The leg without its host.
    #[must_use]
    pub fn leg(&self) -> &EmulatedLeg<L> {
        &self.leg
    }

    /// The leg, for what is done to it from outside.
    pub fn leg_mut(&mut self) -> &mut EmulatedLeg<L> {
        &mut self.leg
    }

    /// The host, for what can be wrong with one.
    pub fn host_mut(&mut self) -> &mut Host {
        &mut self.host
    }

    /// The leg beside what it reports, as the next tick finds them. Of a path it knows nothing.
    #[must_use]
    pub fn comparison(&self) -> Comparison {
        let pose = self.telemetry.map_or([0.0; 2], |telemetry| telemetry.pose);
        let mm = |tip_m: Vector3<f64>| (tip_m * 1000.0).into();
        Comparison {
            tip_commanded_mm: mm(self.commanded_m()),
            tip_reference_mm: mm(self.target_m()),
            tip_estimated_mm: mm(self.tip_m(pose.map(f64::from))),
            tip_true_mm: mm(self.truth.tip_m),
            tensions_true_n: self.truth.tensions_n,
            payload_true_kg: self.truth.payload_kg,
            path_error_mm: None,
        }
    }

    /// Where the trajectory has the tip now, m.
    fn target_m(&self) -> Vector3<f64> {
        self.tip_m(
            self.telemetry
                .map_or([0.0; 2], |telemetry| telemetry.target.map(f64::from)),
        )
    }

    /// Where the host has sent the tip, m: whatever the leg itself takes for its target.
    #[must_use]
    pub fn commanded_m(&self) -> Vector3<f64> {
        self.commanded
            .map_or_else(|| self.target_m(), |direction| self.tip_m(direction))
    }

    /// The tip of a leg with a direction, m.
    #[must_use]
    pub fn tip_m(&self, [x, y]: [f64; 2]) -> Vector3<f64> {
        let z = -(1.0 - x * x - y * y).max(0.0).sqrt();
        Vector3::new(x, y, z) * self.tip_length_m
    }

    /// From the joint centre to the tip, m.
    #[must_use]
    pub fn tip_length_m(&self) -> f64 {
        self.tip_length_m
    }
}
