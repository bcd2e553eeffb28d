//! A leg without a board: the simulated mechanism, scenarios, and the firmware in this process.
//!
//! Where to begin: a [`scenario::Scenario`] says how a leg starts, what is done to it and what must come out. A
//! [`simulation::Simulation`] runs it with the firmware behind a [`link::Link`], and gives a [`simulation::Summary`]:
//!
//! ```
//! use leg_rig::rig_file::RigFile;
//! use leg_sim::link::InProcess;
//! use leg_sim::scenario::Scenario;
//! use leg_sim::simulation::Simulation;
//!
//! let text = r#"
//! title = "A leg hangs at its pretension"
//! steps = [
//!     { wait_s = 0.1 },
//!     { measure = { name = "highest tension", quantity = "tension_max_n", between = [69, 71] } },
//! ]
//! "#;
//! let scenario = Scenario::parse("example.toml", text).expect("it is well formed");
//! let rig = RigFile::load(None).expect("the paper's rig is built in");
//! let simulation = Simulation::new(&scenario, &rig)?;
//! let summary = simulation.run(&mut InProcess::new(), &mut |_| ())?;
//! assert!(summary.passes());
//! # Ok::<(), leg_sim::simulation::SimulationError>(())
//! ```
//!
//! | module | what is in it |
//! |---|---|
//! | [`plant`] | rigid body, tendons, motors, gears, screws and sensors, with their defects |
//! | [`action`] | what can be done to the plant from outside, in scenarios and on the lines of `leg emulate` |
//! | [`link`] | requests to the firmware and its replies, wherever it runs |
//! | [`emulated_leg`] | firmware and plant, tick by tick: the one place where they meet |
//! | [`hosted_leg`] | an emulated leg with its host, for programs that step one themselves |
//! | [`path_sender`] | a path as a stream of set-points, each sent in time |
//! | [`signals`] | every signal of a leg, declared once: reports, recordings, charts |
//! | [`scenario`], [`ready_scenarios`] | scenario files, and those that come with the program |
//! | [`shadow`] | the control law in f64 beside a leg, and how far that gets from it |
//! | [`simulation`] | a scenario with an emulated leg and its shadow |

pub mod action;
pub mod emulated_leg;
pub mod host;
pub mod hosted_leg;
pub mod link;
pub mod path_sender;
pub mod plant;
mod range;
pub mod ready_scenarios;
mod sag_model;
pub mod scenario;
pub mod shadow;
pub mod signals;
pub mod simulation;
