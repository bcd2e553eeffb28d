//! What `leg monitor` shows: a picture of the leg, drawn on a terminal or written as a line of JSON.

mod bar;
mod picture;
mod sag;
mod screen;

#[cfg(test)]
mod tests;

pub use picture::Picture;
pub use screen::draw;
