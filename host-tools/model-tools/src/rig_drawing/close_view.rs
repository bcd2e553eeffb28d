//! The tendons of the leaning leg from nearer by and from above, so that none hides another.

use super::camera::Camera;
use super::leg::DrawnLeg;
use super::pen::{self, Label, Point2};
use crate::xml_element::Element;
use nalgebra::Vector3;

/// Where the joint is, px.
const JOINT_PX: Point2 = [462.0, 124.0];
/// What plates and joint may take of the picture, px.
const ROOM_PX: [f64; 2] = [180.0, 142.0];
/// How much of the leg is shown below its plate, in lengths from the joint to the plate.
const STUB: f64 = 1.9;
/// How far the tendons go on above the base plate, px.
const TO_SCREW_PX: f64 = 50.0;

pub(super) fn draw(leg: &DrawnLeg) -> Vec<Element> {
    let camera = camera(leg);
    let p = &leg.parameters;
    let mut view = leg.rod(&camera, [0.0, STUB * p.joint_length_m]);
    let see_through = |part: Element| part.text("fill-opacity", "0.35");
    view.extend([leg.leg_plate(&camera), leg.base_plate(&camera)].map(see_through));
    view.extend(leg.joint(&camera));
    view.extend(leg.tendons(&camera, 3.0));
    view.extend(screw_arrows(leg, &camera));
    view.extend(names(leg, &camera));
    view
}

fn camera(leg: &DrawnLeg) -> Camera {
    let p = &leg.parameters;
    let width_mm = 2000.0 * leg.plate_radius_m();
    let height_mm = 1000.0 * (p.upper_length_m + p.joint_length_m);
    Camera {
        turn_deg: 18.0,
        elevation_deg: 16.0,
        px_per_mm: (ROOM_PX[0] / width_mm).min(ROOM_PX[1] / height_mm),
        joint_px: JOINT_PX,
    }
}

/// Above the base plate the tendons go on to their screws, which pull them.
fn screw_arrows(leg: &DrawnLeg, camera: &Camera) -> Vec<Element> {
    let tendons = leg.tendon_ends(camera).into_iter();
    tendons
        .flat_map(|([[x, y], _], colour)| pen::arrow([x, y], [x, y - TO_SCREW_PX], colour, 2.0))
        .collect()
}

fn names(leg: &DrawnLeg, camera: &Camera) -> Vec<Element> {
    let p = &leg.parameters;
    let top = camera.project(&Vector3::new(0.0, 0.0, p.upper_length_m));
    let plate = camera.project(&leg.axis(p.joint_length_m));
    let stub = camera.project(&leg.axis(0.95 * STUB * p.joint_length_m));
    let half_width = 1000.0 * camera.px_per_mm * leg.plate_radius_m();
    let mut names = vec![
        Label::new("base plate")
            .right_aligned()
            .place([top[0] - half_width - 8.0, top[1]]),
        Label::new("leg plate")
            .right_aligned()
            .place([plate[0] - half_width - 4.0, plate[1] + 30.0]),
        Label::new("joint").place([JOINT_PX[0] + 20.0, JOINT_PX[1]]),
        Label::new("leg").place([stub[0] + 18.0, stub[1]]),
    ];
    for (i, ([base, end], colour)) in (1..).zip(leg.tendon_ends(camera)) {
        let named = |name: &str, [x, y]: Point2, centre: Point2| {
            let label = Label::new(name).colour(colour).bold();
            if x < centre[0] {
                label.right_aligned().place([x - 8.0, y])
            } else {
                label.place([x + 8.0, y])
            }
        };
        names.push(named(&format!("B{i}"), [base[0], base[1] - 8.0], top));
        names.push(named(&format!("S{i}"), [end[0], end[1] + 8.0], plate));
        let tendon = format!("tendon {i}");
        let label_px = [base[0], base[1] - TO_SCREW_PX - 10.0];
        names.push(Label::new(&tendon).colour(colour).centred().place(label_px));
    }
    names
}
