//! Round bodies, drawn as outlines and shades: enough for a leg, and smooth at any size.

use crate::camera::View;
use crate::theme::mixed;
use egui::epaint::{Mesh, PathStroke};
use egui::{Color32, Pos2, Shape, Stroke, Vec2};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Points of a circle.
const CORNERS: usize = 64;

/// Stripes of a shaded rod.
const STRIPES: usize = 8;

/// Something to be drawn, and how far away it is, m.
pub struct Item {
    /// More is drawn earlier.
    pub depth_m: f64,
    /// What.
    pub shapes: Vec<Shape>,
}

/// Draws the farthest first.
#[must_use]
pub fn sorted(mut items: Vec<Item>) -> Vec<Shape> {
    items.sort_by(|a, b| b.depth_m.total_cmp(&a.depth_m));
    items.into_iter().flat_map(|item| item.shapes).collect()
}

/// The points of a circle about an axis.
pub fn circle(
    centre: Vector3<f64>,
    axis: Vector3<f64>,
    radius_m: f64,
) -> impl Iterator<Item = Vector3<f64>> {
    let away = if axis.z.abs() < 0.9 {
        Vector3::z()
    } else {
        Vector3::x()
    };
    let u = axis.cross(&away).normalize();
    let v = axis.cross(&u);
    (0..CORNERS).map(move |corner| {
        let (sin, cos) = (TAU * corner as f64 / CORNERS as f64).sin_cos();
        centre + (u * cos + v * sin) * radius_m
    })
}

/// A disc of some thickness; `axis` points from its lower face to its upper one.
#[must_use]
pub fn disc(
    view: &View,
    lower: Vector3<f64>,
    axis: Vector3<f64>,
    [radius_m, thickness_m]: [f64; 2],
    colour: Color32,
) -> Item {
    let upper = lower + axis * thickness_m;
    let seen = |centre| -> Vec<Pos2> {
        circle(centre, axis, radius_m)
            .map(|place| view.project(place).at)
            .collect()
    };
    let (below, above) = (seen(lower), seen(upper));
    let face = if view.faces(upper, axis) {
        above.clone()
    } else {
        below.clone()
    };
    let edge = Stroke::new(1.0, mixed(colour, Color32::BLACK, 0.55));
    let side = mixed(colour, Color32::BLACK, 0.35);
    let hull = convex_hull(below.into_iter().chain(above).collect());
    Item {
        depth_m: view.project(0.5 * (lower + upper)).depth_m,
        shapes: vec![
            Shape::convex_polygon(hull, side, PathStroke::from(edge)),
            Shape::convex_polygon(face, mixed(colour, Color32::WHITE, 0.12), PathStroke::NONE),
        ],
    }
}

/// A round rod, shaded across.
#[must_use]
pub fn rod(view: &View, ends: [Vector3<f64>; 2], radius_m: f64, colour: Color32) -> Item {
    let [from, to] = ends.map(|end| view.project(end));
    let leg_axis = (to.at - from.at).normalized();
    let across = Vec2::new(-leg_axis.y, leg_axis.x);
    let half = [from, to].map(|end| (radius_m * end.points_per_m) as f32);
    let mut mesh = Mesh::default();
    for stripe in 0..=STRIPES {
        let part = 2.0 * stripe as f32 / STRIPES as f32 - 1.0;
        for (end, half) in [from, to].iter().zip(half) {
            mesh.colored_vertex(end.at + across * (part * half), shade(colour, part));
        }
    }
    for stripe in 0..STRIPES as u32 {
        let first = 2 * stripe;
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first + 1, first + 3, first + 2);
    }
    let edge = Stroke::new(1.0, mixed(colour, Color32::BLACK, 0.6));
    let side = |sign: f32| {
        let [a, b] = half.map(|half| across * (sign * half));
        Shape::line_segment([from.at + a, to.at + b], edge)
    };
    Item {
        depth_m: 0.5 * (from.depth_m + to.depth_m),
        shapes: vec![Shape::mesh(mesh), side(-1.0), side(1.0)],
    }
}

/// How a round body looks at a part of its half width: light comes from the left.
fn shade(colour: Color32, part: f32) -> Color32 {
    let light = -(part + 0.35) * (part + 0.35);
    if light > -0.12 {
        mixed(colour, Color32::WHITE, 0.45 * (1.0 + light / 0.12))
    } else {
        mixed(colour, Color32::BLACK, 0.30 * (-light - 0.12))
    }
}

/// A ball.
#[must_use]
pub fn ball(view: &View, centre: Vector3<f64>, radius_m: f64, colour: Color32) -> Item {
    let seen = view.project(centre);
    let radius = (radius_m * seen.points_per_m) as f32;
    let dark = mixed(colour, Color32::BLACK, 0.45);
    let mut shapes = vec![Shape::circle_filled(seen.at, radius, dark)];
    // Circles that become smaller, lighter, and nearer to the light.
    for step in 0..14_u8 {
        let part = f32::from(step) / 14.0;
        let size = radius * (1.0 - part) * 0.97;
        let light = seen.at + Vec2::new(-0.38, -0.42) * (radius * part * 0.8);
        let tone = if part < 0.5 {
            mixed(dark, colour, 2.0 * part)
        } else {
            mixed(colour, Color32::WHITE, 0.75 * (2.0 * part - 1.0))
        };
        shapes.push(Shape::circle_filled(light, size, tone));
    }
    let edge = Stroke::new(1.0, mixed(colour, Color32::BLACK, 0.65));
    shapes.push(Shape::circle_stroke(seen.at, radius, edge));
    Item {
        depth_m: seen.depth_m,
        shapes,
    }
}

/// A line of some width, with a dark edge so that it is seen on anything.
#[must_use]
pub fn cord(view: &View, ends: [Vector3<f64>; 2], width: f32, colour: Color32) -> Item {
    let [from, to] = ends.map(|end| view.project(end));
    let points = [from.at, to.at];
    Item {
        depth_m: 0.5 * (from.depth_m + to.depth_m),
        shapes: vec![
            Shape::line_segment(
                points,
                Stroke::new(width + 1.6, mixed(colour, Color32::BLACK, 0.6)),
            ),
            Shape::line_segment(points, Stroke::new(width, colour)),
        ],
    }
}

/// The smallest convex polygon around points.
fn convex_hull(mut points: Vec<Pos2>) -> Vec<Pos2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = Pos2>| {
        let mut chain: Vec<Pos2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                let turn = (b - a).x * (point - b).y - (b - a).y * (point - b).x;
                if turn > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::{circle, convex_hull};
    use egui::pos2;
    use nalgebra::Vector3;

    #[test]
    fn a_circle_lies_across_its_axis() {
        for axis in [Vector3::z(), -Vector3::z(), Vector3::new(0.6, 0.0, -0.8)] {
            let centre = Vector3::new(0.1, 0.2, 0.3);
            for place in circle(centre, axis, 0.05) {
                let out = place - centre;
                assert!((out.norm() - 0.05).abs() < 1e-12 && out.dot(&axis).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_hull_of_a_square_leaves_its_inside_out() {
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let inside = [(1.0, 1.0), (0.5, 1.5), (1.0, 0.0)];
        let points = corners.iter().chain(&inside);
        let hull = convex_hull(points.map(|(x, y)| pos2(*x, *y)).collect());
        assert_eq!(hull.len(), 4, "{hull:?}");
        for (x, y) in corners {
            assert!(hull.contains(&pos2(x, y)));
        }
    }
}
