//! The mechanism at a pose, as a camera sees it.

use super::camera::Camera;
use super::pen::{self, BRASS, INK, PLATE, Point2, STEEL, TENDONS, short};
use crate::xml_element::Element;
use leg_model::{HalfTangent, RigParameters};
use leg_rig::rig_file::RigFile;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// Beyond their outermost anchor the plates go on by this part of its radius.
const PLATE_BY_ANCHORS: f64 = 1.2;
const PLATE_CORNERS: u8 = 48;
/// Radius of the payload beside the distance of the tip from the joint: a symbol, for the rig does not say its size.
const PAYLOAD_BY_TIP: f64 = 0.045;

/// A leg at a tilt along x. No support twists it there.
#[derive(Clone, Copy, Debug)]
pub(super) struct DrawnLeg {
    pub parameters: RigParameters<f64, 3>,
    pub tilt_deg: f64,
    rotation: Matrix3<f64>,
}

impl DrawnLeg {
    pub fn new(rig: &RigFile, tilt_deg: f64) -> Self {
        let half_tangent = HalfTangent::new((tilt_deg.to_radians() / 2.0).tan(), 0.0);
        Self {
            parameters: rig.parameters,
            tilt_deg,
            rotation: half_tangent.direction().rotation(),
        }
    }

    /// A point on the leg's axis, so far (m) below the joint.
    pub fn axis(&self, below: f64) -> Vector3<f64> {
        self.rotation * Vector3::new(0.0, 0.0, -below)
    }

    /// From the joint to the tip, m.
    pub fn tip_m(&self) -> f64 {
        self.parameters.joint_length_m + self.parameters.leg_length_m
    }

    pub fn payload_radius_m(&self) -> f64 {
        PAYLOAD_BY_TIP * self.tip_m()
    }

    /// Radius of both plates, m.
    pub fn plate_radius_m(&self) -> f64 {
        let [_, greatest] = self.anchor_radii_m();
        PLATE_BY_ANCHORS * greatest
    }

    fn anchor_radii_m(&self) -> [f64; 2] {
        let p = &self.parameters;
        let radii = p
            .base_anchors_m
            .iter()
            .chain(&p.leg_anchors_m)
            .map(|[x, y]| x.hypot(*y));
        radii.fold([f64::INFINITY, 0.0], |[least, greatest], radius| {
            [least.min(radius), greatest.max(radius)]
        })
    }

    /// How far from the axis the anchors are.
    pub fn anchor_radii_mm(&self) -> String {
        let [least, greatest] = self.anchor_radii_m().map(|radius| short(1000.0 * radius));
        if least == greatest {
            least
        } else {
            format!("{least} to {greatest}")
        }
    }

    /// The leg's axis between two distances (m) below the joint.
    pub fn rod(&self, camera: &Camera, [start, end]: [f64; 2]) -> Vec<Element> {
        let ends = [start, end].map(|below| camera.project(&self.axis(below)));
        let width = 1000.0 * camera.px_per_mm * self.plate_radius_m() / 5.0;
        vec![
            pen::line(&ends, INK, width + 1.6),
            pen::line(&ends, STEEL, width),
        ]
    }

    pub fn base_plate(&self, camera: &Camera) -> Element {
        plate(camera, self.plate_radius_m(), |x, y| {
            Vector3::new(x, y, self.parameters.upper_length_m)
        })
    }

    pub fn leg_plate(&self, camera: &Camera) -> Element {
        plate(camera, self.plate_radius_m(), |x, y| {
            self.rotation * Vector3::new(x, y, -self.parameters.joint_length_m)
        })
    }

    /// The post that carries the joint, and the joint.
    pub fn joint(&self, camera: &Camera) -> Vec<Element> {
        let top = Vector3::new(0.0, 0.0, self.parameters.upper_length_m);
        let [from, centre] = [top, Vector3::zeros()].map(|point| camera.project(&point));
        let unit = 1000.0 * camera.px_per_mm * self.plate_radius_m();
        vec![
            pen::line(&[from, centre], PLATE, unit / 6.0),
            pen::disc(centre, unit / 7.0, BRASS),
        ]
    }

    /// The three tendons, each with its two anchors.
    pub fn tendons(&self, camera: &Camera, width: f64) -> Vec<Element> {
        let draw = |(ends, colour): ([Point2; 2], &str)| {
            let anchors = ends.map(|end| pen::disc(end, 0.9 * width, colour));
            core::iter::once(pen::line(&ends, colour, width)).chain(anchors)
        };
        self.tendon_ends(camera)
            .into_iter()
            .flat_map(draw)
            .collect()
    }

    /// Where each tendon's anchors on base and leg are on the paper, px, and its colour.
    pub fn tendon_ends(&self, camera: &Camera) -> [([Point2; 2], &'static str); 3] {
        let p = &self.parameters;
        std::array::from_fn(|i| {
            let ([base_x, base_y], [leg_x, leg_y]) = (p.base_anchors_m[i], p.leg_anchors_m[i]);
            let base = Vector3::new(base_x, base_y, p.upper_length_m);
            let leg = self.rotation * Vector3::new(leg_x, leg_y, -p.joint_length_m);
            ([base, leg].map(|point| camera.project(&point)), TENDONS[i])
        })
    }

    pub fn payload(&self, camera: &Camera) -> Element {
        let radius = 1000.0 * camera.px_per_mm * self.payload_radius_m();
        pen::disc(camera.project(&self.axis(self.tip_m())), radius, BRASS)
    }
}

fn plate(camera: &Camera, radius: f64, place: impl Fn(f64, f64) -> Vector3<f64>) -> Element {
    let corner = |i: u8| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(PLATE_CORNERS)).sin_cos();
        camera.project(&place(radius * cos, radius * sin))
    };
    let corners: Vec<Point2> = (0..PLATE_CORNERS).map(corner).collect();
    pen::shape(&corners, PLATE, PLATE, 3.0)
}
