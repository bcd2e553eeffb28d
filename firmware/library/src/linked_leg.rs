//! A leg with its end of the host's line: no flash, no clock but the ticks.

use crate::command::Command;
use crate::drive::Drive;
use crate::host_link::{CommandedLeg, HostLink, HostRefusal, Identity};
use crate::jog::JogReport;
use crate::leg::{Checked, CommandOutcome, Leg};
use crate::recorder::{Recorder, RecorderReply, RecorderRequest, RecorderSetup};
use crate::sensors::{SensorReading, Sensors};
use crate::settings::{Settings, SettingsError};
use crate::supervisor::{FaultSet, State};
use crate::telemetry::Telemetry;
use heapless::Vec;
use leg_model::Scalar;

/// Most bytes of the host's link that one tick takes or gives: what a serial link of 1 MBd brings in it, and more.
pub const LINK_BYTES_MAX: usize = 64;

/// A leg, and what it read last.
#[derive(Clone, Debug)]
pub struct SensingLeg<T> {
    leg: Leg<T>,
    sensors: Sensors,
}

impl<T: Scalar> SensingLeg<T> {
    /// A leg before the first reading of its sensors.
    ///
    /// # Errors
    /// Settings that are refused.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        Ok(Self::assembled(settings, Checked::new(settings)?))
    }

    /// The same of settings that were checked: see [`Leg::assembled`].
    #[inline(always)]
    pub fn assembled(settings: &Settings, checked: Checked<T>) -> Self {
        Self {
            leg: Leg::assembled(settings, checked),
            sensors: Sensors::default(),
        }
    }

    /// Keeps what the sensors read, for the host, and gives the leg for its tick.
    #[inline(always)]
    pub fn store_sensors(&mut self, sensors: &Sensors) -> &mut Leg<T> {
        self.sensors = *sensors;
        &mut self.leg
    }

    /// One tick: see [`Leg::tick`].
    #[inline(always)]
    pub fn tick(&mut self, sensors: &Sensors) -> Drive<T> {
        self.store_sensors(sensors).tick(sensors)
    }

    /// See [`Leg::forget_zero`].
    pub fn forget_zero(&mut self) {
        self.leg.forget_zero();
    }

    /// Refuses the commands that wait, unless this leg drives its motors: see [`Leg::refuse_commands`].
    pub fn refuse_commands(&mut self) {
        if !self.leg.state().driven() {
            self.leg.refuse_commands();
        }
    }

    /// Lets another leg take this one's place on the board: see [`Leg::inherit_from`].
    ///
    /// # Errors
    /// [`HostRefusal::Driven`]: this one drives its motors, and stays.
    pub fn hand_over(&mut self, to: &mut Self) -> Result<(), HostRefusal> {
        if self.leg.state().driven() {
            return Err(HostRefusal::Driven);
        }
        to.leg.inherit_from(&mut self.leg);
        to.sensors = self.sensors;
        Ok(())
    }

    /// See [`Leg::command`].
    pub fn command(&mut self, number: u16, command: Command) -> bool {
        self.leg.command(number, command)
    }

    /// See [`Leg::note_decode_error`].
    pub fn note_decode_error(&mut self) {
        self.leg.note_decode_error();
    }

    /// See [`Leg::outcome`].
    pub fn outcome(&mut self) -> Option<CommandOutcome> {
        self.leg.outcome()
    }

    /// See [`Leg::jog_report`].
    #[must_use]
    pub fn jog_report(&self) -> Option<&JogReport<T>> {
        self.leg.jog_report()
    }

    /// What the sensors read last.
    #[must_use]
    pub fn sensors(&self) -> SensorReading {
        SensorReading {
            codes: self.sensors,
            current_zeros: self.leg.current_zeros(),
        }
    }

    /// Starts again with other settings: see [`CommandedLeg::restart`].
    ///
    /// # Errors
    /// As there.
    pub fn restart(&mut self, settings: &Settings) -> Result<(), HostRefusal> {
        let mut fresh = Self::new(settings).map_err(HostRefusal::Settings)?;
        fresh.forget_zero();
        self.hand_over(&mut fresh)?;
        *self = fresh;
        Ok(())
    }

    /// See [`Leg::state`].
    #[must_use]
    pub fn state(&self) -> State {
        self.leg.state()
    }

    /// See [`Leg::stopping_faults`].
    #[must_use]
    pub fn stopping_faults(&self) -> FaultSet {
        self.leg.stopping_faults()
    }

    /// See [`Leg::ticks`].
    #[must_use]
    pub fn ticks(&self) -> u32 {
        self.leg.ticks()
    }

    /// See [`Leg::telemetry`].
    #[must_use]
    pub fn telemetry(&self) -> Telemetry<T> {
        self.leg.telemetry()
    }

    /// See [`Leg::course`].
    #[must_use]
    pub fn course(&self) -> Telemetry<T> {
        self.leg.course()
    }

    /// See [`Leg::report_measured`].
    pub fn report_measured(&self, telemetry: &mut Telemetry<T>) {
        self.leg.report_measured(telemetry);
    }
}

impl SensingLeg<f64> {
    /// See [`Leg::adopt_drive`].
    pub fn adopt_drive(&mut self, applied: &Drive<f64>) {
        self.leg.adopt_drive(applied);
    }
}

/// A leg and the recorder of its ticks, as a host commands them.
#[derive(Debug)]
pub struct RecordedLeg<'a, T> {
    /// The leg.
    pub leg: &'a mut SensingLeg<T>,
    /// Its recorder: apart, because it is too large to be moved.
    pub recorder: &'a mut Recorder,
}

macro_rules! commanded {
    ($number:ty, $narrowed:expr) => {
        impl CommandedLeg for RecordedLeg<'_, $number> {
            fn command(&mut self, number: u16, command: Command) -> bool {
                self.leg.command(number, command)
            }

            fn note_decode_error(&mut self) {
                self.leg.note_decode_error();
            }

            fn outcome(&mut self) -> Option<CommandOutcome> {
                self.leg.outcome()
            }

            fn state(&mut self) -> State {
                self.leg.state()
            }

            fn telemetry(&mut self) -> Telemetry<f32> {
                self.leg.telemetry().map($narrowed)
            }

            fn jog_report(&mut self) -> Option<JogReport<f32>> {
                self.leg.jog_report().map(|report| report.map($narrowed))
            }

            fn sensors(&mut self) -> SensorReading {
                self.leg.sensors()
            }

            fn restart(&mut self, settings: &Settings) -> Result<(), HostRefusal> {
                self.leg.restart(settings)?;
                self.recorder.begin(&RecorderSetup::new(settings));
                Ok(())
            }

            fn recorder(&mut self, request: RecorderRequest) -> Option<RecorderReply> {
                self.recorder.answer(request)
            }
        }
    };
}

commanded!(f32, |value| value);
commanded!(f64, |value| value as f32);

/// A leg and its line.
#[derive(Clone, Debug)]
pub struct LinkedLeg<T> {
    leg: SensingLeg<T>,
    link: HostLink,
}

impl<T: Scalar> LinkedLeg<T>
where
    for<'a> RecordedLeg<'a, T>: CommandedLeg,
{
    /// A leg before the first reading of its sensors, on a line on which nothing was sent yet.
    ///
    /// # Errors
    /// Settings that are refused.
    pub fn new(identity: Identity, settings: &Settings) -> Result<Self, SettingsError> {
        Ok(Self {
            leg: SensingLeg::new(settings)?,
            link: HostLink::new(identity, settings.clone()),
        })
    }

    /// Takes bytes from the host.
    pub fn receive(&mut self, bytes: &[u8], recorder: &mut Recorder) {
        let leg = &mut self.leg;
        self.link.receive(bytes, &mut RecordedLeg { leg, recorder });
    }

    /// The leg alone, for its tick.
    pub fn leg(&mut self) -> &mut SensingLeg<T> {
        &mut self.leg
    }

    /// What the host gets after a tick, as far as it fits. `save` keeps settings over a reset; false if that failed.
    pub fn sent(
        &mut self,
        recorder: &mut Recorder,
        mut save: impl FnMut(&Settings) -> bool,
    ) -> Vec<u8, LINK_BYTES_MAX> {
        let leg = &mut self.leg;
        self.link.report(&mut RecordedLeg { leg, recorder });
        if let Some(settings) = self.link.unsaved_settings() {
            let kept = save(settings);
            self.link.saved(kept);
        }
        let mut sent = Vec::new();
        while !sent.is_full()
            && let Some(byte) = self.link.transmit()
        {
            // There is room: it was just checked.
            let _ = sent.push(byte);
        }
        sent
    }
}

#[cfg(test)]
mod tests;
