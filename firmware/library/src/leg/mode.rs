//! What the leg is doing, and what only that needs.

use super::active::Active;
use super::held::{Held, Momentum, is_obeyed};
use super::jogging::Jogging;
use super::ramping_down::RampingDown;
use super::shared::Shared;
use super::station::{Station, StationKeeping};
use crate::command::Compensation;
use crate::control::{Axis, HaulLimit, HomingSequence, Measured, ZERO_READINGS};
use crate::supervisor::{Event, FaultSet, State};
use leg_model::Scalar;

/// Ticks of [`State::Boot`]: in which the filters of the sensors settle, and the zeros of the currents are found.
const BOOT_TICKS: u32 = ZERO_READINGS as u32;

/// Ticks to the end of a way of which nothing is gone on with: it is braked as fast as may be.
const ENDING_TICKS: u32 = 1;

/// The mode: the leg's [`State`] with the data that lives only as long as the state does.
#[derive(Clone, Debug)]
#[repr(u8)]
#[allow(
    clippy::large_enum_variant,
    reason = "a mode is kept in place: there is no allocation on the board"
)]
pub enum Mode<T> {
    /// The sensors are read, nothing is driven.
    Boot { ticks_left: u32 },
    /// The drivers are off.
    Disarmed,
    /// The zero is searched for.
    Homing(HomingSequence<T>),
    /// Commands are followed, or station is kept.
    Active(Active<T>),
    /// The leg stays where it is.
    Held(Held<T>),
    /// The tendons are paid out.
    RampingDown(RampingDown<T>),
    /// The drivers are off after a fault.
    Off,
    /// One motor turns at a voltage.
    Jogging(Jogging<T>),
}

impl<T: Scalar> Mode<T> {
    /// The first one.
    pub const fn boot() -> Self {
        Self::Boot {
            ticks_left: BOOT_TICKS,
        }
    }

    /// The state.
    #[inline(always)]
    pub const fn state(&self) -> State {
        match self {
            Self::Boot { .. } => State::Boot,
            Self::Disarmed => State::Disarmed,
            Self::Homing(_) => State::Homing,
            Self::Active(active) if active.station.kept().is_some() => State::KeepingStation,
            Self::Active(_) => State::Active,
            Self::Held(_) => State::Held,
            Self::RampingDown(_) => State::RampingDown,
            Self::Off => State::Off,
            Self::Jogging(_) => State::Jogging,
        }
    }

    /// The active mode, if it is that or keeps station.
    #[inline(always)]
    pub const fn active(&self) -> Option<&Active<T>> {
        match self {
            Self::Active(active) => Some(active),
            _ => None,
        }
    }

    /// The state under which commands are refused that an active leg obeys: it keeps station, and is armed before it obeys, or it is led down.
    pub fn refuses_as(&self) -> Option<State> {
        let active = self.active()?;
        if active.station.kept().is_some() {
            Some(State::KeepingStation)
        } else {
            active.disarming.then_some(State::RampingDown)
        }
    }

    /// Whether the leg is on its way, or brakes.
    pub fn moving(&self) -> bool {
        match self {
            Self::Active(active) => active.moving(),
            _ => self.brakes(),
        }
    }

    /// Whether a held leg still brakes.
    #[inline(always)]
    pub const fn brakes(&self) -> bool {
        matches!(self, Self::Held(held) if held.brakes())
    }

    /// Counts a tick of the boot; true if it was the last.
    #[inline(always)]
    pub fn boots_up(&mut self) -> bool {
        match self {
            Self::Boot { ticks_left } => {
                *ticks_left = ticks_left.saturating_sub(1);
                *ticks_left == 0
            }
            _ => false,
        }
    }

    /// Whether motors turn; those of a held leg rest on their screws.
    #[inline(always)]
    pub const fn turns(&self) -> bool {
        match self {
            Self::Homing(_) | Self::Active(_) | Self::RampingDown(_) => true,
            Self::Held(held) => held.brakes(),
            // A jogged motor obeys no axis.
            Self::Boot { .. } | Self::Disarmed | Self::Off | Self::Jogging(_) => false,
        }
    }

    /// Leaves a leg that follows commands to itself, or lets one that keeps station follow them again: it goes on from where it is.
    /// False if that is not what the state is.
    pub fn change_station(&mut self, state: State, shared: &Shared<T>) -> bool {
        match (self, state) {
            (Self::Active(active), State::KeepingStation) => {
                active.station = StationKeeping::Keeping(Station::new());
            }
            (Self::Active(active), State::Active) => {
                let target = shared.target.as_ref();
                active
                    .station
                    .release(target.map(|target| &target.unstretched_m));
            }
            _ => return false,
        }
        true
    }

    /// What the motors do that a leg which is held goes on with while it brakes. Those of a leg at rest follow its load and its swing by
    /// the load cells: once one of these is in doubt, that is not gone on with. Nor is it where a motor's current is in doubt: one whose counter counts
    /// the other way would be driven on while the leg brakes.
    #[inline(always)]
    pub fn momentum(&self, shared: &Shared<T>, trust: Trust) -> Momentum<T> {
        let doubted = !(trust.cells && trust.currents);
        let steps_m = match self {
            Self::Active(active) if doubted && !active.has_set_out() => [T::zero(); 3],
            _ => shared.axes.each_ref().map(Axis::moved_m),
        };
        let ticks_to_end = match self {
            // One at rest has no way to go: it stops what brakes its swing.
            Self::Active(active) if !active.has_set_out() => Some(0),
            Self::Active(active) => active.trajectory.ticks_to_end(),
            // A leg that homes has no end to go to, and hangs free: whatever its motor goes on lifts it.
            Self::Homing(_) => Some(ENDING_TICKS),
            _ => None,
        };
        Momentum {
            steps_m,
            ticks_to_end,
        }
    }

    /// The mode of a state that begins now, after what the motors did in the last tick.
    pub fn begin(
        state: State,
        shared: &mut Shared<T>,
        measured: &Measured<T>,
        momentum: Momentum<T>,
        trust: Trust,
    ) -> Self {
        shared.forget_slack(state, trust.unfaulted, measured);
        if state == State::Held && trust.counters {
            // Where a current is in doubt a motor may not obey, or a sensor is wrong.
            let obeyed = trust.currents || is_obeyed(shared);
            let held = Held::braking(shared, momentum, !(trust.free && obeyed));
            if held.brakes() {
                if trust.cells {
                    shared.lowest_m = held.lowest_m(&measured.pulled_m);
                } else {
                    shared.ignore_tensions();
                }
                return Self::Held(held);
            }
        }
        shared.come_to_rest(state, measured);
        match state {
            State::Boot => Self::boot(),
            State::Disarmed => Self::Disarmed,
            State::Homing => {
                shared.failed_tendon = 0;
                // Whoever left the load out may not be there any more, and what the leg shows after homing is looked at.
                shared.compensation = Compensation::Estimated;
                let limits = &shared.limits;
                Self::Homing(HomingSequence::new(
                    &limits.homing,
                    &measured.pulled_m,
                    limits.jogs.each_ref().map(HaulLimit::new),
                    shared.dead_band_m(),
                ))
            }
            State::Active => Self::Active(Active::begin(shared, measured)),
            State::Held => Self::Held(Held::resting()),
            State::RampingDown => Self::RampingDown(RampingDown::new(
                &shared.limits,
                measured.pulled_m,
                trust.pose,
            )),
            // A jog begins by its command alone, which has its demand; station is kept from the active mode alone.
            State::Off | State::Jogging | State::KeepingStation => Self::Off,
        }
    }
}

/// What a mode that begins may rely on.
#[derive(Clone, Copy, Debug)]
pub struct Trust {
    /// The pose: every tendon pulls, the sensors agree, and no fault is latched.
    pub pose: bool,
    /// The counters: no fault is latched that they may cause.
    pub counters: bool,
    /// The leg: nothing is known that may hold it. A hand that holds the tip of a moving leg leaves a tendon slack first, while the others are
    /// stretched by all that their motors still go.
    pub free: bool,
    /// The currents: none disagrees with its tension.
    pub currents: bool,
    /// The load cells: no fault is latched that one may cause.
    pub cells: bool,
    /// Whether no fault is latched but limits.
    pub unfaulted: bool,
}

/// What one tick of a mode comes to.
#[derive(Clone, Copy, Debug)]
pub struct ModeStep {
    /// What went wrong in it.
    pub faults: FaultSet,
    /// What ends the mode, if anything does.
    pub event: Option<Event>,
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Mode, Trust};
    use crate::control::Measured;
    use crate::leg::active::Active;
    use crate::leg::shared::{Checked, Shared};
    use crate::settings::Settings;
    use crate::supervisor::State;
    use leg_model::Direction;

    const MEASURED: Measured<f64> = Measured::resting([0.01; 3], [30.0; 3]);

    fn armed() -> (Active<f64>, Shared<f64>) {
        let settings = Settings::table_1().unwrap();
        let mut shared = Shared::new(&settings, Checked::new(&settings).unwrap());
        let active = Active::begin(&mut shared, &MEASURED);
        (active, shared)
    }

    /// A leg on its way is braked from its speed, whatever its cells and its currents show. One at rest, or that waits to set out, is braked from what its
    /// cells had its motors do, unless they or a motor are in doubt.
    #[test]
    fn a_leg_at_rest_goes_on_with_nothing_while_a_sensor_is_doubted() {
        for (sent, pretensioned, cells, currents, goes_on) in [
            (false, true, true, true, true),
            (false, true, false, true, false),
            (false, true, true, false, false),
            (true, false, true, true, true),
            (true, false, false, true, false),
            (true, false, true, false, false),
            (true, true, true, true, true),
            (true, true, false, false, true),
        ] {
            let (mut active, mut shared) = armed();
            active.pretensioned = pretensioned;
            if sent {
                active.go(&mut shared, &Direction::from_xy(0.1, 0.0).unwrap());
            }
            assert_eq!(active.moving(), sent);
            let step_m = 1e-6;
            for tick in 0..1000 {
                shared.axes[1].track(f64::from(tick) * step_m);
            }
            shared.axes[1].lead_by(step_m);
            let trust = Trust {
                pose: true,
                counters: true,
                free: true,
                currents,
                cells,
                unfaulted: true,
            };
            let [_, found_m, _] = Mode::Active(active).momentum(&shared, trust).steps_m;
            let expected_m = if goes_on { step_m } else { 0.0 };
            assert!(
                (found_m - expected_m).abs() < 1e-9,
                "{sent} {pretensioned} {cells} {currents}"
            );
        }
    }

    /// A leg that keeps station follows no command until it is armed again.
    #[test]
    fn a_leg_that_keeps_station_says_so() {
        let (active, shared) = armed();
        let mut mode = Mode::Active(active);
        assert_eq!(mode.state(), State::Active);
        for state in [State::KeepingStation, State::Active] {
            assert!(mode.change_station(state, &shared));
            assert_eq!(mode.state(), state);
        }
        assert!(!mode.change_station(State::Held, &shared));
    }
}
