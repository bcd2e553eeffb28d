//! Following a stream of set-points.

use super::Active;
use crate::control::{CYCLE_TICKS, Knot};
use crate::leg::shared::Shared;
use crate::set_point::{PointRefusal, SetPoint, StreamPart};
use leg_model::Scalar;

impl<T: Scalar> Active<T> {
    /// Leaves a stream for rest; false if none is followed.
    pub(super) fn leave_stream(&mut self, shared: &mut Shared<T>) -> bool {
        shared.stream.leave();
        let streamed = self.trajectory.streamed();
        if streamed {
            let motion = self.trajectory.motion();
            self.trajectory
                .leave_stream(&shared.stream.limits.rest_segment(&motion));
        }
        streamed
    }

    /// Takes a set-point; `tick` is the present one. The motors come to a target in the tick that executes the next command, so a
    /// stream begins at the next target, a cycle later.
    pub fn follow(
        &mut self,
        shared: &mut Shared<T>,
        tick: u32,
        point: &SetPoint,
    ) -> Result<(), PointRefusal> {
        let stream = &mut shared.stream;
        match (point.part, self.trajectory.streamed()) {
            _ if stream.repeats(point) => Ok(()),
            (StreamPart::First, true) => Err(PointRefusal::Following),
            (StreamPart::First, false) if !self.slack.taken_up() => Err(PointRefusal::NotTaut),
            (StreamPart::First, false) => {
                let start = Knot {
                    tick: tick.wrapping_add(u32::from(CYCLE_TICKS)),
                    motion: self.trajectory.next_motion(),
                };
                stream.begin(start, point)?;
                shared.targets.take_last_newtons(true);
                self.trajectory.begin_stream();
                // Its times are those of its points: it does not wait for the pretension.
                self.pretensioned = true;
                self.commanded = None;
                shared.refused = false;
                Ok(())
            }
            (_, false) => Err(PointRefusal::NoStream),
            (_, true) => stream.extend(tick, point),
        }
    }
}
