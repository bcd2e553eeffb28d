//! Following commands: estimate, pretension, target and plan in turn, one a tick.

mod streaming;

use super::give_way::{GIVEN_WAY_STEPS, gives_way};
use super::length_offsets::LengthOffsets;
use super::phase::Phase;
use super::pretension_search::search_pretension;
use super::shared::Shared;
use super::slack::Slack;
use super::station::{Station, StationKeeping};
use super::stretch::StretchSearch;
use crate::command::Compensation;
use crate::control::{
    CYCLE_TICKS, Debounce, LoadEstimation, Measured, TargetDemand, Trajectory, Unloaded,
};
use crate::supervisor::{Fault, FaultSet, SETTLE_CYCLES};
use leg_model::{Direction, Error, Scalar};

/// The leg follows commands.
#[derive(Clone, Copy, Debug)]
pub struct Active<T> {
    pub trajectory: Trajectory<T>,
    /// Where the last move shall end, as horizontal components; none after a hold, or where a path is followed.
    pub commanded: Option<[T; 2]>,
    /// Whether every tendon has been above the minimum tension since the leg was armed.
    pub tensioned: bool,
    /// Whether the leg may set out: since it was armed the target's pretension has come up, or could not, or a stream was begun.
    pub pretensioned: bool,
    /// Whether the leg is led straight down, to be disarmed there.
    pub disarming: bool,
    /// What limits a leg that keeps station.
    pub station: StationKeeping<T>,
    /// What was found in the last turn of the offsets: a station too far away, a swing that does not end.
    pub faults: FaultSet,
    /// Whether there is no target where it was sent: it stays.
    pub without_target: bool,
    offsets: LengthOffsets<T>,
    slack: Slack<T>,
    /// Whether the load stays as it is: where it was frozen, until the leg rests. On its way a push that came meanwhile would be taken for a payload
    /// at once, and a target whose tensions jump moves the leg.
    frozen: bool,
    /// Whether the leg gives way to the maximum tension.
    given_way: Debounce,
    /// The search for how much the tendons stretch.
    pub stretch: StretchSearch,
    /// The search for where a taut leg with its compensation off begins; none once it is over.
    unloaded: Option<Unloaded<T>>,
}

impl<T: Scalar> Active<T> {
    /// Follows commands from the present pose and pretension on.
    pub fn begin(shared: &mut Shared<T>, measured: &Measured<T>) -> Self {
        let compensated = shared.compensation != Compensation::Off;
        let just_homed = core::mem::take(&mut shared.just_homed);
        shared.targets.start(compensated);
        shared.damping.start();
        shared.play.start();
        shared.stream.leave();
        shared.target = None;
        shared.estimate = None;
        // A leg whose tendons pull already stays as it is: relaxed first, it would swing.
        let taut_n = shared.taut_n();
        let taut = measured.steady_tensions_n.iter().all(|&n| n > taut_n);
        if taut {
            // The last target may have been made for another load, and twisted otherwise.
            shared.targets.start_twisted(shared.estimator.torsion());
        }
        let loaded = shared.estimator.direction();
        let unloaded =
            (taut && !compensated).then(|| Unloaded::search(loaded, &measured.steady_tensions_n));
        Self {
            trajectory: Trajectory::new(shared.limits.motion, loaded.half_tangent()),
            commanded: None,
            tensioned: false,
            pretensioned: false,
            disarming: false,
            station: StationKeeping::No,
            faults: FaultSet::NONE,
            without_target: false,
            offsets: LengthOffsets::new(shared.play.lag_m()),
            slack: Slack {
                left_m: (taut && compensated).then(T::zero),
                cycles: 0,
            },
            frozen: false,
            given_way: Debounce::new(GIVEN_WAY_STEPS),
            stretch: if just_homed && !taut && compensated {
                StretchSearch::begin()
            } else {
                StretchSearch::Over
            },
            unloaded,
        }
    }

    /// One tick.
    #[inline(always)]
    pub fn step(
        &mut self,
        phase: Phase,
        shared: &mut Shared<T>,
        measured: &Measured<T>,
    ) -> Result<(), Error> {
        match phase {
            Phase::Estimate => self.estimate(shared, measured),
            // The load comes first: the brake is made for it.
            Phase::Offsets => {
                shared.step_load(self.trajectory.turn());
                self.offsets.step(shared, self.tensioned, &mut self.station);
                if self.tensioned {
                    shared.feed_friction();
                }
                if self.has_set_out() {
                    shared.damping.forget_small_swing();
                } else if shared
                    .target
                    .as_ref()
                    .is_none_or(|target| target.has_room())
                {
                    // Load cells that are wrong would lead a leg at rest there.
                    shared.targets.take_last_newtons(false);
                }
                let off_station = self.station.kept().is_some_and(Station::too_far);
                self.faults = FaultSet::NONE;
                self.faults.add(Fault::OffStation, off_station);
                self.faults
                    .add(Fault::Swings, shared.damping.keeps_swinging());
                let rests = self.tensioned && !self.has_set_out();
                let given_way = self
                    .given_way
                    .update(rests && gives_way(shared, self.without_target, measured));
                self.faults.add(Fault::Following, given_way);
                Ok(())
            }
            Phase::Pretension => {
                // A tick has no time for both.
                if self.stretch.is_over() || !self.search_stretch(shared) {
                    search_pretension(shared)
                } else {
                    Ok(())
                }
            }
            Phase::Command => Ok(()),
            Phase::Target => self.aim(shared, measured),
            Phase::Plan => {
                if !self.pretensioned && self.has_pretension(shared) {
                    self.pretensioned = true;
                    shared.targets.take_last_newtons(self.trajectory.moving());
                }
                if self.pretensioned {
                    let joint_damping = shared.limits.joint_damping;
                    self.trajectory
                        .advance_plan(&mut shared.stream, joint_damping);
                    if let Some(demand) = shared.stream.take_demand() {
                        shared.pretension.demand(demand);
                    }
                }
                Ok(())
            }
        }
    }

    /// Goes to a point.
    pub fn go(&mut self, shared: &mut Shared<T>, to: &Direction<T>) {
        self.leave_stream(shared);
        shared.targets.take_last_newtons(true);
        self.trajectory.go(to.half_tangent());
        let along = to.vector();
        self.commanded = Some([along.x, along.y]);
    }

    /// Comes to rest. One that has not set out yet does not.
    pub fn hold(&mut self, shared: &mut Shared<T>) {
        self.commanded = None;
        if !self.pretensioned {
            let here = self.trajectory.step();
            self.trajectory.start(here);
        } else if !self.leave_stream(shared) {
            self.trajectory.stop();
        }
    }

    /// Whether the leg may set out: its tendons are taut, and the target's pretension has come up as far as the bounds allow. On softer tendons it would
    /// swing, and what they show then would be taken for a payload (`a_soft_leg_sets_out_with_its_pretension`). A leg that is led down to be
    /// disarmed does not wait for the pretension, nor does one without a target.
    #[inline(always)]
    fn has_pretension(&self, shared: &Shared<T>) -> bool {
        let wish_n = shared.pretension.pretension_n();
        let target = shared.target.as_ref();
        let up = target.is_some_and(|target| !target.is_below_pretension(wish_n));
        self.slack.taken_up() && (up || self.disarming || self.without_target)
    }

    /// A step of the search for how much the tendons stretch, until the leg is asked for more than a pretension. True if they were scaled.
    #[inline(always)]
    fn search_stretch(&mut self, shared: &mut Shared<T>) -> bool {
        let asked = self.commanded.is_some() || self.trajectory.moving() || self.disarming;
        if asked {
            self.stretch = StretchSearch::Over;
        }
        self.stretch.step(shared, self.tensioned, &mut self.faults)
    }

    /// Whether it rests at its target with its load compensated, so that it can be left there.
    pub fn may_keep_station(&self, shared: &Shared<T>) -> bool {
        let compensated = shared.compensation == Compensation::Estimated;
        shared.station.allowed
            && compensated
            && self.tensioned
            && !self.moving()
            && !self.without_target
    }

    /// Whether it has set out and is on its way, or plans one: not while it waits for its pretension.
    #[inline(always)]
    pub fn has_set_out(&self) -> bool {
        self.pretensioned && self.trajectory.moving()
    }

    /// Whether it is on its way or waits to set out, measures its tendons after homing, or corrects where it keeps station.
    pub fn moving(&self) -> bool {
        self.trajectory.moving() || !self.stretch.is_over() || self.station.corrects()
    }

    /// Whether it has come to rest where it is, as there is no target where it was sent.
    pub fn rests_without_target(&self) -> bool {
        self.without_target && !self.disarming && !self.moving()
    }

    /// Leads the leg straight down, to be disarmed there.
    pub fn disarm(&mut self, shared: &mut Shared<T>) {
        self.disarming = true;
        self.without_target = false;
        self.go(shared, &Direction::straight_down());
    }

    /// Whether it was led down, or cannot be.
    #[inline(always)]
    pub fn led_down(&self) -> bool {
        self.disarming && (!self.trajectory.moving() || self.without_target)
    }

    /// Whether it was armed just now with tendons that pulled already, one of which is below the minimum tension since, or which searches where it
    /// begins without its load.
    #[inline(always)]
    pub fn begins_taut(&self) -> bool {
        let taut = self.slack.taken_up() || self.unloaded.is_some();
        taut && self.slack.cycles <= u32::from(SETTLE_CYCLES)
    }

    /// Whether the tendons take too long to become taut.
    #[inline(always)]
    pub fn stays_slack(&self, shared: &Shared<T>) -> bool {
        !self.tensioned && self.slack.cycles > shared.limits.taut_cycles
    }

    /// Estimates the pose, and takes the load that the tendons show. While they come up from slack, their tensions do not show it.
    #[inline(always)]
    fn estimate(&mut self, shared: &mut Shared<T>, measured: &Measured<T>) -> Result<(), Error> {
        let moving = self.has_set_out();
        self.frozen = shared.compensation == Compensation::Frozen || self.frozen && moving;
        let load_estimation = if !self.tensioned {
            LoadEstimation::Slack
        } else if self.frozen {
            LoadEstimation::Frozen
        } else if moving {
            LoadEstimation::Moving
        } else {
            LoadEstimation::Filtered
        };
        if !self.tensioned {
            self.tensioned = self.slack.watch(shared, measured);
        }
        shared.estimate(measured, load_estimation)
    }

    /// Computes the next target, and leads the axes there.
    #[inline(never)]
    fn aim(&mut self, shared: &mut Shared<T>, measured: &Measured<T>) -> Result<(), Error> {
        if self.unloaded.is_some() {
            self.search_unloaded(shared, measured);
            return Ok(());
        }
        let taut = self.slack.taken_up();
        let demand = TargetDemand {
            q: self.trajectory.step(),
            turn: self.trajectory.turn(),
            payload_kg: shared.estimator.load.moved_kg(),
            load: shared.estimator.load.estimate(),
            compensated: shared.compensation != Compensation::Off,
            trimmed: shared.compensation == Compensation::Estimated && self.tensioned,
            // The pretension comes up when every tendon is as far from slack as every other.
            pretension_n: if taut {
                shared.pretension.pretension_n()
            } else {
                T::zero()
            },
        };
        let target = shared
            .targets
            .next(&shared.mechanism, &demand, &measured.steady_tensions_n);
        let mut target = match target {
            Ok(target) => target,
            Err(error) => {
                self.stay(shared);
                return Err(error);
            }
        };
        let Some(mut pulled_m) = shared.zero_m else {
            return Err(Error::NotConverged);
        };
        let longer_m = self.offsets.advance();
        for (i, pulled) in pulled_m.iter_mut().enumerate() {
            *pulled -= target.unstretched_m[i] + longer_m[i];
        }
        let step_max_m = if taut {
            shared.limits.servo_step_m
        } else {
            self.slack.reel_in(shared, &mut pulled_m)
        };
        let per_ticks = T::one() / T::from(f32::from(CYCLE_TICKS));
        for (axis, &pulled_m) in shared.axes.iter_mut().zip(&pulled_m) {
            axis.lead_within(pulled_m, step_max_m, per_ticks);
        }
        target.limited &= taut;
        shared.target = Some(target);
        self.without_target = false;
        Ok(())
    }

    /// A step of the search for where a leg with its compensation off begins: where it points, if it is not found. Until then the
    /// motors stay where they are.
    #[cold]
    fn search_unloaded(&mut self, shared: &mut Shared<T>, measured: &Measured<T>) {
        let (Some(unloaded), Some(unstretched_m)) =
            (&mut self.unloaded, shared.unstretched_m(measured))
        else {
            return;
        };
        let torsion = shared.targets.torsion();
        match unloaded.step(&shared.mechanism, &unstretched_m, torsion) {
            Ok(false) => return,
            Ok(true) => {
                self.trajectory.shift(unloaded.direction().half_tangent());
                shared.targets.start_at(unloaded.pretension_n());
            }
            Err(_) => {}
        }
        self.unloaded = None;
        self.slack.left_m = Some(T::zero());
    }

    /// Stays where the last target was: there is none where the trajectory is now.
    #[cold]
    fn stay(&mut self, shared: &mut Shared<T>) {
        for axis in &mut shared.axes {
            axis.lead_by(T::zero());
        }
        let target = shared.target.as_ref();
        let direction =
            target.map_or_else(|| shared.estimator.direction(), |target| &target.direction);
        self.trajectory.start(direction.half_tangent());
        shared.targets.rest();
        self.offsets.stay();
        shared.refused = true;
        self.without_target = true;
    }
}

#[cfg(test)]
mod tests;
