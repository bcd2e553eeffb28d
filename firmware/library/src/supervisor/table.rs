//! The fault table: what each fault is, what raises it, and how it ends.

use super::Fault;

/// A row of the table. Code and reaction are the fault's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultEntry {
    /// The fault.
    pub fault: Fault,
    /// Its name in words.
    pub name: &'static str,
    /// What raises it, with the setting that decides.
    pub cause: &'static str,
    /// What to do about it.
    pub remedy: &'static str,
}

macro_rules! table {
    ($($fault:ident: $name:literal, $cause:literal, $remedy:literal;)*) => {
        [$(FaultEntry { fault: Fault::$fault, name: $name, cause: $cause, remedy: $remedy },)*]
    };
}

/// Every fault, in the order of the codes.
pub const TABLE: [FaultEntry; Fault::ALL.len()] = table! {
    Slack: "slack tendon", "a tension stays below slack_n for slack_time_s, or does not come up within taut_time_s after an arm", "look whether the tendon is cut or off its anchor";
    OverTension: "too much tension", "a tension is above the maximum tension by over_tension_part", "look what pulls at the leg; check the load cell";
    TensionJump: "jump of a tension", "a tension changes by jump_n within a millisecond", "look for a cut or slipped tendon";
    Residual: "sensors disagree on the pose", "forward kinematics leaves over more than residual_m for residual_time_s", "home the leg; check the encoders, the load cells and the tendon curves";
    CellStale: "stale load cell", "a load cell gives no fresh code for stale_time_s", "check its converter and wiring";
    CellStuck: "stuck load cell", "a load cell's code does not change for stuck_time_s", "check its amplifier";
    CellSaturated: "saturated load cell", "a load cell's code is at an end of its range", "check its wiring; choose a wider range";
    CurrentDisagrees: "current and tension disagree", "a motor draws disagreement_a more than its tension and friction ask, for disagreement_time_s", "look for a stiff screw or a wrong current sensor";
    Following: "motor stays behind", "a motor is following_m away from where it is led", "look for a slipping encoder or a stiff screw; move more slowly";
    EncoderStill: "motor does not turn", "a motor is driven with driven_part of its current and counts nothing for still_time_s", "check the encoder's wiring; look for a jam";
    EncoderReversed: "motor turns the wrong way", "a motor counts against its voltage for reversed_time_s", "swap the motor's wires or the sign of m_per_count";
    PoseLost: "pose is lost", "forward kinematics or a tendon's curve gives no result", "home the leg; check the tensions";
    Infeasible: "target out of reach", "no pretension holds the target within the bounds, or a move leads beyond the workspace", "give another pose or a smaller payload";
    Unreachable: "stiffness out of reach", "the bounds on the tensions stop the pretension short of the demand, or the trim is at trim_max_n", "demand something nearer to what was reached; check load cells and tendon curves";
    OverCurrent: "too much current", "a motor draws more than current_a for 2 ms", "look for a short circuit, or a current sensor without power";
    OverTemperature: "too hot", "the drivers are above temperature_c", "let them cool";
    SupplyLow: "supply too low", "the supply is below supply_min_v", "check supply and battery";
    SupplyHigh: "supply too high", "the supply is above supply_max_v", "check the supply; a braking motor feeds back into it";
    LateTick: "late tick", "a tick of the control law began or ended too late", "look in the log for the longest tick; flash a build with optimisation; keep debuggers away";
    CommandTimeout: "no command", "the host is silent for command_time_s while the leg is armed", "check the link and the host: it has to speak more often";
    BadFrame: "bad frames", "bad_frames frames in a row could not be read", "check the link";
    DriverFault: "driver fault", "a motor driver raises its fault line", "look up the driver's own fault";
    EmergencyStop: "emergency stop", "the emergency stop is pressed", "release it when it is safe";
    SettingsCorrupt: "settings corrupt", "the stored settings are not whole or not valid", "write the settings anew";
    HomingFailed: "homing failed", "a tendon does not become slack, or then taut, within travel_m, pulls more than twice the homing ceiling, or a slack load cell is off by tare_max_n", "let the leg hang free, without a payload; check the load cells";
};

impl Fault {
    /// Its row of the table.
    #[must_use]
    pub fn entry(self) -> &'static FaultEntry {
        let [first, ..] = &TABLE;
        TABLE.get(usize::from(self.code()) - 1).unwrap_or(first)
    }
}

#[cfg(test)]
mod tests {
    use super::{Fault, TABLE};

    #[test]
    fn every_fault_has_its_row() {
        for (fault, row) in Fault::ALL.into_iter().zip(TABLE) {
            assert_eq!(row.fault, fault);
            assert_eq!(*fault.entry(), row);
            assert!(!row.name.is_empty() && !row.cause.is_empty() && !row.remedy.is_empty());
        }
    }
}
