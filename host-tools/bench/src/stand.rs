//! An emulated leg with its host, which can be cloned.

use leg_base::angles;
use leg_firmware::command::Command;
use leg_firmware::drive::Drive;
use leg_firmware::sensors::Sensors;
use leg_firmware::supervisor::{FaultSet, State};
use leg_firmware::telemetry::Telemetry;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, SignalChange};
use leg_sim::host::Host;
use leg_sim::link::InProcess;
use leg_sim::plant::{Plant, Start, Truth};
use leg_sim::shadow::{OTHER_TICKS_MAX, Shadow};

/// How little a leg moves that has come to rest, m, in how many ticks; and how often that is awaited.
const STILL_M: f64 = 5e-5;
const STILL_TICKS: u32 = 4_000;
const STILL_SPANS: u32 = 80;

/// An emulated leg, its host, and what was seen last.
#[derive(Clone)]
pub struct Stand {
    leg: EmulatedLeg<InProcess>,
    /// The control law in f64 beside it.
    shadow: Shadow,
    /// For how many ticks in a row that may be in another state or have other faults before a tick fails; none where that is looked at later.
    other_ticks: Option<u64>,
    host: Host,
    ticks: u64,
    /// What is true after the last tick.
    pub truth: Truth,
    /// What the leg reported in it; none before the first.
    pub telemetry: Option<Telemetry<f32>>,
    /// What the sensors read in it.
    pub sensors: Sensors,
    /// What the motors get.
    pub motors: Drive<f32>,
}

impl Stand {
    /// A leg that has just started. Its ticks fail once the control law in f64 beside it has been in another state, or had other faults,
    /// for more than [`OTHER_TICKS_MAX`] in a row, or has answered the host otherwise.
    ///
    /// # Errors
    /// Settings or a start that are refused, as all errors here in words.
    pub fn new(
        rig: &RigFile,
        plant: &PlantSettings,
        start: Start,
        seed: u64,
    ) -> Result<Self, String> {
        let unjudged = Self::unjudged(rig, plant, start, seed)?;
        Ok(Self {
            other_ticks: Some(OTHER_TICKS_MAX),
            ..unjudged
        })
    }

    fn started((leg, shadow): (EmulatedLeg<InProcess>, Shadow), seed: u64) -> Self {
        Self {
            truth: leg.plant().truth(),
            leg,
            shadow,
            other_ticks: None,
            host: Host::new(seed),
            ticks: 0,
            telemetry: None,
            sensors: Sensors::default(),
            motors: Drive {
                duty: [0.0; 3],
                enabled: false,
            },
        }
    }

    /// The same, but no tick fails for the control law in f64: [`Self::require_shadow`] tells how far apart they were.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn unjudged(
        rig: &RigFile,
        plant: &PlantSettings,
        start: Start,
        seed: u64,
    ) -> Result<Self, String> {
        let both = EmulatedLeg::start_shadowed(rig, plant, start, seed);
        let both = both.map_err(|error| error.to_string())?;
        Ok(Self::started(both, seed))
    }

    /// # Errors
    /// The control law in f64 was in another state, or had other faults, for more than so many ticks in a row, or refused what the firmware did.
    pub fn require_shadow(&self, other_ticks: u64) -> Result<(), String> {
        let divergence = &self.shadow.divergence;
        if divergence.stays_within(other_ticks) {
            return Ok(());
        }
        if divergence.states_stay_within(other_ticks) {
            return Err(format!(
                "the firmware answers its host otherwise than its shadow in f64, {} times",
                divergence.other_answers
            ));
        }
        Err(format!(
            "the firmware leaves the state of its shadow in f64, first at tick {}",
            divergence.first_other_tick.unwrap_or_default()
        ))
    }

    /// The simulated leg.
    pub fn plant(&mut self) -> &mut Plant {
        self.leg.plant_mut()
    }

    /// Time since the start, s.
    pub fn time_s(&self) -> f64 {
        self.leg.plant().time_s()
    }

    /// What the leg may do.
    pub fn state(&self) -> State {
        self.telemetry
            .map_or(State::Boot, |telemetry| telemetry.state)
    }

    /// Faults beyond limits.
    pub fn faults(&self) -> FaultSet {
        let faults = self.telemetry.map(|telemetry| telemetry.faults);
        faults.map_or(FaultSet::NONE, FaultSet::stopping)
    }

    /// Whether it is on its way.
    pub fn moving(&self) -> bool {
        self.telemetry.is_some_and(|telemetry| telemetry.moving)
    }

    /// Sends a command.
    ///
    /// # Errors
    /// One that cannot be sent.
    pub fn command(&mut self, command: &Command) -> Result<(), String> {
        let sent = self.host.send(command).map(|_| ());
        sent.map_err(|error| error.to_string())
    }

    /// The host sends nothing any more but commands.
    pub fn silence(&mut self) {
        self.host.silent = true;
    }

    /// One tick.
    ///
    /// # Errors
    /// A link that fails; a number of the simulated leg that is lost; a shadow that is left, see [`Self::new`].
    pub fn tick(&mut self) -> Result<(), String> {
        self.tick_through(&mut ())
    }

    /// One tick with changed signals.
    ///
    /// # Errors
    /// As [`Self::tick`].
    pub fn tick_through(&mut self, change: &mut impl SignalChange) -> Result<(), String> {
        let bytes = self.host.outgoing(self.ticks);
        let advanced = self.leg.advance_through(change, bytes);
        let (taken, reply) = advanced.map_err(|error| error.to_string())?;
        self.ticks += 1;
        self.shadow.tick(&taken.sensors, &taken.link, &reply);
        self.truth = self.leg.plant().truth();
        self.telemetry = Some(reply.telemetry);
        self.sensors = taken.sensors;
        self.motors = reply.motors;
        if !self.truth.is_finite() {
            return Err("a number of the simulated leg is lost".into());
        }
        let judged = self.other_ticks;
        judged.map_or(Ok(()), |other_ticks| self.require_shadow(other_ticks))
    }

    /// # Errors
    /// The faults that there are.
    pub fn require_no_fault(&self) -> Result<(), String> {
        if !self.faults().any() {
            return Ok(());
        }
        let names = leg_base::description::faults(self.faults());
        Err(format!("{names}, which nothing caused"))
    }

    /// Lets a time pass without a fault.
    ///
    /// # Errors
    /// A fault; as [`Self::tick`].
    pub fn wait(&mut self, time_s: f64) -> Result<(), String> {
        let end_s = self.time_s() + time_s;
        self.tick_until(f64::INFINITY, "", |stand| stand.time_s() >= end_s)
    }

    /// Ticks until something is so, without a fault.
    ///
    /// # Errors
    /// A fault, or that it does not come in time; as [`Self::tick`].
    pub fn tick_until(
        &mut self,
        timeout_s: f64,
        what: &str,
        done: impl Fn(&Self) -> bool,
    ) -> Result<(), String> {
        let end_s = self.time_s() + timeout_s;
        while !done(self) {
            self.tick()?;
            self.require_no_fault()?;
            if self.time_s() > end_s {
                return Err(format!("{what} does not come in {timeout_s} s"));
            }
        }
        Ok(())
    }

    /// Waits until the leg no longer moves: it swings, and it compensates a load slowly.
    ///
    /// # Errors
    /// A fault, or that it does not come to rest; as [`Self::tick`].
    pub fn rest(&mut self) -> Result<(), String> {
        for _ in 0..STILL_SPANS {
            let (before_m, mut moved_m) = (self.truth.tip_m, 0.0_f64);
            for _ in 0..STILL_TICKS {
                self.tick()?;
                self.require_no_fault()?;
                moved_m = moved_m.max((self.truth.tip_m - before_m).norm());
            }
            if moved_m < STILL_M {
                return Ok(());
            }
        }
        Err("the leg does not come to rest".into())
    }
}

/// The command to go to a pose.
pub fn move_to([azimuth_deg, tilt_deg]: [f64; 2]) -> Command {
    let [x, y] = angles::direction(azimuth_deg, tilt_deg).map(|c| c as f32);
    Command::Move { x, y }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Stand;
    use leg_firmware::command::Command;
    use leg_firmware::supervisor::State;
    use leg_rig::rig_file::RigFile;
    use leg_sim::plant::Start;
    use leg_sim::shadow::OTHER_TICKS_MAX;

    /// A shadow that begins anew beside a leg that is armed is in another state: a tick fails, where it is judged. The host is silent, so that
    /// nothing is answered otherwise.
    #[test]
    fn a_leg_that_leaves_its_shadow_is_told() {
        let rig = RigFile::load(None).unwrap();
        let started = || Stand::new(&rig, &rig.plant, Start::hanging(70.0), 1).unwrap();
        let mut stand = started();
        stand.wait(0.1).unwrap();
        stand.command(&Command::Arm).unwrap();
        stand.wait(0.5).unwrap();
        assert_eq!(stand.state(), State::Active);
        assert_eq!(stand.require_shadow(OTHER_TICKS_MAX), Ok(()));
        let divergence = stand.shadow.divergence;
        assert!(divergence.duty > 0.0 && divergence.reference_m > 0.0);
        stand.silence();
        stand.wait(0.01).unwrap();
        stand.shadow = started().shadow;
        let mut unjudged = stand.clone();
        let left = stand.wait(0.01).unwrap_err();
        assert!(left.contains("leaves the state of its shadow"), "{left}");
        unjudged.other_ticks = None;
        unjudged.wait(0.01).unwrap();
        assert!(unjudged.require_shadow(OTHER_TICKS_MAX).is_err());
    }
}
