//! Lines, shapes and texts of a drawing.

use crate::xml_element::Element;
use leg_base::rounding::rounded;

pub(super) const INK: &str = "#222222";
pub(super) const DIMENSION: &str = "#666666";
pub(super) const PLATE: &str = "#5b6b7d";
pub(super) const STEEL: &str = "#9aa3ad";
pub(super) const BRASS: &str = "#c79a3a";
/// Okabe and Ito's colours, distinct for the colour-blind.
pub(super) const TENDONS: [&str; 3] = ["#0072b2", "#d55e00", "#009e73"];

const TEXT_PX: f64 = 13.0;

/// A point on the paper, px.
pub(super) type Point2 = [f64; 2];

/// A number with one decimal at most.
pub(super) fn short(value: f64) -> String {
    rounded(value, 1).to_string()
}

fn pairs(points: &[Point2]) -> String {
    let pair = |[x, y]: &Point2| format!("{},{}", short(*x), short(*y));
    points.iter().map(pair).collect::<Vec<_>>().join(" ")
}

/// An open line with round ends.
pub(super) fn line(points: &[Point2], colour: &str, width: f64) -> Element {
    Element::new("polyline")
        .text("points", &pairs(points))
        .text("fill", "none")
        .text("stroke", colour)
        .text("stroke-width", &short(width))
        .text("stroke-linecap", "round")
        .text("stroke-linejoin", "round")
}

/// A filled shape with an outline of a darker colour.
pub(super) fn shape(points: &[Point2], fill: &str, outline: &str, width: f64) -> Element {
    Element::new("polygon")
        .text("points", &pairs(points))
        .text("fill", fill)
        .text("stroke", outline)
        .text("stroke-width", &short(width))
        .text("stroke-linejoin", "round")
}

pub(super) fn disc([x, y]: Point2, radius: f64, fill: &str) -> Element {
    Element::new("circle")
        .text("cx", &short(x))
        .text("cy", &short(y))
        .text("r", &short(radius))
        .text("fill", fill)
        .text("stroke", INK)
        .text("stroke-width", "0.8")
}

/// A line with a head at its end.
pub(super) fn arrow(from: Point2, to: Point2, colour: &str, width: f64) -> [Element; 2] {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy);
    let (axis, normal) = ([dx / length, dy / length], [-dy / length, dx / length]);
    let corner = |back: f64, side: f64| [0, 1].map(|i| to[i] - back * axis[i] + side * normal[i]);
    let head = [to, corner(8.0, 3.5), corner(8.0, -3.5)];
    [
        line(&[from, corner(6.0, 0.0)], colour, width),
        shape(&head, colour, colour, 0.5),
    ]
}

/// A text that is ready to be placed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Label<'a> {
    text: &'a str,
    colour: &'a str,
    anchor: &'a str,
    bold: bool,
}

impl<'a> Label<'a> {
    pub fn new(text: &'a str) -> Self {
        Self {
            text,
            colour: INK,
            anchor: "start",
            bold: false,
        }
    }

    pub fn colour(self, colour: &'a str) -> Self {
        Self { colour, ..self }
    }

    pub fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    pub fn centred(self) -> Self {
        Self {
            anchor: "middle",
            ..self
        }
    }

    pub fn right_aligned(self) -> Self {
        Self {
            anchor: "end",
            ..self
        }
    }

    /// Places it with its middle at the height of a point.
    pub fn place(self, [x, y]: Point2) -> Element {
        let weight = if self.bold { "bold" } else { "normal" };
        Element::new("text")
            .text("x", &short(x))
            .text("y", &short(y + 0.35 * TEXT_PX))
            .text("font-size", &short(TEXT_PX))
            .text("font-weight", weight)
            .text("text-anchor", self.anchor)
            .text("fill", self.colour)
            .content(self.text)
    }
}

/// A vertical dimension from one height to another, its text to the left.
pub(super) fn dimension(x: f64, [top, bottom]: [f64; 2], edge: f64, text: &str) -> Vec<Element> {
    let thin = |points: &[Point2]| line(points, DIMENSION, 0.8);
    vec![
        thin(&[[x, top], [x, bottom]]),
        thin(&[[x - 4.0, top], [edge, top]]),
        thin(&[[x - 4.0, bottom], [edge, bottom]]),
        Label::new(text)
            .right_aligned()
            .place([x - 8.0, 0.5 * (top + bottom)]),
    ]
}
