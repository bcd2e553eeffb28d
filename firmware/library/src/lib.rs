//! The leg's firmware without its hardware: what a board, an emulator and the host's own process run alike.
//!
//! # Where to begin
//!
//! [`leg::Leg`] is the controller: [`Leg::tick`](leg::Leg::tick) takes what the sensors read and gives what the motors
//! shall do. It is a pure function of its state, the sensors and the commands, without a clock and without globals.
//!
//! ```
//! use leg_firmware::leg::Leg;
//! use leg_firmware::sensors::Sensors;
//! use leg_firmware::settings::Settings;
//! use leg_firmware::supervisor::State;
//!
//! let settings = Settings::table_1().expect("they are part of the crate");
//! let mut leg = Leg::<f32>::new(&settings).expect("they describe a leg");
//! // Half of the range is no current; the supply reads 24 V, the drivers 25 °C.
//! let sensors = Sensors {
//!     cell_codes: [10_000; 3],
//!     current_codes: [32_760; 3],
//!     supply_code: 43_680,
//!     temperature_code: 21_294,
//!     cell_fresh: [true; 3],
//!     ..Sensors::default()
//! };
//! for _ in 0..16 {
//!     assert!(!leg.tick(&sensors).enabled);
//! }
//! assert_eq!(leg.state(), State::Disarmed);
//! assert!(!leg.telemetry().faults.any());
//! ```
//!
//! # The data path of a tick
//!
//! | step | module |
//! |---|---|
//! | [`Sensors`](sensors::Sensors): counts and codes | [`board`], read by a [`LowerHalf`](board::LowerHalf) |
//! | counts and codes → SI: travel in m, tension in N, current in A | [`control::Measurement`] |
//! | one waiting [`Command`](command::Command) is executed or refused | [`leg`] |
//! | lengths and tensions → direction, residual, load | [`control::Estimator`] |
//! | demanded stiffness → pretension | [`control::PretensionSearch`] |
//! | set-points of a stream → segments of the trajectory | [`control::Stream`] |
//! | trajectory point, load, pretension → tensions → unstretched lengths | [`control::TargetGenerator`] |
//! | faults → reaction → state; it can only take authority away | [`supervisor`] |
//! | goal of each tendon → duty, within voltage, current and tension | [`control::Axis`] |
//! | [`Drive`](drive::Drive): duties and enable | [`board::PowerStage`] |
//!
//! The axes and the supervisor work in every tick, 8 000 a second. Estimate, pretension, target and trajectory plan take
//! turns, so that each is renewed 2 000 times a second.
//!
//! Around the leg: [`host_link`] speaks with a host in [`frame`]s, on a serial line or over [`can`]; [`store`] keeps the
//! [`settings`] in flash; [`linked_leg`] joins a leg and its link.
//!
//! # Glossary
//!
//! | word | meaning |
//! |---|---|
//! | tick, cycle | 125 µs; four ticks |
//! | pulled in | travel of a tendon towards its motor since the board started, m |
//! | zero | the unstretched lengths at which the board started; homing finds them |
//! | direction | unit vector along the leg, straight down at (0, 0, −1) |
//! | half-tangent | tan(θ/2)·(cos φ, sin φ): coordinates that are smooth at the vertical |
//! | pretension | tension per tendon of the internal force, N |
//! | trim | correction of the pretension by the measured tensions, N |
//! | residual | what forward kinematics leaves of the three lengths, m |
//! | excess | load beyond the leg's own weight, as a horizontal moment, N·m |
//! | suspect cells | load cells that may be the cause of a latched fault: a held leg does not move by them |
//! | arm, armed | lets the leg follow commands: the state active |
//! | latched | said of a fault until it is cleared |
//! | limit, hold, ramp down, gate off | reactions to a fault, from the mildest to the most severe |
#![cfg_attr(not(test), no_std)]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a comparison that is negated refuses NaN, too"
)]

pub mod board;
pub mod can;
pub mod command;
pub mod control;
pub mod drive;
pub mod frame;
pub mod host_link;
pub mod jog;
pub mod leg;
pub mod linked_leg;
pub mod recorder;
pub mod sensors;
pub mod set_point;
pub mod settings;
pub mod store;
pub mod supervisor;
pub mod telemetry;
pub mod version;
