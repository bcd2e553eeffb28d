//! Commands that are interrupted, with the telemetry of that time at a high rate.

use super::command::name;
use super::motion::not_following;
use super::{Operator, OperatorError};
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use std::time::Duration;

/// Ticks from one telemetry to the next: 500 Hz, what the serial line carries.
const EVERY_TICKS: u16 = 16;

/// Longest wait for the next telemetry: this machine may be so busy that this program, or a leg which it emulates, has to wait for
/// seconds.
const SILENT_TIME: Duration = Duration::from_secs(10);

/// Longest time of a command until it is stopped, by the leg's ticks: slow motors bring the pretension up first.
const COMMAND_TIME: Duration = Duration::from_secs(20);

/// What is done with each telemetry: true when it was the last.
type Watch<'a> = &'a mut dyn FnMut(&Telemetry<f32>) -> bool;

impl Operator {
    /// Commands an active leg, stops it on the way as soon as `passed` says so, and gives the telemetry from the command until a
    /// time after the stop. The leg is held then: it swings on its screws, and no motor has turned back.
    ///
    /// # Errors
    /// As [`Self::reach`].
    pub fn interrupt(
        &mut self,
        command: Command,
        mut passed: impl FnMut(&Telemetry<f32>) -> bool,
        time: Duration,
    ) -> Result<Vec<Telemetry<f32>>, OperatorError> {
        let asked = name(&command);
        self.settle_state(asked)?;
        let mut recorded = Vec::new();
        self.streamed(|operator| {
            operator.drive(|operator| {
                operator.activate(asked)?;
                let begun = operator.telemetry()?.telemetry.tick;
                operator.command(command)?;
                operator.watch(asked, COMMAND_TIME, &mut |telemetry| {
                    if telemetry.tick.wrapping_sub(begun).cast_signed() < 0 {
                        // From before it was activated.
                        return false;
                    }
                    recorded.push(*telemetry);
                    passed(telemetry) || telemetry.state != State::Active
                })?;
                operator.command(Command::Stop)?;
                operator.collect(asked, time, &mut recorded)
            })
        })?;
        match recorded.last() {
            Some(last) if last.state == State::Held && !last.faults.stopping().any() => {
                Ok(recorded)
            }
            Some(last) => Err(not_following(asked, last)),
            None => Err(OperatorError::NoAnswer(self.name().into())),
        }
    }

    fn streamed<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, OperatorError>,
    ) -> Result<T, OperatorError> {
        self.start_stream(EVERY_TICKS)?;
        let result = work(self);
        let ended = self.end_stream();
        let result = result?;
        ended.map(|()| result)
    }

    /// Keeps the telemetry of a time.
    fn collect(
        &mut self,
        asked: &'static str,
        time: Duration,
        recorded: &mut Vec<Telemetry<f32>>,
    ) -> Result<(), OperatorError> {
        let ticks = ticks(time);
        let mut first = None;
        self.watch(asked, 2 * time, &mut |telemetry| {
            recorded.push(*telemetry);
            let first = *first.get_or_insert(telemetry.tick);
            telemetry.tick.wrapping_sub(first) >= ticks
        })
    }

    fn watch(
        &mut self,
        asked: &'static str,
        longest: Duration,
        done: Watch<'_>,
    ) -> Result<(), OperatorError> {
        let mut first = None;
        while let Some(report) = self.next_streamed(SILENT_TIME)? {
            let telemetry = report.telemetry;
            if done(&telemetry) {
                return Ok(());
            }
            let first = *first.get_or_insert(telemetry.tick);
            if telemetry.tick.wrapping_sub(first) > ticks(longest) {
                return Err(OperatorError::TimedOut(asked, longest, Box::new(telemetry)));
            }
        }
        Err(OperatorError::NoAnswer(self.name().into()))
    }
}

fn ticks(time: Duration) -> u32 {
    (time.as_secs_f64() * f64::from(TICK_HZ)) as u32
}
