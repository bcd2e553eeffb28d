//! The part of a board layer that touches no register: all that its lower half decides.
//!
//! A board layer reads and writes registers and leaves the rest to this module, so that the rest is tested on the host.

mod blink;
mod bridge;
mod crash_record;
mod fault_lines;
mod gate;
mod link_choice;
mod power_stage;
mod reference;
mod reset_cause;
mod short_text;
mod task_watchdog;
mod tick_timer;
pub mod timing;

pub use blink::{BLINK_STEP_MS, led_on};
pub use bridge::{Bridge, BridgeOutput};
pub use crash_record::{CrashRecord, CrashReport};
pub use fault_lines::{FaultLines, LineFaults};
pub use gate::{Gate, GateAction};
pub use link_choice::LinkChoice;
pub use power_stage::{PowerPins, PowerStage};
pub use reference::checked_supply;
pub use reset_cause::reset_cause;
pub use short_text::{ShortText, file_name};
pub use task_watchdog::{CheckIns, TaskWatchdog, WatchedTask};
pub use tick_timer::TickTimer;

use crate::drive::Drive;
use crate::linked_leg::SensingLeg;
use crate::recorder::Recorder;
use crate::sensors::Sensors;

/// What a leg needs of the board under it.
///
/// Every implementation keeps to the same contract, which `tests/suite/firmware/board_contract.rs` puts each of them through:
/// - Nothing is driven before a [`drive`](Self::drive) that is enabled.
/// - A drive that is not enabled drives nothing, whatever its duties are; a duty that is not a number drives nothing,
///   and one beyond −1 to 1 counts as the nearer end.
/// - After a [`cut`](Self::cut), or after the board has switched its outputs off by itself, nothing is driven until a
///   drive was not enabled and a later one is.
pub trait LowerHalf {
    /// Reads every sensor.
    fn sense(&mut self) -> Sensors;

    /// Passes on what a tick asks of the motors.
    fn drive(&mut self, drive: &Drive<f32>);

    /// Switches the outputs off at once.
    fn cut(&mut self);
}

/// One tick of a leg on a board, which is recorded once the motors have what the leg asks of them; gives that.
#[inline(always)]
pub fn tick(
    board: &mut impl LowerHalf,
    leg: &mut SensingLeg<f32>,
    recorder: &mut Recorder,
) -> Drive<f32> {
    let sensors = board.sense();
    let leg = leg.store_sensors(&sensors);
    let drive = leg.tick(&sensors);
    board.drive(&drive);
    recorder.record(leg, &drive);
    drive
}
