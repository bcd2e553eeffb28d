//! What `leg monitor` shows: the state of a leg, drawn on a terminal or written as a line of JSON.

mod bar;
mod screen;
mod view;

#[cfg(test)]
mod tests;

pub use screen::draw;
pub use view::MonitorView;
