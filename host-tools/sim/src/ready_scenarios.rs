//! The scenarios that come with the program.

/// A ready scenario.
#[derive(Clone, Copy, Debug)]
pub struct ReadyScenario {
    /// Its name.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! ready {
    ($($name:literal),* $(,)?) => {
        &[$(ReadyScenario { name: $name, text: include_str!(concat!("../../scenarios/", $name, ".toml")) }),*]
    };
}

/// Every ready scenario; the first is the default.
pub const READY_SCENARIOS: &[ReadyScenario] = ready![
    "fig9",
    "cost",
    "cost_homing",
    "cost_follow",
    "cost_station",
    "homing",
    "homing_again",
    "other_tendons",
    "tour",
    "stiffness",
    "stiffness_lean",
    "payload",
    "station",
    "support",
    "hold",
    "arm_lean",
    "trim",
    "workspace",
    "circle",
    "jog",
    "fault_bad_frame",
    "fault_cell_dead",
    "fault_cell_saturated",
    "fault_cell_stale",
    "fault_cell_stuck",
    "fault_command_timeout",
    "fault_current_disagrees",
    "fault_driver_fault",
    "fault_emergency_stop",
    "fault_encoder_jump",
    "fault_encoder_lost",
    "fault_encoder_reversed",
    "fault_encoder_slips",
    "fault_encoder_still",
    "fault_following",
    "fault_homing_failed",
    "fault_infeasible",
    "fault_infeasible_load",
    "fault_late_tick",
    "fault_not_taut",
    "fault_over_current",
    "fault_over_temperature",
    "fault_over_tension",
    "fault_off_station",
    "fault_point_missing",
    "fault_pose_lost",
    "fault_residual",
    "fault_runs_away",
    "fault_settings_corrupt",
    "fault_slack",
    "fault_supply_high",
    "fault_supply_low",
    "fault_swings",
    "fault_tension_jump",
    "fault_unreachable"
];

/// The ready scenario of a name.
#[must_use]
pub fn named(name: &str) -> Option<ReadyScenario> {
    READY_SCENARIOS
        .iter()
        .copied()
        .find(|ready| ready.name == name)
}

/// All names, for messages.
#[must_use]
pub fn names() -> String {
    let names: Vec<_> = READY_SCENARIOS.iter().map(|ready| ready.name).collect();
    names.join(", ")
}
