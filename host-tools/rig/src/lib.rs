//! Rig files and settings: what a leg is, read from TOML, checked, shown, written back, and measured on the leg itself.
//!
//! Begin with [`RigFile`](rig_file::RigFile): [`load`](rig_file::RigFile::load) takes a file or the name of a
//! [ready rig](ready_rigs::READY_RIGS), and refuses what is wrong at its line and column.
//! [`settings`](control_settings::settings) makes of it what a board is set to, and
//! [`settings_text`] writes that as a rig file again. [`tune`] measures motors
//! and first mode by a [`TunedLeg`](tune::TunedLeg).
//!
//! ```
//! use leg_rig::control_settings::settings;
//! use leg_rig::rig_file::RigFile;
//!
//! let rig = RigFile::load(Some("spherical".as_ref()))?;
//! assert_eq!(rig.parameters.leg_mass_kg, 1.5);
//! let settings = settings(&rig, &rig.gains, None);
//! assert!(settings.check().is_ok());
//! assert!(leg_rig::settings_text::rig_file(&settings).contains("kind = \"spherical\""));
//! # Ok::<(), leg_base::failure::Failure>(())
//! ```
//!
//! Every value that may be left out is one line of a table ([`fields!`](leg_firmware::fields)) with its name, unit, range,
//! default and meaning: gains and calibration in [`leg_firmware::settings`], [`actuator`] and [`plant_settings`] here. The
//! table drives reading (`toml_section`), listing ([`rig_settings`]) and writing.

pub mod actuator;
pub mod calibration;
pub mod cell_fit;
pub mod control_settings;
pub mod current_output;
pub mod curve_toml;
pub mod gains;
pub mod loop_response;
pub mod mechanism_keys;
pub mod motor_sections;
pub mod motor_turn;
pub mod number;
pub mod plant_settings;
pub mod ready_rigs;
pub mod recorded_signals;
pub mod renamed_keys;
pub mod rig_convert;
pub mod rig_file;
pub mod rig_settings;
pub mod rig_show;
pub mod settings_difference;
pub mod settings_text;
pub mod support_name;
pub mod toml_error;
mod toml_section;
pub mod tune;
