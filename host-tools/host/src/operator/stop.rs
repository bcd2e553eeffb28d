//! Stopping, disarming and clearing a leg.

use super::motion::not_following;
use super::{Operator, OperatorError};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::{HOST_SCHEMA, Hello, HostRefusal, HostReply, HostRequest};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use std::io;
use std::time::Duration;

/// Wait for the answer to a stop before it is repeated.
const STOP_TIME: Duration = Duration::from_millis(50);

/// How long a stop is repeated before the leg is taken for unreachable: this machine may be so busy that this program, or a leg
/// which it emulates, has to wait for seconds.
const STOPS_TIME: Duration = Duration::from_secs(10);

/// How often it is said meanwhile that nobody acknowledges it: who has an emergency stop shall not wait for the end.
const STOPS_LATE_TIME: Duration = Duration::from_secs(2);

/// How long a leg that is disarmed may stand still before it is waited for no longer, and what counts as that, m. How long the
/// whole takes is up to its settings.
const STILL_TIME: Duration = Duration::from_secs(5);
const STILL_M: f32 = 1e-6;

/// Between two looks at a leg that a stop brakes, and how many there are at most: it takes some tenths of a second.
const REST_TIME: Duration = Duration::from_millis(50);
const REST_LOOKS: u32 = 20;

/// Longest wait for a leg that moves.
const LONGEST_TIME: Duration = Duration::from_secs(24 * 3600);

impl Operator {
    /// Stops the leg, whatever else is going on: repeated until it is acknowledged, whoever drives, Ctrl-C or not. A leg
    /// at rest or ramping down stays so.
    ///
    /// # Errors
    /// [`OperatorError::NotStopped`]; a connection that fails.
    pub fn stop(&mut self) -> Result<Telemetry<f32>, OperatorError> {
        let stopped = self.uncancelled(|operator| {
            operator.send_stops()?;
            operator.telemetry()
        });
        self.drives = false;
        stopped.map(|report| report.telemetry)
    }

    /// The same, and waits until its motors stand, as a stop brakes them for a moment; not where the leg ramps down.
    ///
    /// # Errors
    /// As [`Self::stop`]; [`OperatorError::NoAnswer`] where it does not answer after that.
    pub fn stop_to_rest(&mut self) -> Result<Telemetry<f32>, OperatorError> {
        let mut now = self.stop()?;
        self.uncancelled(|operator| {
            for _ in 0..REST_LOOKS {
                if now.state == State::RampingDown {
                    break;
                }
                operator.pause(REST_TIME)?;
                let report = operator.telemetry()?;
                let before = std::mem::replace(&mut now, report.telemetry);
                if !travelled(&before.pulled_m, &now.pulled_m) {
                    break;
                }
            }
            Ok(now)
        })
    }

    /// The same without reading telemetry.
    pub(super) fn halt(&mut self) -> Result<(), OperatorError> {
        let halted = self.uncancelled(Self::send_stops);
        self.drives = false;
        halted
    }

    /// Does `work` to its end even after Ctrl-C, and without keep-alives.
    pub(crate) fn uncancelled<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, OperatorError>,
    ) -> Result<T, OperatorError> {
        let cancel = std::mem::take(&mut self.cancel);
        let keeps_alive = std::mem::replace(&mut self.keeps_alive, false);
        let result = work(self);
        (self.cancel, self.keeps_alive) = (cancel, keeps_alive);
        result
    }

    fn send_stops(&mut self) -> Result<(), OperatorError> {
        let request = HostRequest::Command {
            host: self.host,
            command: Command::Stop,
        };
        let mut numbers = Vec::new();
        let error = OperatorError::NotStopped(self.name().into());
        let begun = self.now();
        let mut told = begun;
        while self.now() < begun + STOPS_TIME {
            if self.now() >= told + STOPS_LATE_TIME {
                told = self.now();
                (self.late_watcher)(&error);
            }
            numbers.extend(taken(self.connection.send_urgent(&request))?);
            if self.stop_acknowledged(&numbers, &request)? {
                return Ok(());
            }
        }
        Err(error)
    }

    /// Whether one of these stops is acknowledged before it is time for the next.
    fn stop_acknowledged(
        &mut self,
        numbers: &[u16],
        request: &HostRequest,
    ) -> Result<bool, OperatorError> {
        let until = self.now() + STOP_TIME;
        while let Some(reply) = self.answer(numbers, request, until)?.reply {
            match reply {
                // Where the state does not allow it, the leg ramps down or starts: nothing of it follows commands.
                HostReply::Done
                | HostReply::Refused(HostRefusal::Command(CommandRefusal::State(_))) => {
                    return Ok(true);
                }
                HostReply::Refused(HostRefusal::NotIdentified) => {
                    let schema = HOST_SCHEMA;
                    let hello = HostRequest::Identify(Hello { schema });
                    taken(self.connection.send(&hello))?;
                    return Ok(false);
                }
                // No room, or superseded by another stop: to send the next at once would use up the time of a busy leg.
                _ => {}
            }
        }
        Ok(false)
    }

    /// Ramps the tendons down and waits until the drivers are off, as long as motors move.
    ///
    /// # Errors
    /// As [`Self::command`]; [`OperatorError::Failed`] and [`OperatorError::StoppedByOtherHost`] where a fault or a stop ends it on the way;
    /// [`OperatorError::TimedOut`] where the leg stands still for five seconds.
    pub fn disarm(&mut self) -> Result<(), OperatorError> {
        let asked = "disarm";
        let before = self.telemetry()?.telemetry.faults;
        self.command(Command::Disarm)?;
        self.drives = false;
        let ended = self.wait_while_moving(asked, STILL_TIME, |telemetry| {
            matches!(telemetry.state, State::Disarmed | State::Off | State::Held)
        })?;
        let new_faults = ended.faults.stopping().difference(before);
        match ended.state {
            State::Held => Err(not_following(asked, &ended)),
            // With its tendons taut, perhaps.
            State::Off if new_faults.any() => Err(not_following(asked, &ended)),
            _ => Ok(()),
        }
    }

    /// Waits until `done` says so, as long as motors move, and `still` longer.
    pub(super) fn wait_while_moving(
        &mut self,
        asked: &'static str,
        still: Duration,
        done: impl Fn(&Telemetry<f32>) -> bool,
    ) -> Result<Telemetry<f32>, OperatorError> {
        let mut moved = (self.now(), [f32::MAX; 3]);
        self.poll(asked, LONGEST_TIME, |now, telemetry| {
            // However long this machine took to look.
            if done(telemetry) {
                return Ok(true);
            }
            if travelled(&moved.1, &telemetry.pulled_m) {
                moved = (now, telemetry.pulled_m);
            } else if now > moved.0 + still {
                let telemetry = Box::new(*telemetry);
                return Err(OperatorError::TimedOut(asked, still, telemetry));
            }
            Ok(false)
        })
    }

    /// Clears the faults whose cause is gone, and leaves the leg in hold if it was held. One that keeps station has none, and goes on.
    ///
    /// # Errors
    /// As [`Self::drive`] and [`Self::command`]; [`OperatorError::NotCleared`] where a cause is still present.
    pub fn clear(&mut self) -> Result<(), OperatorError> {
        if self.telemetry()?.telemetry.state == State::KeepingStation {
            self.command(Command::Clear)?;
            if self.telemetry()?.telemetry.state == State::KeepingStation {
                self.drives = false;
                return Ok(());
            }
            // A fault has come meanwhile, and the leg may follow commands now.
        }
        self.drive(|operator| operator.command(Command::Clear))
    }
}

/// Whether a motor has gone on.
fn travelled(before_m: &[f32; 3], now_m: &[f32; 3]) -> bool {
    let mut pairs = before_m.iter().zip(now_m);
    pairs.any(|(before, now)| (now - before).abs() > STILL_M)
}

/// The number of what was sent; none where the line took no frame in time: a bus on which nobody acknowledges takes the next one when its board has
/// started.
fn taken(sent: Result<u16, OperatorError>) -> Result<Option<u16>, OperatorError> {
    match sent {
        Err(OperatorError::ConnectionLost(_, source))
            if source.kind() == io::ErrorKind::TimedOut =>
        {
            Ok(None)
        }
        sent => sent.map(Some),
    }
}
