//! The whole leg from the side: hanging straight down, faint, and leaning.

use super::camera::Camera;
use super::leg::DrawnLeg;
use super::pen::{self, DIMENSION, Label, short};
use crate::xml_element::Element;
use nalgebra::Vector3;

/// Where the base plate's middle is, px.
const BASE_PX: [f64; 2] = [186.0, 40.0];
/// What the leg may take of the picture, px.
const ROOM_PX: [f64; 2] = [260.0, 430.0];

pub(super) fn draw(vertical: &DrawnLeg, leaning: &DrawnLeg) -> Vec<Element> {
    let camera = camera(vertical);
    let faint = Element::new("g")
        .text("opacity", "0.22")
        .children(whole(vertical, &camera));
    let mut view = vec![faint];
    view.extend(dimensions(vertical, &camera));
    view.extend(whole(leaning, &camera));
    view.extend(tilt(leaning, &camera));
    view.extend(names(leaning, &camera));
    view.extend(axes());
    view
}

fn camera(leg: &DrawnLeg) -> Camera {
    let upper_mm = 1000.0 * leg.parameters.upper_length_m;
    let height_mm = upper_mm + 1000.0 * (leg.tip_m() + leg.payload_radius_m());
    let width_mm = 1000.0 * 2.0 * leg.plate_radius_m();
    let px_per_mm = (ROOM_PX[1] / height_mm).min(ROOM_PX[0] / width_mm);
    Camera {
        turn_deg: 0.0,
        elevation_deg: 0.0,
        px_per_mm,
        joint_px: [BASE_PX[0], BASE_PX[1] + px_per_mm * upper_mm],
    }
}

fn whole(leg: &DrawnLeg, camera: &Camera) -> Vec<Element> {
    let mut parts = leg.rod(camera, [0.0, leg.tip_m()]);
    parts.extend([leg.base_plate(camera), leg.leg_plate(camera)]);
    parts.extend(leg.joint(camera));
    parts.extend(leg.tendons(camera, 2.2));
    parts.push(leg.payload(camera));
    parts
}

fn dimensions(leg: &DrawnLeg, camera: &Camera) -> Vec<Element> {
    let p = &leg.parameters;
    let heights = [p.upper_length_m, 0.0, -p.joint_length_m, -leg.tip_m()];
    let [base, joint, plate, tip] =
        heights.map(|height| camera.project(&Vector3::new(0.0, 0.0, height))[1]);
    let left = camera.project(&Vector3::new(-leg.plate_radius_m(), 0.0, 0.0))[0];
    let (x, centre) = (left - 12.0, camera.joint_px[0]);
    let text = |name: &str, length_m: f64| format!("{name} {} mm", short(1000.0 * length_m));
    [
        pen::dimension(x, [base, joint], centre, &text("L_upper", p.upper_length_m)),
        pen::dimension(x, [joint, plate], left, &text("L_joint", p.joint_length_m)),
        pen::dimension(x, [plate, tip], centre, &text("L_leg", p.leg_length_m)),
    ]
    .concat()
}

/// The angle between the two legs.
fn tilt(leg: &DrawnLeg, camera: &Camera) -> Vec<Element> {
    const STEPS: u8 = 16;
    let radius = 0.62 * leg.tip_m();
    let point = |part: f64| {
        let (sin, cos) = (part * leg.tilt_deg).to_radians().sin_cos();
        camera.project(&Vector3::new(radius * sin, 0.0, -radius * cos))
    };
    let arc: Vec<_> = (0..=STEPS)
        .map(|i| point(f64::from(i) / f64::from(STEPS)))
        .collect();
    let [x, y] = point(0.5);
    let text = format!("tilt {}°", short(leg.tilt_deg));
    vec![
        pen::line(&arc, DIMENSION, 1.2),
        Label::new(&text).centred().place([x, y + 14.0]),
    ]
}

fn names(leg: &DrawnLeg, camera: &Camera) -> Vec<Element> {
    let drop_px = 1000.0 * camera.px_per_mm * leg.payload_radius_m() + 14.0;
    let tip = camera.project(&leg.axis(leg.tip_m()));
    let plumb = camera.project(&Vector3::new(0.0, 0.0, -leg.tip_m()));
    let rod = camera.project(&leg.axis(0.45 * leg.tip_m()));
    vec![
        Label::new("tip with payload")
            .centred()
            .place([tip[0], tip[1] + drop_px]),
        Label::new("vertical")
            .colour(DIMENSION)
            .centred()
            .place([plumb[0], plumb[1] + drop_px]),
        Label::new("leg").place([rod[0] + 12.0, rod[1]]),
    ]
}

/// The axes of frame {A} that lie in the paper.
fn axes() -> Vec<Element> {
    const ORIGIN: [f64; 2] = [34.0, 462.0];
    const LENGTH: f64 = 36.0;
    let [x, y] = ORIGIN;
    let ends = [[x + LENGTH, y], [x, y - LENGTH]];
    let arrows = ends.map(|end| pen::arrow(ORIGIN, end, DIMENSION, 1.4));
    let [right, top] = ends;
    let names = [
        Label::new("x").colour(DIMENSION).place([right[0] + 6.0, y]),
        Label::new("z")
            .colour(DIMENSION)
            .centred()
            .place([x, top[1] - 10.0]),
    ];
    arrows.into_iter().flatten().chain(names).collect()
}
