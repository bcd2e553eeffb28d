//! A map as it is drawn, on the disc and in 3D.

use crate::map::{Map, RINGS, SPOKES, azimuth_deg};
use crate::theme::{Palette, mixed};
use egui::{Color32, Mesh, Pos2};
use leg_base::angles;

/// The colour of a value at a part of the way from the lowest to the highest; not a number where the model has no answer.
#[must_use]
pub fn colour(palette: &Palette, part: f64) -> Color32 {
    if part.is_finite() {
        mixed(palette.card, palette.brass, 0.8 * part as f32)
    } else {
        palette.back
    }
}

/// The map, coloured from its lowest value to its highest; `place` is where the screen has the horizontal components of a direction.
pub fn mesh(map: &Map, palette: &Palette, opacity: f32, place: impl Fn([f64; 2]) -> Pos2) -> Mesh {
    let [low, high] = map.range().unwrap_or_default();
    let shown = |value: f64| {
        // One value everywhere is the lowest.
        let range = if high > low { high - low } else { 1.0 };
        colour(palette, (value - low) / range).gamma_multiply(opacity)
    };
    let mut mesh = Mesh::default();
    for (index, value) in map.values().iter().enumerate() {
        let (ring, spoke) = match index.checked_sub(1) {
            None => (0, 0),
            Some(index) => (index / SPOKES + 1, index % SPOKES),
        };
        let sine = map.sine_max() * ring as f64 / RINGS as f64;
        let at = angles::unit_vector(azimuth_deg(spoke)).map(|part| sine * part);
        mesh.colored_vertex(place(at), shown(*value));
    }
    let vertex = |ring: usize, spoke: usize| match ring {
        0 => 0,
        _ => (1 + (ring - 1) * SPOKES + spoke % SPOKES) as u32,
    };
    for ring in 0..RINGS {
        for spoke in 0..SPOKES {
            let [inner, next_inner] = [spoke, spoke + 1].map(|spoke| vertex(ring, spoke));
            let [outer, next_outer] = [spoke, spoke + 1].map(|spoke| vertex(ring + 1, spoke));
            mesh.add_triangle(inner, outer, next_outer);
            mesh.add_triangle(inner, next_outer, next_inner);
        }
    }
    mesh
}
