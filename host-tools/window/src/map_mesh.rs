//! A map as it is drawn, on the disc and in 3D.

use crate::map::{Map, RINGS, SPOKES, azimuth_deg};
use crate::theme::{Palette, mixed};
use eframe::egui::{Mesh, Pos2};
use leg_base::angles;

/// The map, coloured from its lowest value to its highest; `place` is where the screen has the horizontal components of a direction.
pub fn mesh(map: &Map, palette: &Palette, opacity: f32, place: impl Fn([f64; 2]) -> Pos2) -> Mesh {
    let [low, high] = map.range().unwrap_or_default();
    let colour = |value: f64| {
        let part = if high > low {
            (value - low) / (high - low)
        } else {
            0.0
        };
        let colour = if part.is_finite() {
            mixed(palette.card, palette.brass, 0.8 * part as f32)
        } else {
            palette.back
        };
        colour.gamma_multiply(opacity)
    };
    let mut mesh = Mesh::default();
    for (index, value) in map.values().iter().enumerate() {
        let (ring, spoke) = match index.checked_sub(1) {
            None => (0, 0),
            Some(index) => (index / SPOKES + 1, index % SPOKES),
        };
        let sine = map.sine_max() * ring as f64 / RINGS as f64;
        let at = angles::unit_vector(azimuth_deg(spoke)).map(|part| sine * part);
        mesh.colored_vertex(place(at), colour(*value));
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
