//! The window: a leg in 3D that is driven, broken and charted, natively and in a browser.
//!
//! Where to begin: [`simulation`] steps firmware and simulated leg in real time, [`live_leg`] hears one elsewhere; [`app`] shows either.
//!
//! What the page's first steps show, without a page:
//!
//! ```
//! use leg_firmware::command::{Command, Compensation};
//! use leg_window::simulation::Simulation;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut leg = Simulation::new()?;
//! let rest = |leg: &mut Simulation| (0..200).for_each(|_| leg.advance(0.02));
//! leg.hang(2.0);
//! rest(&mut leg);
//! let sag_mm = leg.leg().comparison().commanded_error_mm();
//! leg.command(Command::Compensation(Compensation::Estimated), "compensation on");
//! rest(&mut leg);
//! let left_mm = leg.leg().comparison().commanded_error_mm();
//! assert!(sag_mm > 6.5 && left_mm < 0.3, "{sag_mm} mm, {left_mm} mm");
//! # Ok(())
//! # }
//! ```
//!
//! | module | what is in it |
//! |---|---|
//! | [`simulation`], [`pace`], [`history`] | the leg, how much of it a frame is worth, and what its signals were |
//! | [`live_leg`], [`shown_leg`], [`seen_leg`], [`orders`] | a leg behind `leg ui`; what both are for the panels, and for the picture; commands on their way |
//! | [`app`], [`layout`], [`top_bar`], `panel_…`, [`numbers`], [`faults`], [`fault_strip`], [`fault_words`] | what is where |
//! | [`scene`], `drawn_leg`, [`camera`], [`figure`], [`leg_pose`], [`stiffness_ellipse`] | the leg in 3D |
//! | [`workspace`], [`map`], [`map_key`], [`map_mesh`] | the disc on which the target is dragged, and what the model says of every pose |
//! | [`charts`] | signals over time |
//! | [`recorder`], [`recordings`], [`recording_reader`], [`recorded_leg`], [`player`] | recordings: made, saved, read, played |
//! | [`setup`], [`rig_intake`], [`files`], [`notice`] | rig files and settings: given, edited, saved, applied; what became of it |
//! | [`theme`], [`text`], [`keys`], [`utc`], [`wall_clock`] | colours, sizes, text in its place; the keys that stop; the date, the time of the day |
//! | [`bits`] | whether the firmware decides the same here as elsewhere |
//! | [`page_state`], [`places`], [`work`], [`frame_cost`] | the window as data, for tests and for readers of the screen; how long its frames take |

pub mod app;
pub mod bits;
pub mod camera;
pub mod charts;
mod drawn_leg;
pub mod fault_strip;
pub mod fault_words;
pub mod faults;
pub mod figure;
pub mod files;
pub mod frame_cost;
pub mod history;
pub mod keys;
pub mod layout;
pub mod leg_pose;
pub mod live_leg;
pub mod map;
pub mod map_key;
pub mod map_mesh;
pub mod notice;
pub mod numbers;
pub mod orders;
pub mod pace;
pub mod page_state;
pub mod panel_break;
pub mod panel_drive;
pub mod panel_guide;
pub mod panel_unlock;
pub mod places;
pub mod player;
pub mod pointer;
pub mod recorded_leg;
pub mod recorder;
pub mod recording_reader;
pub mod recordings;
pub mod rig_intake;
pub mod scene;
pub mod scrolled;
pub mod seen_leg;
pub mod setup;
pub mod shown_leg;
pub mod simulation;
pub mod stiffness_ellipse;
pub mod text;
pub mod theme;
pub mod top_bar;
pub mod utc;
pub mod value_slider;
pub mod wall_clock;
#[cfg(target_arch = "wasm32")]
pub mod web;
pub mod work;
pub mod workspace;
