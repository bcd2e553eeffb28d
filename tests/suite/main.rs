//! The tests across the crates, by subject, in one program: `cargo test --test suite -- model::errata` runs a part.

mod common;
mod structure;

mod model {
    mod any_input;
    mod arithmetic;
    mod bending;
    mod closed_forms;
    mod compensation;
    mod derivatives;
    mod elastic_joints;
    mod errata;
    mod errata_stiffness;
    mod flexure_limits;
    mod flexures;
    mod random_rigs;
    mod refused_queries;
    mod round_trip;
    mod statics;
    mod stiffness_command;
    mod tendon_curves;
    mod tension_distribution;
}

mod firmware {
    mod axis;
    mod board_contract;
    mod board_documents;
    mod control_law;
    mod default_settings;
    mod disarm;
    mod doubts;
    mod encoder_jump;
    mod point_arrival;
    mod residual;
    mod safe_states;
    mod safety_page;
    mod set_points;
    mod still_leg;
    mod trajectories;
    mod true_set_points;
    mod wild_points;
}

mod base {
    mod atomic_file;
    mod numeric;
    mod recorder_rows;
    mod refusal;
    mod suggest;
    mod timed_path;
}

mod rig {
    mod other_legs;
    mod other_motors;
    mod other_tendons;
    mod own_motors;
    mod random_rigs;
    mod refused_rigs;
    mod rig_settings;
}

mod sim {
    mod armed_often;
    mod braking;
    mod circles;
    mod commanded_often;
    mod comparison;
    mod current_outputs;
    mod current_zeros;
    mod fmea_page;
    mod half_swings;
    mod held_leg;
    mod homing_with_faults;
    mod late_points;
    mod load_left_out;
    mod lost_numbers;
    mod lost_target;
    mod move_times;
    mod other_answers;
    mod ramped_pretension;
    mod random_scenarios;
    pub mod ready_runs;
    mod ring_down;
    mod scenario_bits;
    mod scenarios;
    mod short_scenarios;
    mod station;
    mod station_defects;
    mod station_rigs;
    mod station_ring_down;
    pub mod station_stand;
    mod stiffness_floor;
    mod streamed_tension;
    mod strike_bars_page;
    mod swaying_stream;
    mod swing;
    mod tension_limits;
    mod tensioning;
    mod unstable_loop;
    mod ways_down;
}

mod board {
    pub mod bits_under_qemu;
    mod chip_boot;
    mod chip_bus;
    mod chip_cuts;
    mod chip_fatal;
    mod chip_guards;
    mod chip_hang;
    mod chip_latency;
    mod chip_line;
    mod chip_mistakes;
    mod chip_recorder;
    mod chip_scenarios;
    mod chip_signals;
    mod chip_speed;
    mod chip_supply;
    mod chip_transcript;
    pub mod emulated_board;
    mod qemu_session;
    mod setup;
    mod wiring_page;
}

mod recording {
    mod player;
    mod recorded;
    mod replayed;
    mod samples;
}

mod host {
    mod can_bus;
    mod flash;
    mod follow_tension;
    mod jog;
    mod link_damage;
    mod monitor_screen;
    mod plot;
    mod protocol_page;
    mod slow_settings;
    mod telemetry_page;
    pub mod tune;
    mod ui;
    mod ui_live;
}

mod bench {
    mod bode;
    mod check;
    mod cut_off_strikes;
    mod cut_tendons;
    mod false_alarms;
    mod image_budget;
    mod moves;
    mod proof;
    mod server;
    pub mod strikes;
}

mod commands {
    mod broken_ends;
    mod golden;
    mod json_entries;
    mod supports;
    mod written_whole;
}

/// Other programs read what this one writes: they need Python, and run by
/// `cargo test --test suite -- --ignored other_programs`.
mod other_programs {
    mod mjcf;
    mod protocol_client;
    mod recordings;
    mod urdf;
}
