//! The leg as it is drawn: where its parts are, with its deviation enlarged.

use leg_model::RigParameters;
use nalgebra::{Rotation3, UnitVector3, Vector3};

/// The largest deviation that is drawn, m: an enlarged leg stays in the picture.
const DRAWN_MAX_M: f64 = 0.06;

/// A leg that points somewhere.
#[derive(Clone, Copy, Debug)]
pub struct LegPose {
    /// Along the leg, from the joint to the tip.
    pub leg_axis: Vector3<f64>,
    rotation: Rotation3<f64>,
}

impl LegPose {
    /// Of a leg that points along a unit vector, without torsion.
    #[must_use]
    pub fn new(leg_axis: Vector3<f64>) -> Self {
        let down = -Vector3::z();
        let rotation = Rotation3::rotation_between(&down, &leg_axis);
        Self {
            leg_axis,
            rotation: rotation.unwrap_or_else(Rotation3::identity),
        }
    }

    /// The same twisted about itself, rad.
    #[must_use]
    pub fn twisted(self, torsion_rad: f64) -> Self {
        let axis = UnitVector3::new_normalize(-self.leg_axis);
        Self {
            rotation: Rotation3::from_axis_angle(&axis, torsion_rad) * self.rotation,
            ..self
        }
    }

    /// The tendons' anchors on the base plate and on the leg's plate.
    #[must_use]
    pub fn anchors(&self, rig: &RigParameters<f64, 3>) -> [[Vector3<f64>; 2]; 3] {
        std::array::from_fn(|i| {
            let [x, y] = rig.base_anchors_m[i];
            let base = Vector3::new(x, y, rig.upper_length_m);
            let [x, y] = rig.leg_anchors_m[i];
            [
                base,
                self.rotation * Vector3::new(x, y, -rig.joint_length_m),
            ]
        })
    }
}

/// A direction whose distance from a reference is enlarged, and how much: less where it would leave the picture.
#[must_use]
pub fn enlarged(
    reference: Vector3<f64>,
    leg_axis: Vector3<f64>,
    factor: f64,
    tip_length_m: f64,
) -> (Vector3<f64>, f64) {
    let deviation = leg_axis - reference;
    let room = DRAWN_MAX_M / (deviation.norm() * tip_length_m).max(1e-9);
    let factor = factor.min(room).max(1.0);
    ((reference + deviation * factor).normalize(), factor)
}

#[cfg(test)]
mod tests {
    use super::{LegPose, enlarged};
    use leg_model::RigParameters;
    use nalgebra::Vector3;

    #[test]
    fn the_anchors_of_a_hanging_leg_are_those_of_the_rig() {
        let rig = RigParameters::<f64, 3>::TABLE_1;
        let [[base, leg], ..] = LegPose::new(-Vector3::z()).anchors(&rig);
        assert_eq!(base, Vector3::new(0.024, 0.0, 0.006));
        assert!((leg - Vector3::new(0.024, 0.0, -0.029)).norm() < 1e-12);
    }

    #[test]
    fn the_plate_leans_and_twists_with_the_leg() {
        let rig = RigParameters::<f64, 3>::TABLE_1;
        let leg_axis = Vector3::new(0.5, 0.0, -0.75_f64.sqrt());
        let pose = LegPose::new(leg_axis);
        let centre = leg_axis * rig.joint_length_m;
        for [_, leg] in pose.anchors(&rig) {
            assert!((leg - centre).dot(&leg_axis).abs() < 1e-12);
            assert!(((leg - centre).norm() - 0.024).abs() < 1e-9);
        }
        let turned = pose.twisted(0.1).anchors(&rig);
        let moved = (turned[0][1] - pose.anchors(&rig)[0][1]).norm();
        assert!(
            (moved - 2.0 * 0.024 * 0.05_f64.sin()).abs() < 1e-9,
            "{moved}"
        );
    }

    #[test]
    fn a_small_deviation_is_enlarged_and_a_large_one_is_not() {
        let reference = -Vector3::z();
        let small = Vector3::new(0.01, 0.0, -1.0).normalize();
        let (drawn, factor) = enlarged(reference, small, 5.0, 0.2);
        assert_eq!(factor, 5.0);
        assert!((drawn.x - 0.05).abs() < 1e-4);
        let large = Vector3::new(0.6, 0.0, -0.8);
        let (drawn, factor) = enlarged(reference, large, 5.0, 0.2);
        assert_eq!(factor, 1.0);
        assert!((drawn - large).norm() < 1e-12);
    }
}
