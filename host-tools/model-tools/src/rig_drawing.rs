//! A picture of a leg, in proportion to its rig: the whole from the side, and its tendons from nearer by.

mod camera;
mod close_view;
mod leg;
mod pen;
mod side_view;

use crate::xml_element::{self, Element};
use leg::DrawnLeg;
use leg_rig::rig_file::RigFile;
use pen::Label;
use std::io;

const WIDTH_PX: f64 = 600.0;
const HEIGHT_PX: f64 = 512.0;

/// How far the drawn leg leans where the rig lets it: enough to see which tendon becomes shorter.
const TILT_DEG: f64 = 20.0;

/// Draws a rig as SVG: hanging straight down and leaning along x.
///
/// # Errors
/// None but for want of memory.
pub fn svg(rig: &RigFile) -> io::Result<String> {
    let tilt_deg = TILT_DEG.min(rig.tilt_deg);
    let [vertical, leaning] = [0.0, tilt_deg].map(|tilt_deg| DrawnLeg::new(rig, tilt_deg));
    let [width, height] = [WIDTH_PX, HEIGHT_PX].map(|side| side.to_string());
    let root = Element::new("svg")
        .text("xmlns", "http://www.w3.org/2000/svg")
        .text("width", &width)
        .text("height", &height)
        .text("viewBox", &format!("0 0 {width} {height}"))
        .text(
            "font-family",
            "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif",
        )
        .child(background())
        .children(side_view::draw(&vertical, &leaning))
        .children(close_view::draw(&leaning))
        .children(notes(rig, &leaning));
    let mut text = Vec::new();
    xml_element::write(&root, " Drawn by `leg rig draw`. ", &mut text)?;
    String::from_utf8(text).map_err(io::Error::other)
}

fn background() -> Element {
    Element::new("rect")
        .text("width", "100%")
        .text("height", "100%")
        .text("fill", "#ffffff")
}

/// What the two views do not show.
fn notes(rig: &RigFile, leg: &DrawnLeg) -> Vec<Element> {
    let lines = [
        "Anchors B on the fixed base plate,".to_owned(),
        format!("S on the leg plate: {} mm from", leg.anchor_radii_mm()),
        "the axis. Screws pull the tendons".to_owned(),
        "and hold them without power.".to_owned(),
        format!("Tilt to {}° towards any azimuth.", pen::short(rig.tilt_deg)),
        "Drawn in proportion.".to_owned(),
    ];
    let line = |(row, text): (i32, &String)| {
        Label::new(text).place([354.0, 322.0 + 20.0 * f64::from(row)])
    };
    (0..).zip(&lines).map(line).collect()
}
