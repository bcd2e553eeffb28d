//! The computer's side of a leg: what `leg home`, `leg move`, `leg log` and `leg flash` do.
//!
//! # Where to begin
//! An [`operator::Operator`] introduces itself to a leg over a [`transport::Transport`] and commands it. The transport is
//! a board's serial port ([`transport::serial`]), a CAN FD interface ([`transport::can`]), an emulated board of another
//! process ([`transport::tcp`]) or an emulated leg in this process ([`transport::emulated`]), which needs no board:
//!
//! ```
//! use leg_host::cancel_flag::CancelFlag;
//! use leg_host::leg_report::angles_deg;
//! use leg_host::operator::{Goal, HostIdentity, Operator};
//! use leg_host::transport::emulated::EmulatedLine;
//! use leg_rig::rig_file::RigFile;
//! use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
//! use leg_sim::link::InProcess;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A leg of the paper's rig: homed, hanging straight down, disarmed.
//! let firmware = Box::new(InProcess::new());
//! let leg = EmulatedLeg::new(&RigFile::load(None)?, InitialState::Homed, firmware)?;
//! let line = EmulatedLine::new(leg, "the leg in this example");
//!
//! let transport = Box::new(line.connect());
//! let mut operator = Operator::open(transport, HostIdentity::FIXED, CancelFlag::default())?;
//!
//! // Lean 10° towards azimuth 0° and stay there in hold. `Operator::home` would come first on a leg that is not homed.
//! let x = 10_f32.to_radians().sin();
//! let reached = operator.reach(&Goal::direction(x, 0.0))?;
//! let [_, tilt_deg] = angles_deg(reached.pose);
//! assert!((tilt_deg - 10.0).abs() < 0.05);
//! # Ok(())
//! # }
//! ```
//!
//! On a board the transport is `Serial::open("/dev/ttyACM0")?` instead, and all else is the same. Dropping the operator in
//! mid-move is safe: the board holds the leg when it hears no more of its host.
//!
//! # What is where
//! | module | what for |
//! |---|---|
//! | [`operator`] | commands, settings, telemetry of one leg, and every error with its remedy |
//! | [`transport`] | what carries the bytes |
//! | [`emulated_board`], [`pseudo_terminal`], [`tcp_port`] | an emulated leg behind a port, for other programs (`leg emulate`) |
//! | [`recording`] | simulations and telemetry as MCAP or CSV, and the replay of a simulation |
//! | [`signals`] | every signal of a leg, declared once |
//! | [`leg_report`], [`sensor_report`] | what people and machines are shown of a leg |
//! | [`calibration`] | calibration by hand: a load cell by known weights |
//! | [`tune`] | motors, play and swing of a leg, measured |
//! | [`flash`] | writing the firmware by `probe-rs` |

pub mod byte_port;
pub mod calibration;
pub mod cancel_flag;
pub mod emulated_board;
pub mod flash;
pub mod leg_report;
pub mod operator;
pub mod path_reader;
#[cfg(not(unix))]
#[path = "no_pseudo_terminal.rs"]
pub mod pseudo_terminal;
#[cfg(unix)]
pub mod pseudo_terminal;
pub mod recording;
pub mod sensor_report;
pub mod tcp_port;
pub mod transport;
pub mod tune;

pub use leg_base::jog_report;
pub use leg_sim::signals;
