//! The fault table: one row declares all there is to know of a fault.

use super::reaction::{Clearing, Reaction};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// A row of the fault table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultEntry {
    /// The fault; its number is the code.
    pub fault: Fault,
    /// Its name as a user reads it.
    pub name: &'static str,
    /// What it leads to.
    pub reaction: Reaction,
    /// What raises it, with the setting that decides.
    pub cause: &'static str,
    /// What to do about it.
    pub remedy: &'static str,
    /// What ends it.
    pub clears: Clearing,
}

/// Makes [`Fault`] and [`FAULT_TABLE`] of the rows. A row without one of its columns does not compile.
macro_rules! faults {
    ($($code:literal $fault:ident {
        name: $name:literal,
        reaction: $reaction:ident,
        cause: $cause:literal,
        remedy: $remedy:literal,
        clears: $clears:ident,
    })*) => {
        /// A fault. Its number is its code; [`Self::entry`] says what it means.
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, Schema,
        )]
        #[serde(rename_all = "snake_case")]
        #[repr(u8)]
        pub enum Fault {
            $(#[doc = $cause] $fault = $code,)*
        }

        impl Fault {
            /// Every fault, in the order of the codes.
            pub const ALL: [Self; [$($code),*].len()] = [$(Self::$fault),*];

            /// Its row of the table.
            #[must_use]
            pub const fn entry(self) -> &'static FaultEntry {
                match self {
                    $(Self::$fault => &FaultEntry {
                        fault: Self::$fault,
                        name: $name,
                        reaction: Reaction::$reaction,
                        cause: $cause,
                        remedy: $remedy,
                        clears: Clearing::$clears,
                    },)*
                }
            }
        }

        /// Every fault, in the order of the codes.
        pub const FAULT_TABLE: [&FaultEntry; Fault::ALL.len()] = [$(Fault::$fault.entry()),*];
    };
}

faults! {
    1 Slack {
        name: "slack tendon",
        reaction: Hold,
        cause: "a tension stays below slack_n for slack_time_s, or does not come up within taut_time_s after an arm",
        remedy: "look whether the tendon is cut or off its anchor",
        clears: Command,
    }
    2 OverTension {
        name: "too much tension",
        reaction: RampDown,
        cause: "a tension is above the maximum tension by over_tension_part for 2 ms, and the counters agree (closely, where the leg is held), or the leg homes",
        remedy: "look what pulls at the leg; check the load cell",
        clears: Command,
    }
    3 TensionJump {
        name: "jump of a tension",
        reaction: Hold,
        cause: "a tension changes by jump_n within a millisecond, or by three tenths of it while lengths and tensions come to disagree",
        remedy: "look for a cut or slipped tendon; where the tension does not come back, disarm the leg, clear the fault and home; where it does, clear the fault",
        clears: Command,
    }
    4 Residual {
        name: "sensors disagree on the pose",
        reaction: Hold,
        cause: "forward kinematics leaves over more than residual_m for residual_time_s, or residual_change_m more without motion or load; a tension is over_tension_part above the maximum while that is in doubt; or a leg shows a load after homing",
        remedy: "disarm the leg, clear the fault and home; check encoders, load cells and tendon curves",
        clears: Command,
    }
    5 CellStale {
        name: "stale load cell",
        reaction: Hold,
        cause: "a load cell gives no fresh code for stale_time_s",
        remedy: "check its converter and wiring",
        clears: Command,
    }
    6 CellStuck {
        name: "stuck load cell",
        reaction: Hold,
        cause: "a load cell's code does not change for stuck_time_s",
        remedy: "check its amplifier",
        clears: Command,
    }
    7 CellSaturated {
        name: "saturated load cell",
        reaction: Hold,
        cause: "a load cell's code is at an end of its range",
        remedy: "check its wiring; choose a wider range",
        clears: Command,
    }
    8 CurrentDisagrees {
        name: "current and tension disagree",
        reaction: Hold,
        cause: "a motor draws disagreement_a more than its tension and friction ask, or less than its voltage drives through a warm winding, for disagreement_time_s; for still_time_s where much is lacking or nothing is counted",
        remedy: "look for an encoder that does not count, a stiff screw, a wrong current sensor or an open wire of the motor",
        clears: Command,
    }
    9 Following {
        name: "motor stays behind",
        reaction: Hold,
        cause: "a motor is following_m away from where it is led; or, in a leg at rest whose load is not estimated or too heavy, a tendon at the maximum tension is paid out by 0.05 mm",
        remedy: "look for a slipping encoder or a stiff screw; move more slowly; at the maximum tension, have the load estimated or lower the pretension",
        clears: Command,
    }
    10 EncoderStill {
        name: "motor does not turn",
        reaction: GateOff,
        cause: "a motor is driven with driven_part of its current, and more than the maximum tension asks of it, draws it, and counts nothing for still_time_s",
        remedy: "check the encoder's wiring; look for a jam",
        clears: Command,
    }
    11 EncoderReversed {
        name: "motor turns the wrong way",
        reaction: GateOff,
        cause: "a motor counts against its voltage for reversed_time_s",
        remedy: "swap the motor's wires or change its counts_sign, then clear the fault and home",
        clears: Command,
    }
    12 PoseLost {
        name: "pose is lost",
        reaction: Hold,
        cause: "forward kinematics or a tendon's curve gives no result",
        remedy: "disarm the leg, clear the fault and home; check the tensions",
        clears: Command,
    }
    13 Infeasible {
        name: "target out of reach",
        reaction: Limit,
        cause: "no pretension holds the target within the bounds, or a move leads beyond the workspace",
        remedy: "give another pose or a smaller payload",
        clears: CauseGone,
    }
    14 Unreachable {
        name: "stiffness out of reach",
        reaction: Limit,
        cause: "the bounds on the tensions stop the pretension short of the demand, or the trim is at trim_max_n",
        remedy: "demand something nearer to what was reached; check load cells and tendon curves",
        clears: CauseGone,
    }
    15 OverCurrent {
        name: "too much current",
        reaction: GateOff,
        cause: "a motor draws more than current_a for 2 ms",
        remedy: "look for a short circuit, or a current sensor without power",
        clears: Command,
    }
    16 OverTemperature {
        name: "too hot",
        reaction: Hold,
        cause: "the drivers are above temperature_c",
        remedy: "let them cool",
        clears: Command,
    }
    17 SupplyLow {
        name: "supply too low",
        reaction: Hold,
        cause: "while the drivers are on, the supply is below supply_min_v or the board's own 3.3 V are too low",
        remedy: "check the motor supply, its contactor and fuses, and the board's 3.3 V",
        clears: Command,
    }
    18 SupplyHigh {
        name: "supply too high",
        reaction: Hold,
        cause: "the supply is above supply_max_v, or the board's own 3.3 V are too high",
        remedy: "check the supply and the board's 3.3 V; a braking motor feeds back into the supply",
        clears: Command,
    }
    19 LateTick {
        name: "late tick",
        reaction: Hold,
        cause: "a tick of the control law began or ended too late",
        remedy: "look in the log for the longest tick; flash a build with optimisation; keep debuggers away",
        clears: Command,
    }
    20 CommandTimeout {
        name: "no command",
        reaction: Hold,
        cause: "the host is silent for command_time_s while the leg homes, follows commands or jogs",
        remedy: "check the link and the host: it has to speak more often",
        clears: Command,
    }
    21 BadFrame {
        name: "bad frames",
        reaction: Limit,
        cause: "bad_frames frames in a row could not be read",
        remedy: "check the link",
        clears: CauseGone,
    }
    22 DriverFault {
        name: "driver fault",
        reaction: GateOff,
        cause: "a motor driver raises its fault line",
        remedy: "look up the driver's own fault",
        clears: Command,
    }
    23 EmergencyStop {
        name: "emergency stop",
        reaction: GateOff,
        cause: "the emergency stop is pressed",
        remedy: "release it when it is safe",
        clears: Command,
    }
    24 SettingsCorrupt {
        name: "settings corrupt",
        reaction: GateOff,
        cause: "the stored settings are not whole or not valid",
        remedy: "write the settings anew",
        clears: Command,
    }
    25 HomingFailed {
        name: "homing failed",
        reaction: RampDown,
        cause: "a tendon does not become slack, or then taut, within travel_m, pulls more than twice the maximum tension of homing, its motor draws the current of that, a slack load cell is off by tare_max_n, or one shows half a touch_n where its tendon is slack",
        remedy: "let the leg hang free, without a payload; check the load cells",
        clears: Command,
    }
    26 EncoderJump {
        name: "encoder jumps",
        reaction: GateOff,
        cause: "a counter goes farther than its motor can turn",
        remedy: "check the encoder's wiring and its shield, then clear the fault and home",
        clears: Command,
    }
    27 RunsAway {
        name: "motor runs away",
        reaction: GateOff,
        cause: "a motor is three quarters of following_m away from where it is led, nine tenths where it pays out, and goes farther",
        remedy: "check the driver and the motor's wires",
        clears: Command,
    }
    28 PointMissing {
        name: "set-point missing",
        reaction: Limit,
        cause: "a stream of set-points ends without its last one: the leg comes to rest after the last that came",
        remedy: "send set-points earlier; begin a new stream",
        clears: CauseGone,
    }
    29 OffStation {
        name: "too far off station",
        reaction: Hold,
        cause: "a leg that keeps station would go farther than 3° from where it was left, by its load or by what a load cell makes of it",
        remedy: "look what pulls at the leg, and check the load cells; move the leg again",
        clears: Command,
    }
    30 Swings {
        name: "leg swings",
        reaction: Hold,
        cause: "the tip of a leg that rests swings by about 0.3 mm or more, or of one on its way by about 1 mm, and does not ring down for 1.8 s, or for less where the swing grows",
        remedy: "see that each load cell is on its own tendon; look what shakes the leg; check gains and damping_ratio with `leg bode`",
        clears: Command,
    }
}

impl Fault {
    /// Its code.
    #[must_use]
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// What it leads to.
    #[must_use]
    pub const fn reaction(self) -> Reaction {
        self.entry().reaction
    }
}

#[cfg(test)]
mod tests {
    use super::{Clearing, FAULT_TABLE, Fault, FaultEntry, Reaction};
    use crate::supervisor::{Event, State};

    #[test]
    fn every_fault_has_its_row() {
        for ((fault, row), code) in Fault::ALL.into_iter().zip(FAULT_TABLE).zip(1..) {
            assert_eq!((row.fault, fault.code()), (fault, code));
            assert!(!row.name.is_empty() && !row.cause.is_empty() && !row.remedy.is_empty());
        }
    }

    /// A leg that goes on as far as it can may forget a fault with its cause; one that was stopped waits for its host.
    #[test]
    fn only_a_limit_clears_without_a_command() {
        for row in FAULT_TABLE {
            let limits = row.reaction == Reaction::Limit;
            assert_eq!(row.clears == Clearing::CauseGone, limits, "{}", row.name);
        }
    }

    /// Where a leg comes to that does what a remedy says, in that order; none where it does not take a step.
    fn follow(row: &FaultEntry) -> Option<State> {
        let mut state = State::Active.next(Event::Reaction(row.reaction))?;
        for word in row.remedy.split(|letter: char| !letter.is_alphabetic()) {
            state = match word {
                "disarm" => state.next(Event::Disarm)?.next(Event::Relaxed)?,
                // A fault of a leg that is disarmed is cleared without another state.
                "clear" => state.next(Event::Clear).unwrap_or(state),
                "home" => state.next(Event::Home)?,
                _ => state,
            };
        }
        Some(state)
    }

    #[test]
    fn a_remedy_that_homes_names_every_step_to_it() {
        let homing = FAULT_TABLE
            .into_iter()
            .filter(|row| row.remedy.contains("home"));
        let mut count = 0;
        for row in homing {
            assert_eq!(follow(row), Some(State::Homing), "{}", row.name);
            assert!(row.remedy.contains("clear the fault and home"));
            count += 1;
        }
        assert_eq!(count, 5);
    }
}
