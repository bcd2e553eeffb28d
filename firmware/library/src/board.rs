//! What is pure of a board: all that its lower half decides, without a register.
//!
//! A board layer reads and writes registers and leaves the rest to this module, so that the rest is tested on the host.

mod beat;
mod bridge;
mod fault_lines;
mod gate;
mod last_words;
mod link_choice;
mod power_stage;
mod reset_cause;
mod roll_call;
mod tick_timer;
pub mod timing;
mod words;

pub use beat::{STEP_MS, lit};
pub use bridge::{Bridge, Half};
pub use fault_lines::{FaultLines, Faults};
pub use gate::{Gate, Turn};
pub use last_words::{Kept, LastWords};
pub use link_choice::LinkChoice;
pub use power_stage::{PowerPins, PowerStage};
pub use reset_cause::reset_cause;
pub use roll_call::{Member, RollCall, Rounds};
pub use tick_timer::TickTimer;
pub use words::{Words, file_name};

use crate::drive::Drive;
use crate::linked_leg::SensingLeg;
use crate::sensors::Sensors;

/// What a leg needs of the board under it.
///
/// Every implementation keeps to the same contract, which `tests/board_contract.rs` puts each of them through:
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

/// One tick of a leg on a board; gives what the leg asked of the motors.
#[inline(always)]
pub fn tick(board: &mut impl LowerHalf, leg: &mut SensingLeg<f32>) -> Drive<f32> {
    let sensors = board.sense();
    let drive = leg.tick(&sensors);
    board.drive(&drive);
    drive
}
