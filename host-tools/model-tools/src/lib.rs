//! The f64 model at work on the host: what a researcher asks of a rig, each as a library call that the command line only
//! prints.
//!
//! | to get | begin at | command |
//! |---|---|---|
//! | the tip's deviation without linearisation | [`nonlinear::deviation_m`] | `leg eval` |
//! | a pose from a line of JSON | [`jsonl::PoseLine`] | `leg eval` |
//! | a quantity over the workspace, its extremes, a table of it | [`workspace_map::WorkspaceMap`], [`map_csv`] | `leg map` |
//! | a tendon's curve from a tensile test | [`tensile::Fit`] | `leg curve` |
//! | a MuJoCo model, a URDF robot | [`mjcf::Mjcf`], [`urdf::Urdf`] | `leg export` |
//! | a picture of the leg | [`rig_drawing::svg`] | `leg rig draw` |
//! | Eqs. (3–7) as they stand, to check the model by | [`plain_vectors`] | none: tests |
//!
//! All of them take a rig as `leg_rig` reads it; the numbers come from `leg_model`.
//!
//! ```
//! use leg_model::evaluate;
//! use leg_model_tools::nonlinear;
//! use leg_rig::rig_file::RigFile;
//!
//! // The paper's rig, leaning 30° towards 30° with 2 kg at its tip.
//! let rig = RigFile::load(None)?;
//! let query = rig.query(30.0, 30.0, 2.0);
//! let linear_m = evaluate(&rig.parameters, &query)?.deviation_m;
//! let nonlinear_m = nonlinear::deviation_m(&rig.parameters, &query)?;
//! // Linearisation overestimates so large a deviation: the tendons that are stretched most get stiffer.
//! assert!(nonlinear_m.is_some_and(|nonlinear_m| 0.8 * linear_m < nonlinear_m && nonlinear_m < linear_m));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod json_entries;
pub mod jsonl;
pub mod leg_shape;
pub mod line_error;
pub mod map_csv;
pub mod mjcf;
pub mod nonlinear;
pub mod plain_vectors;
pub mod rig_drawing;
pub mod tensile;
pub mod urdf;
pub mod workspace_map;
mod xml_element;
