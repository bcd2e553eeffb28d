//! What the viewer shows around the leg.

use crate::xml_element::Element;

const ROPE: [f64; 4] = [0.80, 0.20, 0.15, 1.0];
const FLOOR: [f64; 4] = [0.80, 0.80, 0.78, 1.0];
const ZENITH: [f64; 3] = [0.45, 0.60, 0.80];
const HORIZON: [f64; 3] = [0.95, 0.96, 0.98];

/// Where the viewer looks at first: the middle of a leg whose tip is so far (m) below the joint.
pub(super) fn view(tip: f64) -> Element {
    Element::new("statistic")
        .numbers("center", &[0.0, 0.0, -tip / 2.0])
        .numbers("extent", &[tip])
}

/// Without it the background is black.
pub(super) fn sky() -> Element {
    let texture = Element::new("texture")
        .text("type", "skybox")
        .text("builtin", "gradient")
        .numbers("rgb1", &HORIZON)
        .numbers("rgb2", &ZENITH)
        .numbers("width", &[128.0])
        .numbers("height", &[768.0]);
    Element::new("asset").child(texture)
}

/// A light above a leg of this length, m. It casts no shadow: the payload's would hide the leg.
pub(super) fn light(tip: f64) -> Element {
    Element::new("light")
        .numbers("pos", &[tip, -tip, 2.0 * tip])
        .numbers("dir", &[-1.0, 1.0, -2.0])
        .text("castshadow", "false")
}

/// Shapes are only shown: they have no mass and no contacts. `ring` is the radius of the anchors' ring, m.
pub(super) fn defaults(ring: f64) -> Element {
    let geom = Element::new("geom")
        .numbers("mass", &[0.0])
        .numbers("contype", &[0.0])
        .numbers("conaffinity", &[0.0]);
    let site = Element::new("site").numbers("size", &[ring / 16.0]);
    let tendon = Element::new("tendon")
        .numbers("width", &[ring / 48.0])
        .numbers("rgba", &ROPE);
    Element::new("default").children([geom, site, tendon])
}

/// What feet stand on.
pub(super) fn floor() -> Element {
    Element::new("geom")
        .text("name", "floor")
        .text("type", "plane")
        .numbers("size", &[0.0, 0.0, 0.1])
        .numbers("rgba", &FLOOR)
        .numbers("contype", &[1.0])
        .numbers("conaffinity", &[1.0])
}
