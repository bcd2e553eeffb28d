//! Whether replies are equal bit by bit.

use super::{CheckError, CheckedState, Pose};
use leg_firmware::frame::{self, MAX_FRAME};
use leg_firmware_bench::kernels::Kernel;
use leg_firmware_bench::protocol::Reply;
use serde::Serialize;

/// The name of a whole evaluation among those of the kernels.
pub(super) const EVALUATION: &str = "whole evaluation";

/// Replies whose bits were compared.
#[derive(Clone, Debug, Default, Serialize)]
pub struct BitComparison {
    /// Whole evaluations that were compared.
    pub evaluations: usize,
    /// Runs of kernels that were compared.
    pub runs: usize,
    /// What differs, each kernel once.
    pub differences: Vec<BitDifference>,
}

/// A kernel whose bits differ.
#[derive(Clone, Debug, Serialize)]
pub struct BitDifference {
    /// Its name.
    pub what: &'static str,
    /// The first state at which it differs.
    pub at: Pose,
    /// At how many states it differs.
    pub count: usize,
}

impl BitComparison {
    /// Poses at which each of the kernels was run.
    #[must_use]
    pub const fn poses(&self) -> usize {
        self.runs / Kernel::ALL.len()
    }

    /// Names what differs.
    pub fn failures(&self) -> impl Iterator<Item = String> {
        let differences = self.differences.iter();
        differences.map(|difference| format!("bits of {}", difference.what))
    }

    pub(super) fn compare(
        &mut self,
        reply: &Reply,
        host: &Reply,
        what: &'static str,
        state: &CheckedState,
    ) -> Result<(), CheckError> {
        if what == EVALUATION {
            self.evaluations += 1;
        } else {
            self.runs += 1;
        }
        if !same(reply, host)? {
            self.note(what, state);
        }
        Ok(())
    }

    fn note(&mut self, what: &'static str, state: &CheckedState) {
        let known = self.differences.iter_mut().find(|known| known.what == what);
        match known {
            Some(difference) => difference.count += 1,
            None => self.differences.push(BitDifference {
                what,
                at: state.pose(),
                count: 1,
            }),
        }
    }
}

/// Compares the replies as they cross the link: unlike `==` that tells zeros of different sign, and finds NaN equal to
/// itself.
fn same(reply: &Reply, host: &Reply) -> Result<bool, CheckError> {
    let (mut left, mut right) = ([0; MAX_FRAME], [0; MAX_FRAME]);
    let left = frame::encode(0, reply, &mut left).map_err(CheckError::NoFrame)?;
    let right = frame::encode(0, host, &mut right).map_err(CheckError::NoFrame)?;
    Ok(left == right)
}
