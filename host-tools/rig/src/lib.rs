//! Rig files and settings: what a leg is, read from TOML, checked, shown and written back.

pub mod actuator;
pub mod calibration;
pub mod control_section;
pub mod control_settings;
pub mod curve_toml;
pub mod fields;
pub mod gains;
pub mod line_error;
pub mod plant_settings;
pub mod ready_rigs;
pub mod rig_convert;
pub mod rig_file;
pub mod rig_settings;
pub mod rig_show;
pub mod rounding;
pub mod settings_text;
pub mod support_name;
pub mod toml_problem;
pub mod toml_section;
