//! What the timers that count a clock have in common: their time, their counter and the registers around it.

pub mod counter;
pub mod filter;
mod places;
pub mod registers;
pub mod timebase;
