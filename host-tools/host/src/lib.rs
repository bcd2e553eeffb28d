//! The host of a leg: transports, operator, recordings, the flashing of a board.

pub mod cell_fit;
pub mod emulated_board;
pub mod flash;
pub mod leg_report;
pub mod monitor;
pub mod operator;
pub mod pseudo_terminal;
pub mod recording;
pub mod sensor_report;
pub mod transport;
